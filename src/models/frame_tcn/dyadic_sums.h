// SPDX-License-Identifier: Apache-2.0
// Sums over the last 1, 2, 4, … rows of a stream.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn::frame_tcn {

/// A sum over 2^(k+1) rows is one over 2^k of them and the one that ended 2^k rows ago: an addition
/// a level, and no rounding that a running sum would gather. Rows before the first are zero.
class DyadicSums {
 public:
  /// `lags`: for each of level 0, 1, 2, … how many rows ago the oldest sum asked for ended.
  DyadicSums(Index columns, const std::vector<Index>& lags);
  void reset() noexcept;
  void push(const Eigen::VectorXd& row) noexcept;
  /// (columns) sum over the 2^level rows that ended `lag` rows ago; 0 is the newest row.
  auto at(std::size_t level, Index lag) const { return rings_[level].col(place(level, lag)); }

 private:
  /// The rings' lengths are powers of two.
  Index place(std::size_t level, Index lag) const {
    return (count_ - lag) & (rings_[level].cols() - 1);
  }

  std::vector<Eigen::MatrixXd> rings_;
  Index count_ = 0;
};

}  // namespace dcnn::frame_tcn
