// SPDX-License-Identifier: Apache-2.0
// Linear systems by Eigen's decompositions, compiled once: each costs every file that names it
// seconds.
#pragma once

#include <Eigen/Dense>
#include <optional>

namespace dcnn {

using MatrixRef = Eigen::Ref<const Eigen::MatrixXd>;

/// x of A·x = b (n,k), A (n,n) symmetric, perhaps singular: LDLT.
Eigen::MatrixXd solve_symmetric(const MatrixRef& A, const MatrixRef& b);

/// The same for a Gram matrix brought to a diagonal of ones plus `ridge`, whatever units its
/// columns have; columns of zeros get zeros.
Eigen::MatrixXd solve_gram(const MatrixRef& gram, const MatrixRef& b, double ridge);

/// x of A·x = b, A positive definite: Cholesky; nothing where it is not.
std::optional<Eigen::MatrixXd> solve_definite(const MatrixRef& A, const MatrixRef& b);

/// The x that makes |A·x - b| least, (m,n) with m >= n and full rank: Householder.
Eigen::MatrixXd solve_least_squares(const MatrixRef& A, const MatrixRef& b);

/// L of A = L·L^T, A positive definite; its inverse makes white what has covariance A.
Eigen::MatrixXd cholesky(const MatrixRef& A);
Eigen::MatrixXd inverse_cholesky(const MatrixRef& A);

/// R of A = Q·R, (n,n) from (m,n), m >= n: Householder, on the memory of A.
Eigen::MatrixXd triangle_of(Eigen::MatrixXd A);

/// A (m,n) as U·diag(values)·V^T, values descending, U and V thin.
struct SingularValues {
  Eigen::MatrixXd U, V;
  Eigen::VectorXd values;
};
SingularValues singular_values(const MatrixRef& A);

/// A symmetric matrix as vectors·diag(values)·vectors^T, values ascending.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
Spectrum spectrum_of(const MatrixRef& A);

}  // namespace dcnn
