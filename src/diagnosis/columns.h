// Columns of a regression: solved for, joined, made orthonormal.
#pragma once

#include <Eigen/Core>

namespace dcnn {

inline constexpr double kLeastRidge = 1e-11;  ///< numerical tolerance

/// Coefficients x that minimise |Ax - b|, columns scaled to length 1, with a ridge beside their
/// squares: the least one only decides what the data leave open.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                              double ridge = kLeastRidge);

/// The columns of a, then those of b.
Eigen::MatrixXd appended(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// An orthonormal basis of the columns.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

/// Columns without their part along an orthonormal basis; one that the basis imitates to rounding
/// is zero, so that nothing is fitted along it.
Eigen::MatrixXd off_basis(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& basis);

}  // namespace dcnn
