// SPDX-License-Identifier: Apache-2.0
// How far the clock of a pose is off from that of a force, from the motion itself.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// Two streams, s on their own clocks.
struct ClockPair {
  std::vector<double> t;  ///< of the force
  Eigen::MatrixXd force;  ///< (rows, 3)
  std::vector<double> pose_t;
  Eigen::MatrixXd pose;  ///< (rows, 7): x y z, qw qx qy qz
  double step = 0.0;     ///< s, the slower stream's: an offset below it does no harm
};

struct ClockOffset {
  double seconds = 0.0;  ///< to add to the pose's times
  double half = 0.0;     ///< of its 95 % interval: the true offset is within seconds +- half
  bool certain = false;  ///< one valley within the reach, `half` below one step
  std::vector<double> shifts, residual_rms;  ///< what a rigid tool leaves at each shift, N
};

/// The shift d in [-most, most] at which a rigid tool with friction in any direction leaves least
/// of the force: F(t) is a linear combination of 1 and, all at t - d and in the sensor's frame, the
/// vertical, the acceleration a of the origin, dw/dt, the products of the rates w, the velocity v
/// and v/|v|. Both sides are low-passed alike, by the cut-off of 0.5, 1, 2, … 16 Hz that tells
/// most. `half` is the largest of three: the spread of the estimates without one of ten blocks of
/// time (jackknife), the likelihood's width, and the distance to the estimate an octave below.
/// Delays of filters in the sensor are part of the offset.
ClockOffset estimate_clock_offset(const ClockPair& pair, double most);

}  // namespace dcnn
