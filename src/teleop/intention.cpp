// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/teleop/teleop.h"

namespace dcnn {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Quintic smoothstep.
double smooth(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

/// Its integral from 0.
double smooth_integral(double u) {
  if (u <= 0.0) return 0.0;
  const double v = std::min(u, 1.0);
  return v * v * v * v * (2.5 + v * (v - 3.0)) + std::max(0.0, u - 1.0);
}

/// A clock that stands still from 66 to 78 s: x and y are constant during the contact.
double held_clock(double t) { return t - smooth_integral(t - 65.0) + smooth_integral(t - 78.0); }

}  // namespace

Eigen::Vector3d intended_motion(double t, double push_m) {
  const double held = held_clock(t);
  const double swing = 1.0 - smooth((t - 60.0) / 5.0) + smooth(t - 79.0);
  const double push = smooth((t - 68.0) / 3.0) - smooth((t - 74.0) / 2.5);
  return {0.03 * std::sin(kTwoPi * 0.07 * held), 0.03 * std::sin(kTwoPi * 0.05 * held),
          0.02 * std::sin(kTwoPi * 0.1 * t) * swing - push_m * push};
}

}  // namespace dcnn
