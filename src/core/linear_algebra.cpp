// SPDX-License-Identifier: Apache-2.0
#include "core/linear_algebra.h"

#include <cmath>

namespace dcnn {

Eigen::MatrixXd solve_symmetric(const MatrixRef& A, const MatrixRef& b) {
  return A.ldlt().solve(b);
}

Eigen::MatrixXd solve_gram(const MatrixRef& gram, const MatrixRef& b, double ridge) {
  const Eigen::VectorXd scale =
      gram.diagonal().unaryExpr([](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  Eigen::MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  scaled.diagonal().array() += ridge;
  return scale.asDiagonal() * solve_symmetric(scaled, scale.asDiagonal() * b);
}

std::optional<Eigen::MatrixXd> solve_definite(const MatrixRef& A, const MatrixRef& b) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(A);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  return cholesky.solve(b);
}

Eigen::MatrixXd solve_least_squares(const MatrixRef& A, const MatrixRef& b) {
  return A.householderQr().solve(b);
}

Eigen::MatrixXd cholesky(const MatrixRef& A) { return A.llt().matrixL(); }

Eigen::MatrixXd inverse_cholesky(const MatrixRef& A) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(A.rows(), A.cols());
  return cholesky(A).triangularView<Eigen::Lower>().solve(identity);
}

Eigen::MatrixXd triangle_of(Eigen::MatrixXd A) {
  const Eigen::Index size = A.cols();
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(A);
  return A.topRows(size).triangularView<Eigen::Upper>();
}

SingularValues singular_values(const MatrixRef& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::HouseholderQRPreconditioner> svd(
      A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

Spectrum spectrum_of(const MatrixRef& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

}  // namespace dcnn
