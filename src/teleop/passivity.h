// SPDX-License-Identifier: Apache-2.0
// Time-domain passivity at the master's port (Hannaford and Ryu 2002), per axis.
#pragma once

#include <Eigen/Dense>
#include <algorithm>

namespace dcnn {

/// Observes the energy that link, slave and wall have taken from the hand; where they would give
/// back more than that, a damper takes the surplus.
class PassivityGuard {
 public:
  explicit PassivityGuard(bool active) : active_(active) {}

  /// The force for the hand [N] over the next `dt`, from the one that was received.
  Eigen::Vector3d act(const Eigen::Vector3d& received, const Eigen::Vector3d& velocity, double dt) {
    Eigen::Vector3d felt = received;
    for (int i = 0; i < 3; ++i) {
      const double v = velocity[i];
      idle_[i] = std::abs(received[i]) < kFree ? idle_[i] + dt : 0.0;
      if (idle_[i] > kRest) energy_[i] = 0.0;  // an old surplus must not pay for a new contact
      energy_[i] -= received[i] * v * dt;
      if (!active_ || energy_[i] >= 0.0 || std::abs(v) < kStill) continue;
      const double damping = std::min(-energy_[i] / (v * v * dt), kMostDamping);
      felt[i] -= damping * v;
      energy_[i] += damping * v * v * dt;
      dissipated_ += damping * v * v * dt;
    }
    return felt;
  }

  double energy() const { return energy_.sum(); }
  double dissipated() const { return dissipated_; }

 private:
  static constexpr double kFree = 0.05, kRest = 0.3;  // N, s
  static constexpr double kStill = 1e-6;              // m/s
  static constexpr double kMostDamping = 100.0;       // N·s/m: well below mass/dt

  bool active_;
  Eigen::Vector3d energy_ = Eigen::Vector3d::Zero(), idle_ = Eigen::Vector3d::Zero();
  double dissipated_ = 0.0;
};

}  // namespace dcnn
