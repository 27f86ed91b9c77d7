// SPDX-License-Identifier: Apache-2.0
#include "identification/normal_equations.h"

#include "core/linear_algebra.h"

namespace dcnn::identification {

Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const auto [values, vectors] = spectrum_of(scaled);
  const Eigen::VectorXd safe = values.cwiseMax(1e-13).cwiseInverse();
  return scale.asDiagonal() * vectors * safe.asDiagonal() * vectors.transpose() *
         scale.asDiagonal();
}

}  // namespace dcnn::identification
