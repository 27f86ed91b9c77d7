#include "diagnosis/columns.h"

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
  Eigen::MatrixXd off = columns - basis * (basis.transpose() * columns);
  for (Index k = 0; k < off.cols(); ++k) {
    if (off.col(k).norm() <= kImitated * columns.col(k).norm()) off.col(k).setZero();
  }
  return off;
}

}  // namespace dcnn
