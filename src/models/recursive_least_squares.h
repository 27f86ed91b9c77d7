// SPDX-License-Identifier: Apache-2.0
// Online least squares with exponential forgetting, in square-root information form.
#pragma once

#include <Eigen/Dense>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// After n updates solve() is the least-squares solution with weight forgetting^(n-i) on row i and
/// a ridge on the weights that is not forgotten. The triangle of the weighted rows is rotated by
/// Givens rotations (QR-RLS; Haykin, Adaptive Filter Theory, ch. 15): it stays the factor of a
/// positive matrix whatever the rounding, and since the ridge is renewed the covariance cannot blow
/// up while nothing excites a direction: its trace is at most columns/(ridge·forgetting^columns).
class RecursiveLeastSquares {
 public:
  /// forgetting in (0, 1], ridge > 0.
  RecursiveLeastSquares(Index columns, Index targets, double forgetting, double ridge);

  void update(const Eigen::VectorXd& terms, const Eigen::VectorXd& targets);
  Eigen::MatrixXd solve() const;    ///< (columns, targets)
  double covariance_trace() const;  ///< of the inverse of the weighted sum of squares

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Rotates the row in work_ into the triangle; its columns before `first` are zero.
  void rotate_in(Index first);
  /// Once in `columns` updates: what was forgotten of the ridge since.
  void renew_ridge();

  Index columns_, since_renewal_ = 0;
  double forgetting_, ridge_;
  RowMajor triangle_;  // (columns, columns + targets): R and Q^T·Y
  Eigen::RowVectorXd work_;
};

}  // namespace dcnn
