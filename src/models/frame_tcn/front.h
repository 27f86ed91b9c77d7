// SPDX-License-Identifier: Apache-2.0
// The convolutions: per kinematic axis a bank of causal filters, each the best linear estimate of
// the clean newest sample at one level of noise (Wiener). Where a segment is younger than the
// filter, the best estimate from the blocks there are: whatever stood for the others would be noise
// that the filter does not know of.
#pragma once

#include <array>

#include "models/frame_tcn/blocks.h"

namespace dcnn::frame_tcn {

constexpr Index kGroups = 6;  ///< rotation about, then translation along each axis

/// Known blocks that there are filters for: of 504 samples, then of 1, 2, 4, 8, 24, 56, 120, 248.
constexpr std::array<Index, 9> kHistories{kBlocks, 1, 2, 4, 8, 16, 24, 32, 40};

/// The channels that one group reads and estimates: theta, theta', theta'' or v, a of one axis.
constexpr Index channel_count(Index group) { return group < 3 ? 3 : 2; }
constexpr Index group_channel(Index group, Index k) { return group + 6 * k; }
std::vector<Index> group_channels(Index group);

/// Which of kHistories is for a row with so many known blocks.
std::size_t history_of(Index known);

/// One group's weights for each of kHistories, (channels·experts, channels·known), row
/// c·experts + e.
using Bank = std::array<Eigen::MatrixXd, kHistories.size()>;

class Front {
 public:
  Front() = default;
  explicit Front(Index experts);  ///< all weights zero

  /// Of 48 "experts": every block mean is handed on as it is; those that a young segment does not
  /// have equal the oldest that it has.
  void hand_on_blocks();

  /// Estimates of rows [first, first + count), (15·experts, count), row channel·experts + e;
  /// 14 976 multiply-adds a row with 8 experts.
  Eigen::MatrixXd apply(const BlockMeans& blocks, Index first, Index count) const;

  Index experts = 0;
  std::array<Bank, kGroups> weights;

 private:
  /// The same for rows of one history.
  void apply(const BlockMeans& blocks, Index first, std::size_t history,
             Eigen::Ref<Eigen::MatrixXd> result) const;
};

/// Second moments of a group's block means, and with its newest samples.
struct Moments {
  Eigen::MatrixXd blocks;  ///< (48·channels, 48·channels)
  Eigen::MatrixXd newest;  ///< (48·channels, channels)
  Eigen::VectorXd power;   ///< (channels) of the newest samples
};

/// Of every `stride`-th row whose blocks are all known; of every such row at all where none is.
Moments moments(const BlockMeans& blocks, Index group, Index stride);

/// Second moments of the block means of white noise with the given variances.
Eigen::MatrixXd white_noise_moments(const Eigen::VectorXd& variances);

/// w of (S + N + 1e-7 I) w = b for the newest `known` blocks, transposed, (channels,
/// known·channels).
Eigen::MatrixXd wiener(const Moments& signal, const Eigen::MatrixXd& noise, Index known = kBlocks);

/// Mean squared error of the estimate of each channel by `weights` of all blocks.
Eigen::VectorXd expected_error(const Moments& signal, const Eigen::MatrixXd& noise,
                               const Eigen::MatrixXd& weights);

/// The newest point of the least-squares line through the last 64 samples (or through all of fewer
/// known blocks) of each channel alone, as block weights: a filter that nothing was learned for.
Eigen::MatrixXd line_fit(Index channels, Index known = kBlocks);

}  // namespace dcnn::frame_tcn
