// SPDX-License-Identifier: Apache-2.0
// Motions as uniform B-splines of degree 5: control points in, what the robot does out.
#pragma once

#include <string>
#include <vector>

#include "dcnn/core/random.h"
#include "dcnn/design/limits.h"
#include "dcnn/physics/motion.h"

namespace dcnn::design {

/// Control points (N, coordinates) `spacing` s apart. The first and the last five are the start:
/// there position, velocity, acceleration and jerk are those of rest (de Boor 1978). Every value
/// lies within the range of the points.
struct Spline {
  double spacing = 1.0;
  Eigen::MatrixXd points;

  double seconds() const { return spacing * static_cast<double>(points.rows() - 5); }
};

/// Values and derivatives of a spline, (T, coordinates) each.
struct SplineSamples {
  Eigen::VectorXd t;
  Eigen::MatrixXd value, first, second, third;
};
SplineSamples sample(const Spline& spline, double rate_hz);

/// What the robot does at so many samples a second.
struct Played {
  SplineSamples coordinates;  ///< the pose, or the joints
  Eigen::MatrixXd pose;       ///< (T, 6) x,y,z,alpha,beta,gamma, angles continuous
  Motion motion;              ///< exact, of the sensor mounted as `model` says; t from `start_s` on
};
Played play(const Spline& spline, const Limits& limits, const ToolModel& model, double rate_hz,
            double start_s);

/// How much of a limit a motion uses: 1 is all of it.
struct Usage {
  std::string limit;  ///< "speed_mps", "range of x", "speed of joint 2"
  double share = 0.0;
  bool turning = false;  ///< of the orientation of a pose
};
/// Of every limit that is set, at the samples played.
std::vector<Usage> usage(const Played& played, const Limits& limits);

/// The spline shrunk towards the start as far as the limits need: positions and angles of a pose
/// each by a factor of their own. Limits hold between samples too, by a margin for what lies
/// between them.
Spline within(Spline spline, const Limits& limits, double rate_hz);

}  // namespace dcnn::design
