// SPDX-License-Identifier: Apache-2.0
// A recording on slow sines whose derivatives are known, at any rate.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "dcnn/data/recording.h"
#include "dcnn/data/rotation.h"

namespace dcnn::testing {

/// value = a·sin(w·t + p) and its derivatives.
struct Sine {
  double a, w, p;
  double at(double t, int derivative) const {
    const double phase = w * t + p;
    if (derivative == 0) return a * std::sin(phase);
    return derivative == 1 ? a * w * std::cos(phase) : -a * w * w * std::sin(phase);
  }
};

inline Eigen::Vector3d three(const Sine (&sines)[3], double t, int derivative) {
  return {sines[0].at(t, derivative), sines[1].at(t, derivative), sines[2].at(t, derivative)};
}

inline constexpr Sine kPositions[3] = {{0.12, 2.0, 0.1}, {0.10, 3.0, 1.0}, {0.08, 2.5, 2.0}};
inline constexpr Sine kAngles[3] = {{1.0, 2.0, 0.3}, {0.6, 1.5, 0.7}, {0.7, 2.2, 1.1}};

/// Columns t, x,y,z, alpha,beta,gamma, fx,fy,fz; the tool points down (gamma about pi).
inline Recording sine_recording(Index samples, double dt = 0.002) {
  Recording recording;
  recording.name = "sines.csv";
  recording.table.columns = {"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"};
  recording.table.values.resize(samples, 10);
  for (Index i = 0; i < samples; ++i) {
    const double t = dt * static_cast<double>(i);
    Eigen::Vector3d angles = three(kAngles, t, 0);
    angles[2] += 3.14159;
    recording.table.values.row(i) << t, three(kPositions, t, 0).transpose(), angles.transpose(), 1,
        2, 3;
  }
  recording.dt = dt;
  recording.segments = {{0, samples}};
  return recording;
}

/// The same with quaternions in place of Euler angles.
inline Recording with_quaternions(const Recording& euler) {
  Recording out = euler;
  const Eigen::MatrixXd q = quaternions(euler);
  const char* names[] = {"qw", "qx", "qy", "qz"};
  for (Index k = 0; k < 4; ++k) out.set(names[k], q.col(k));
  for (const char* name : {"alpha", "beta", "gamma"}) {
    for (std::string& column : out.table.columns) {
      if (column == name) column = std::string("logged_") + name;
    }
  }
  return out;
}

}  // namespace dcnn::testing
