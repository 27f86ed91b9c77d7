// SPDX-License-Identifier: Apache-2.0
// Poses over time with exact derivatives.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/core/options.h"
#include "dcnn/core/parallel.h"
#include "dcnn/core/random.h"

namespace dcnn {

/// Pose of E in B at T instants; blocks are (T,3). `euler` = alpha, beta, gamma, neither wrapped
/// nor noisy.
struct Trajectory {
  double dt = 0.0;    ///< s; 0 for a list of poses at rest
  Eigen::VectorXd t;  ///< s; zero in a list of poses at rest
  Eigen::MatrixXd position, velocity, acceleration;
  Eigen::MatrixXd euler, euler_rate, euler_acceleration;

  bool is_static() const { return dt == 0.0; }
};

/// When a trajectory is sampled.
struct Sampling {
  Index samples = 0;
  double dt = 0.002, t0 = 0.0;  ///< s
};

/// Key `kind` and those of the kind; sizes in m and rad, per coordinate; centres default to 0:
///   multisine       sum of `tones` sines, `hz` [lo,hi] log-spaced, random phases, equal amplitudes
///                   that sum to position_m and angle_rad about position_center_m, angle_center_rad
///   band_multisine  the same keys; f_k = lo·(hi/lo)^((k+u_k)/tones), amplitude
///   f_k^-0.9·U(0.6,1.4),
///                   scaled so that the sampled peaks are position_m and angle_rad
///   static          poses at rest, uniform in angle_center_rad +- angle_rad
/// Faults are Errors with the code of `options`.
Trajectory make_trajectory(Options options, const Sampling& sampling, Rng& rng);
std::vector<std::string> trajectory_kinds();

}  // namespace dcnn
