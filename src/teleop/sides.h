// SPDX-License-Identifier: Apache-2.0
// The two ends of the link: hand and master, slave and wall with its force sensor.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/data/rotation.h"
#include "dcnn/teleop/teleop.h"
#include "teleop/link.h"
#include "teleop/passivity.h"

namespace dcnn {

using Command = Eigen::Matrix<double, 6, 1>;  ///< position [m] above velocity [m/s]

constexpr double kTeleopStep = 1e-3;  // s, integration
constexpr Index kStepsPerTick = 2;
constexpr double kTeleopTick = kStepsPerTick * kTeleopStep;

/// A point mass by semi-implicit Euler.
struct Body {
  Eigen::Vector3d x = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero(),
                  a = Eigen::Vector3d::Zero();
  void step(const Eigen::Vector3d& acceleration) {
    a = acceleration;
    v += kTeleopStep * a;
    x += kTeleopStep * v;
  }
};

/// Orientation of the slave and its first two derivatives (rad): smooth sines.
struct SlaveTurn {
  Eigen::Vector3d angle, rate, acceleration;
  SlaveTurn(const TeleopConfig& config, double t) : angle(config.orientation_center) {
    constexpr double kHz[3] = {0.05, 0.065, 0.08};
    for (int i = 0; i < 3; ++i) {
      const double w = 2.0 * std::numbers::pi * kHz[i], a = config.orientation_amplitude;
      angle[i] += a * std::sin(w * t);
      rate[i] = a * w * std::cos(w * t);
      acceleration[i] = -a * w * w * std::sin(w * t);
    }
  }
};

/// Velocity of the intended motion, m/s.
Eigen::Vector3d intended_rate(const TeleopConfig& config, double t);

/// The slave with its impedance, the wall, and the sensor between flange and tool.
class SlaveSide {
 public:
  SlaveSide(const TeleopConfig& config, std::uint64_t seed);
  /// Force of the wall on the slave now, N in B.
  const Eigen::Vector3d& contact() const { return contact_; }
  const Body& body() const { return slave_; }
  /// Begins tick t; the contact is from now on that of this moment.
  void begin(double t);
  const Eigen::Vector3d& orientation() const { return turn_.angle; }
  /// What the sensor reads in S: the tool's own force, the contact, noise.
  Eigen::Vector3d measured();
  /// One tick under a command held.
  void integrate(const Command& command);

 private:
  Eigen::Vector3d wall_force() const;

  const TeleopConfig& config_;
  Rng rng_;
  double damping_, t_ = 0.0;
  Body slave_;
  Eigen::Vector3d contact_ = Eigen::Vector3d::Zero();
  SlaveTurn turn_;
};

/// The hand on the master, and the link in both directions.
class MasterSide {
 public:
  MasterSide(const TeleopConfig& config, std::uint64_t seed);
  /// Begins a tick with the external force that the slave's side sends [N in B]; the command that
  /// has arrived there.
  Command control(const Eigen::Vector3d& estimated);
  /// One tick from t on.
  void integrate(double t);
  const Body& body() const { return master_; }
  const Eigen::Vector3d& felt() const { return felt_; }
  const PassivityGuard& guard() const { return guard_; }

 private:
  const TeleopConfig& config_;
  Link forward_, backward_;
  PassivityGuard guard_;
  double smoothing_;
  Body hand_, master_;
  Eigen::Vector3d filtered_ = Eigen::Vector3d::Zero(), felt_ = Eigen::Vector3d::Zero();
};

/// An empty trace of so many ticks.
TeleopTrace make_trace(Index ticks);
/// What the slave's side knows at a tick.
struct SlaveTick {
  Eigen::Vector3d x, contact, estimated, orientation;
};
void store(Index k, const TeleopConfig& config, const SlaveTick& slave, const MasterSide& master,
           TeleopTrace& trace);

}  // namespace dcnn
