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
  double sd = 0.0;       ///< of the estimates without one of ten blocks of time (jackknife)
  bool certain = false;  ///< one valley within the reach, its 95 % interval below one step
  std::vector<double> shifts, residual_rms;  ///< what a rigid tool leaves at each shift, N
};

/// F(t) = a·u(t - d) + b·a(t - d) + c, with u the vertical and a the acceleration of the origin in
/// the sensor's frame: the shift d in [-most, most] that leaves least. Delays of filters in the
/// sensor are part of it.
ClockOffset estimate_clock_offset(const ClockPair& pair, double most);

}  // namespace dcnn
