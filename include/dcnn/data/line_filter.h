// SPDX-License-Identifier: Apache-2.0
// The newest value of a straight line through the last samples: a causal filter that has no lag on
// anything that moves evenly.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// Least-squares lines through the last `length` rows, column by column, in constant time a row:
/// with S0 = sum x_{t-i} and S1 = sum i·x_{t-i} the line's value at t is
/// (2(2n-1)·S0 - 6·S1)/(n(n+1)). White noise leaves it with (4n-2)/(n(n+1)) of its power.
class LineFilter {
 public:
  LineFilter(Index length, Index columns);

  /// Begins a segment: all rows before its first one are taken to equal it.
  void restart(const Eigen::RowVectorXd& first);
  /// The next row of the segment (its first one included); the line's values at it.
  void push(const Eigen::RowVectorXd& row, Eigen::RowVectorXd& value);

 private:
  Index length_, oldest_ = 0;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> past_;  // a ring
  Eigen::RowVectorXd sum_, moment_;
};

/// The filter over a whole stream, (N, F); no line crosses a segment's ends.
Eigen::MatrixXd line_filtered(const Eigen::MatrixXd& x, const std::vector<Index>& segment_begin,
                              Index length);

}  // namespace dcnn
