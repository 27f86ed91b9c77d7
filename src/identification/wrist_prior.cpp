// SPDX-License-Identifier: Apache-2.0
#include "identification/wrist_prior.h"

#include <cmath>

namespace dcnn::identification {

using Eigen::VectorXd;

namespace {

constexpr double kHeaviest = 1000.0, kFarthest = 0.5;      // kg, m
constexpr double kLargestBias = 1e4;                       // N, N·m
constexpr double kLargestTilt = 0.2, kLargestShare = 0.5;  // rad; of a force in another channel
constexpr double kLargestAmplitude = 1e6;

}  // namespace

VectorXd prior_deviation(const Layout& layout, const WristState& state) {
  const double mass = state.mass;
  VectorXd sd = VectorXd::Constant(layout.size(), kLargestAmplitude);
  sd[0] = kHeaviest;
  sd.segment(1, 3).setConstant(mass * kFarthest);
  if (layout.torque) sd.segment(layout.inertia(), 6).setConstant(mass * kFarthest * kFarthest);
  if (layout.mounting) sd.segment(layout.turn(), 3).setConstant(M_PI);
  sd.segment(layout.bias(), layout.torque ? 6 : 3).setConstant(kLargestBias);
  Index at = layout.first_amplitude();
  for (const Law& law : state.laws) {
    for (const std::string& unit : law.units) {
      if (unit == "rad") sd[at] = kLargestTilt;
      if (unit.empty()) sd[at] = kLargestShare;
      ++at;
    }
  }
  return sd;
}

}  // namespace dcnn::identification
