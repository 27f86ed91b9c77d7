// The convolutions: per kinematic axis a bank of causal filters, each the best linear estimate of
// the clean newest sample at one level of noise (Wiener).
#pragma once

#include <array>

#include "models/frame_tcn/blocks.h"

namespace dcnn::frame_tcn {

constexpr Index kGroups = 6;  ///< rotation about, then translation along each axis

/// The channels that one group reads and estimates: theta, theta', theta'' or v, a of one axis.
std::vector<Index> group_channels(Index group);

/// Weights of every group, (channels·experts, channels·48); row c·experts + e.
struct Front {
  Index experts = 0;
  std::array<Eigen::MatrixXd, kGroups> weights;

  /// Estimates of rows [first, first + count), (15·experts, count), row channel·experts + e;
  /// 14 976 multiply-adds a row with 8 experts.
  Eigen::MatrixXd apply(const BlockMeans& blocks, Index first, Index count) const;
};

/// Second moments of a group's block means, and with its newest samples.
struct Moments {
  Eigen::MatrixXd blocks;  ///< (48·channels, 48·channels)
  Eigen::MatrixXd newest;  ///< (48·channels, channels)
  Eigen::VectorXd power;   ///< (channels) of the newest samples
};

/// Means over every `stride`-th row of the block means of the group, (48·channels, 48·channels).
Moments moments(const BlockMeans& blocks, Index group, Index stride);

/// Second moments of the block means of white noise with the given variances.
Eigen::MatrixXd white_noise_moments(const Eigen::VectorXd& variances);

/// w of (S + N + 1e-7 I) w = b, transposed: (channels, 48·channels).
Eigen::MatrixXd wiener(const Moments& signal, const Eigen::MatrixXd& noise);

/// Mean squared error of the estimate of each channel by `weights`.
Eigen::VectorXd expected_error(const Moments& signal, const Eigen::MatrixXd& noise,
                               const Eigen::MatrixXd& weights);

/// The newest point of the least-squares line through the last 64 samples, of each channel alone,
/// as block weights: a filter that nothing was learned for.
Eigen::MatrixXd line_fit(Index channels);

}  // namespace dcnn::frame_tcn
