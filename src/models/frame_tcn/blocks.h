// SPDX-License-Identifier: Apache-2.0
// What the network sees of a channel's past: means over blocks that grow with their age, and how
// rough it is.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn::frame_tcn {

constexpr Index kChannels = 15;  ///< theta, v, theta', a, theta'', three each
constexpr Index kChannelKinds = kChannels / 3;
constexpr Index kBlocks = 48;    ///< 8 each of 1, 2, 4, 8, 16 and 32 samples
constexpr Index kSpan = 504;     ///< samples that the blocks cover
constexpr Index kLevelSpan = 256;
constexpr double kUnknown = -1.0;
constexpr Index kFewest = 4;  ///< differences that a level is judged from

/// Samples of block k; k = 0 is the newest sample.
constexpr Index block_size(Index k) { return Index{1} << (k / 8); }

/// Blocks that so many rows fill, 0 to 48.
Index known_blocks(Index rows);

/// Block means of any row in constant time.
class BlockMeans {
 public:
  /// x (N, C); segments cover the rows, none given is one segment.
  BlockMeans(const Eigen::MatrixXd& x, const std::vector<Segment>& segments);
  /// The first `count` means of one channel that end at `row`, newest first; a segment's rows
  /// before its first are taken to equal the mean of its first 16.
  void write(Index row, Index channel, Index count, double* out) const;
  /// Blocks that lie within the segment of `row`, 1 to 48.
  Index known(Index row) const;
  Index rows() const { return x_.rows(); }

 private:
  const Eigen::MatrixXd& x_;
  Eigen::MatrixXd sum_;  // (N + 1, C): of the rows before
  std::vector<Index> begin_;
};

/// Mean over the last 256 rows of the segment of the product of the second differences of u and w,
/// (C, N). The first `edge` rows of the rates, channel 3 and above, do not count; kUnknown where
/// fewer than `fewest` differences do.
Eigen::MatrixXd roughness(const Eigen::MatrixXd& u, const Eigen::MatrixXd& w,
                          const std::vector<Segment>& segments, Index edge, Index fewest = kFewest);

/// 0.5 log10 of a mean square, held above 1e-8 of the unit.
template <class Squares>
auto level(const Eigen::DenseBase<Squares>& mean_square) {
  return 0.5 * mean_square.derived().array().max(1e-16).log10();
}
Eigen::MatrixXd levels(const Eigen::MatrixXd& mean_square);

/// The stretches of a stream: its segments, or all rows where it names none.
std::vector<Segment> stretches(Index rows, const std::vector<Segment>& segments);

}  // namespace dcnn::frame_tcn
