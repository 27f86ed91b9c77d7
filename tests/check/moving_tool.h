// SPDX-License-Identifier: Apache-2.0
// A tool on a motion that never rests, as logs of tests begin.
#pragma once

#include <cmath>
#include <random>
#include <string>

#include "dcnn/check/check.h"
#include "dcnn/data/rotation.h"

namespace dcnn::moving_tool {

inline constexpr Eigen::Index kToolRows = 4000;
inline constexpr double kToolStep = 0.004, kForceNoise = 0.05;

/// A tool of 1 kg on a motion that never rests, with noise of the pose's and the force's sensors.
inline Table log() {
  Table table{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"},
              Eigen::MatrixXd(kToolRows, 10)};
  std::mt19937 random(11);
  std::normal_distribution<double> noise;
  const auto position = [](double t) {
    return Eigen::Vector3d(0.4 + 0.1 * std::sin(1.7 * t), 0.1 * std::cos(1.3 * t),
                           0.3 + 0.06 * std::sin(2.1 * t));
  };
  for (Eigen::Index i = 0; i < kToolRows; ++i) {
    const double t = kToolStep * static_cast<double>(i), h = 1e-3;
    const Eigen::Vector3d acceleration =
        (position(t + h) - 2.0 * position(t) + position(t - h)) / (h * h);
    const Eigen::Vector3d angles(0.5 * std::sin(0.9 * t), 0.4 * std::sin(1.1 * t + 1.0),
                                 0.5 * std::cos(0.7 * t));
    const Eigen::Vector3d force =
        rotation_from_euler(angles).transpose() * (Eigen::Vector3d(0.0, 0.0, -9.81) - acceleration);
    const auto noisy = [&](const Eigen::Vector3d& v, double size) {
      return Eigen::Vector3d(v +
                             size * Eigen::Vector3d(noise(random), noise(random), noise(random)));
    };
    table.values.row(i) << t, noisy(position(t), 1e-5).transpose(), noisy(angles, 6e-5).transpose(),
        noisy(force + Eigen::Vector3d(1.0, -2.0, 12.5), kForceNoise).transpose();
  }
  return table;
}

enum Column { kT, kX, kY, kZ, kAlpha, kBeta, kGamma, kFx, kFy, kFz };

inline check::Report report_of(Table table) {
  check::Declared declared;
  declared.model = ToolModel();
  declared.model->mass = 1.0;
  return check::check(check::make_log("log.csv", std::move(table), declared));
}

}  // namespace dcnn::moving_tool
