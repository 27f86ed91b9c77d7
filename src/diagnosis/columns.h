// SPDX-License-Identifier: Apache-2.0
// Columns of a regression: solved for, joined, made orthonormal.
#pragma once

#include <Eigen/Core>

namespace dcnn {

/// Coefficients x that minimise |Ax - b|, columns scaled, with a ridge that only decides what the
/// data leave open.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// The columns of a, then those of b.
Eigen::MatrixXd appended(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// An orthonormal basis of the columns.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

/// Columns without their part along an orthonormal basis; one that the basis imitates to rounding
/// is zero, so that nothing is fitted along it.
Eigen::MatrixXd off_basis(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& basis);

}  // namespace dcnn
