// SPDX-License-Identifier: Apache-2.0
// Linear least squares over any number of rows in fixed memory.
#pragma once

#include <Eigen/Dense>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// Minimises |A·W - Y|^2 for rows that come in pieces. What is kept is the triangle of the QR
/// factorisation of [A Y], so that nothing is squared: R with R^T·R = A^T·A, Q^T·Y, and what
/// remains of Y.
class LeastSquares {
 public:
  LeastSquares(Index columns, Index targets);

  /// Adds rows: a (n, columns), y (n, targets).
  void add(const Eigen::MatrixXd& a, const Eigen::MatrixXd& y);

  Index rows() const { return rows_; }
  /// R (columns, columns), upper triangular.
  Eigen::MatrixXd factor() const;
  /// Q^T·Y (columns, targets).
  Eigen::MatrixXd projected() const;
  /// Standard deviation of what the unrestricted fit leaves of each target.
  Eigen::VectorXd residual_deviation() const;
  /// Root of the mean square of each target, and of each column.
  Eigen::VectorXd target_rms() const;
  Eigen::VectorXd column_rms() const;

 private:
  Index columns_, rows_ = 0;
  Eigen::MatrixXd triangle_;  // of [A Y]
};

/// One problem |A·w - y|^2 -> least, in its own units.
struct DenseProblem {
  Eigen::MatrixXd a;     ///< (n, p)
  Eigen::VectorXd y;     ///< (n)
  Eigen::VectorXd size;  ///< (p) of each column as it will be used; 0 counts as 1
  double noise = 0.0;    ///< standard deviation of the errors of y
  double largest = 0.0;  ///< most that w·size can reasonably be
  double ridge = 0.0;    ///< added to the square of every scaled singular value
};

/// w by singular values in units of `size`, each square raised by the ridge. Directions below 1e-11
/// of the largest are left out.
Eigen::VectorXd solve(const DenseProblem& problem);

/// All targets of a problem rolled into its triangle. `groups`: columns of one kind share the
/// number, and so the size: a component that hardly moved is small beside its sisters, not of its
/// own size. Each direction is weighed by what the rows tell about it against what is known before,
/// that no term is much larger than the target: where the data are exact this is plain least
/// squares; where a direction was hardly excited, as in a planar motion, its weight stays small
/// instead of being noise divided by nearly zero. `ridge` is added on R^T·R/rows.
Eigen::MatrixXd solve(const LeastSquares& sums, const std::vector<Index>& groups, double ridge);

/// The ridge that solve() uses for each target, on R^T·R in units of the groups' sizes:
/// (noise/largest)^2·c, the Bayesian one for Gaussian errors of which c neighbours are alike and
/// weights of the order of `largest`, ten times the target's root mean square.
Eigen::VectorXd known_before(const LeastSquares& sums);

/// Root of the mean square within the group of each column.
Eigen::VectorXd group_sizes(const Eigen::VectorXd& rms, const std::vector<Index>& groups);

}  // namespace dcnn
