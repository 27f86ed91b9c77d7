// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/columns.h"

#include <algorithm>

#include "core/linear_algebra.h"

namespace dcnn {
namespace {

constexpr double kImitated = 1e-6;  // of a column's norm: what rounding leaves of it off a basis

}  // namespace

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  if (A.cols() == 0) return Eigen::VectorXd(0);
  return solve_gram(A.transpose() * A, A.transpose() * b, 1e-11);
}

Eigen::MatrixXd appended(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(b.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd basis(columns.rows(), columns.cols());
  Index count = 0;
  for (Index k = 0; k < columns.cols(); ++k) {
    Eigen::VectorXd c = columns.col(k);
    const double before = c.norm();
    for (int pass = 0; pass < 2; ++pass) {  // twice is enough (Kahan and Parlett)
      c -= basis.leftCols(count) * (basis.leftCols(count).transpose() * c);
    }
    if (c.norm() > kImitated * before && before > 0.0) basis.col(count++) = c.normalized();
  }
  return basis.leftCols(count);
}

Eigen::MatrixXd off_basis(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& basis) {
  // A few columns beside many rows: blocks of the basis stay in the cache for all of them.
  constexpr Index kProjectedRows = 512;
  if (basis.cols() == 0) return columns;
  const Index n = columns.rows(), count = columns.cols();
  Eigen::MatrixXd off = columns, shares = Eigen::MatrixXd::Zero(basis.cols(), count);
  for (Index begin = 0; begin < n; begin += kProjectedRows) {
    const auto rows = basis.middleRows(begin, std::min(kProjectedRows, n - begin));
    for (Index k = 0; k < count; ++k) {
      shares.col(k).noalias() += rows.transpose() * columns.col(k).segment(begin, rows.rows());
    }
  }
  for (Index begin = 0; begin < n; begin += kProjectedRows) {
    const auto rows = basis.middleRows(begin, std::min(kProjectedRows, n - begin));
    for (Index k = 0; k < count; ++k) {
      off.col(k).segment(begin, rows.rows()).noalias() -= rows * shares.col(k);
    }
  }
  for (Index k = 0; k < count; ++k) {
    if (off.col(k).norm() <= kImitated * columns.col(k).norm()) off.col(k).setZero();
  }
  return off;
}

}  // namespace dcnn
