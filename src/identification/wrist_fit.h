// SPDX-License-Identifier: Apache-2.0
// Maximum likelihood of the rigid tool behind a mounting, under coloured noise.
#pragma once

#include <optional>

#include "identification/laws.h"
#include "identification/whitener.h"

namespace dcnn::identification {

struct WristFit {
  Layout layout;
  WristState state;
  std::vector<WristColumns> columns;             ///< of each log
  std::vector<std::vector<ChannelNoise>> noise;  ///< of each log and channel
  Eigen::MatrixXd information;                   ///< J^T J of white rows, with what is known before
  Eigen::MatrixXd covariance;                    ///< of the parameters of the layout
  Eigen::VectorXd residual_rms;                  ///< (channels), of the low-passed rows
  Eigen::VectorXd independent;  ///< (channels), rows over their correlation; of a plain fit alone
  double freedom = 0.0;         ///< white rows less parameters
  double condition = 0.0;       ///< least share of a parameter's information that others leave
};

struct FitOptions {
  std::optional<Eigen::Matrix3d> R_ES;  ///< a mounting that is known
  bool laws = true;                     ///< laws beside the tool may be added
  /// Least squares whose rows count as few as their correlation leaves, for residuals that are no
  /// stationary noise: see plain_fit.h.
  bool plain = false;
};

/// The rigid tool and what the data show beside it. A lag is taken off the logs.
WristFit fit_wrist(std::vector<WristLog>& logs, const FitOptions& options);

}  // namespace dcnn::identification
