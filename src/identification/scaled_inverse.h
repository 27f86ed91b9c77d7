// The inverse of normal equations whose parameters have unlike units.
#pragma once

#include <Eigen/Core>

namespace dcnn::identification {

/// Of a symmetric matrix, scaled to a unit diagonal; eigenvalues below 1e-13 are raised to it.
Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& information);

}  // namespace dcnn::identification
