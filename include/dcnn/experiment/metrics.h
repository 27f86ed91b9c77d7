// SPDX-License-Identifier: Apache-2.0
// How well forces are predicted (spec section 3).
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// Errors of one prediction, per target and over all.
struct Score {
  std::vector<double> rmse;     ///< Eq. 5 with 1/N under the root (D2)
  std::vector<double> max_abs;  ///< largest absolute error
  std::vector<double> r2;       ///< 1 - SSE/SST; 0 where the target does not vary
  std::optional<double>
      overall;  ///< Eq. 6: mean RMSE of the force targets, or of all that share one unit
  std::optional<double> overall_torque;  ///< mean RMSE of the torques beside forces
  std::optional<double> vector_rmse;  ///< rms length of the error vector of what `overall` covers
};

/// Both (N, targets), in the targets' units.
Score score(const Eigen::MatrixXd& predicted, const Eigen::MatrixXd& wanted,
            const Targets& targets);

/// Mean and sample standard deviation (R - 1; 0 for one value).
struct Spread {
  double mean = 0.0, deviation = 0.0;
};
Spread spread(const std::vector<double>& values);

}  // namespace dcnn
