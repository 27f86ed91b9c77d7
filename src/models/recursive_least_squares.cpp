// SPDX-License-Identifier: Apache-2.0
#include "models/recursive_least_squares.h"

#include <cassert>
#include <cmath>

namespace dcnn {

RecursiveLeastSquares::RecursiveLeastSquares(Index columns, Index targets, double forgetting,
                                             double ridge)
    : columns_(columns),
      forgetting_(forgetting),
      ridge_(ridge),
      triangle_(RowMajor::Zero(columns, columns + targets)),
      work_(columns + targets) {
  assert(forgetting > 0.0 && forgetting <= 1.0 && ridge > 0.0);
  triangle_.leftCols(columns).diagonal().setConstant(std::sqrt(ridge));
}

void RecursiveLeastSquares::update(const Eigen::VectorXd& terms, const Eigen::VectorXd& targets) {
  triangle_ *= std::sqrt(forgetting_);
  work_ << terms.transpose(), targets.transpose();
  rotate_in(0);
  if (++since_renewal_ == columns_) renew_ridge();
}

void RecursiveLeastSquares::rotate_in(Index first) {
  for (Index k = first; k < columns_; ++k) {
    if (work_[k] == 0.0) continue;
    const double r = std::hypot(triangle_(k, k), work_[k]);
    const double c = triangle_(k, k) / r, s = work_[k] / r;
    for (Index j = k; j < triangle_.cols(); ++j) {
      const double above = triangle_(k, j), below = work_[j];
      triangle_(k, j) = c * above + s * below;
      work_[j] = c * below - s * above;
    }
  }
}

void RecursiveLeastSquares::renew_ridge() {
  const double kept = std::pow(forgetting_, static_cast<double>(since_renewal_));
  since_renewal_ = 0;
  const double lost = std::sqrt(ridge_ * (1.0 - kept));
  if (lost == 0.0) return;
  for (Index k = 0; k < columns_; ++k) {
    work_.setZero();
    work_[k] = lost;
    rotate_in(k);
  }
}

Eigen::MatrixXd RecursiveLeastSquares::solve() const {
  const Eigen::MatrixXd R = triangle_.leftCols(columns_);
  Eigen::MatrixXd weights = triangle_.rightCols(triangle_.cols() - columns_);
  R.triangularView<Eigen::Upper>().solveInPlace(weights);
  return weights;
}

double RecursiveLeastSquares::covariance_trace() const {
  const Eigen::MatrixXd R = triangle_.leftCols(columns_);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(columns_, columns_);
  R.triangularView<Eigen::Upper>().solveInPlace(inverse);
  return inverse.squaredNorm();
}

}  // namespace dcnn
