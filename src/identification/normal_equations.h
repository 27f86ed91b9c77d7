// SPDX-License-Identifier: Apache-2.0
// Normal equations of a fit to several logs.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dcnn::identification {

/// White rows of every log, and their normal equations.
struct White {
  std::vector<Eigen::MatrixXd> J;
  std::vector<Eigen::VectorXd> r;
  Eigen::MatrixXd inverse;
  double rows = 0.0, chi2 = 0.0;
};

struct Normal {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  double rows = 0.0, chi2 = 0.0;
};

/// Of a symmetric matrix whose parameters have unlike units, scaled to a unit diagonal; eigenvalues
/// below 1e-13 are raised to it.
Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& information);

}  // namespace dcnn::identification
