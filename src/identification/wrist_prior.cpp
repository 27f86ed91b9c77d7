// SPDX-License-Identifier: Apache-2.0
#include "identification/wrist_prior.h"

#include <cmath>

namespace dcnn::identification {

using Eigen::VectorXd;

namespace {

constexpr double kHeaviest = 1000.0, kFarthest = 0.5;  // kg, m
constexpr double kLargestBias = 1e4;                   // N, N·m
constexpr double kLargestAmplitude = 1e6;

}  // namespace

VectorXd prior_deviation(const Layout& layout, double mass) {
  VectorXd sd = VectorXd::Constant(layout.size(), kLargestAmplitude);
  sd[0] = kHeaviest;
  sd.segment(1, 3).setConstant(mass * kFarthest);
  if (layout.torque) sd.segment(layout.inertia(), 6).setConstant(mass * kFarthest * kFarthest);
  if (layout.mounting) sd.segment(layout.turn(), 3).setConstant(M_PI);
  sd.segment(layout.bias(), layout.torque ? 6 : 3).setConstant(kLargestBias);
  return sd;
}

}  // namespace dcnn::identification
