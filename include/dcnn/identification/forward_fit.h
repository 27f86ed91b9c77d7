// SPDX-License-Identifier: Apache-2.0
// Numbers of a machine's axis refined so that the motion simulated from its drive follows the log.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dcnn/physics/forward.h"

namespace dcnn {

/// The motion that the drive of a recording makes, (T, 2) position and velocity in the units of the
/// log, beginning with the logged ones. Error(kData) without the axis' position, or in more than
/// one stretch of time.
Eigen::MatrixXd simulated_motion(const AxisMachine& machine, std::size_t axis,
                                 const Recording& recording);

/// RMSE of a simulated position in the log's unit.
struct ForwardError {
  double whole = 0.0;  ///< of all rows
  double settled =
      0.0;  ///< of all but the first twentieth, in which the unknown state at the start decays
};
ForwardError error_of(const Eigen::MatrixXd& simulated, const Recording& recording,
                      const Axis& axis);

struct ForwardFit {
  AxisMachine machine;
  std::vector<std::string> names;
  Eigen::VectorXd before, after,
      deviation;  ///< of the numbers; deviation from the errors' variance
  double rmse_before = 0.0, rmse_after = 0.0;  ///< settled, over the recordings together
  int steps = 0;
};
/// Least squares of the settled rows by Levenberg and Marquardt (Marquardt 1963); `progress` hears
/// of each step. The structure stays as it is.
ForwardFit refine_forward(const AxisMachine& machine, std::size_t axis,
                          const std::vector<Recording>& recordings,
                          const std::function<void(const std::string&)>& progress);

}  // namespace dcnn
