#include "models/frame_tcn/front.h"

namespace dcnn::frame_tcn {
namespace {

/// Block means of the channels of a group under one another, (48·channels).
void write_group(const BlockMeans& blocks, const std::vector<Index>& channels, Index row,
                 double* out) {
  for (const Index channel : channels) {
    blocks.write(row, channel, out);
    out += kBlocks;
  }
}

}  // namespace

std::vector<Index> group_channels(Index group) {
  if (group < 3) return {group, group + 6, group + 12};
  return {group, group + 6};
}

Eigen::MatrixXd Front::apply(const BlockMeans& blocks, Index first, Index count) const {
  Eigen::MatrixXd result(kChannels * experts, count), past;
  for (Index g = 0; g < kGroups; ++g) {
    const auto channels = group_channels(g);
    past.resize(kBlocks * static_cast<Index>(channels.size()), count);
    for (Index i = 0; i < count; ++i) {
      write_group(blocks, channels, first + i, past.col(i).data());
    }
    const Eigen::MatrixXd estimates = weights[static_cast<std::size_t>(g)] * past;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      result.middleRows(channels[c] * experts, experts) =
          estimates.middleRows(static_cast<Index>(c) * experts, experts);
    }
  }
  return result;
}

Moments moments(const BlockMeans& blocks, Index group, Index stride) {
  const auto channels = group_channels(group);
  const auto size = kBlocks * static_cast<Index>(channels.size());
  constexpr Index kBatch = 256;
  Moments m{Eigen::MatrixXd::Zero(size, size), {}, {}};
  Eigen::MatrixXd past(size, kBatch);
  Index filled = 0, total = 0;
  const auto flush = [&] {
    const auto part = past.leftCols(filled);
    m.blocks.noalias() += part * part.transpose();
    total += filled;
    filled = 0;
  };
  for (Index row = stride - 1; row < blocks.rows(); row += stride) {
    write_group(blocks, channels, row, past.col(filled++).data());
    if (filled == kBatch) flush();
  }
  flush();
  if (total > 0) m.blocks /= static_cast<double>(total);
  m.newest.resize(size, size / kBlocks);
  m.power.resize(size / kBlocks);
  for (Index c = 0; c < size / kBlocks; ++c) {
    m.newest.col(c) = m.blocks.col(c * kBlocks);  // block 0 is the newest sample itself
    m.power[c] = m.blocks(c * kBlocks, c * kBlocks);
  }
  return m;
}

Eigen::MatrixXd white_noise_moments(const Eigen::VectorXd& variances) {
  Eigen::VectorXd diagonal(variances.size() * kBlocks);
  for (Index i = 0; i < diagonal.size(); ++i) {
    diagonal[i] = variances[i / kBlocks] / static_cast<double>(block_size(i % kBlocks));
  }
  return diagonal.asDiagonal();
}

Eigen::MatrixXd wiener(const Moments& signal, const Eigen::MatrixXd& noise) {
  constexpr double kRidge = 1e-7;
  Eigen::MatrixXd normal = signal.blocks + noise;
  normal.diagonal().array() += kRidge;
  return normal.llt().solve(signal.newest).transpose();
}

Eigen::VectorXd expected_error(const Moments& signal, const Eigen::MatrixXd& noise,
                               const Eigen::MatrixXd& weights) {
  const Eigen::MatrixXd normal = signal.blocks + noise;
  Eigen::VectorXd error(weights.rows());
  for (Index c = 0; c < weights.rows(); ++c) {
    const Eigen::VectorXd w = weights.row(c).transpose();
    error[c] = signal.power[c] - 2.0 * w.dot(signal.newest.col(c)) + w.dot(normal * w);
  }
  return error;
}

Eigen::MatrixXd line_fit(Index channels) {
  // Over n samples the newest point's weight of lag l is (4n - 2 - 6l)/(n(n+1)); a block has the
  // sum.
  constexpr double kSamples = 64.0;
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(channels, channels * kBlocks);
  Index lag = 0;
  for (Index k = 0; k < kBlocks; ++k) {
    double sum = 0.0;
    for (Index i = 0; i < block_size(k); ++i, ++lag) {
      const auto l = static_cast<double>(lag);
      if (l < kSamples) {
        sum += (4.0 * kSamples - 2.0 - 6.0 * l) / (kSamples * (kSamples + 1.0));
      }
    }
    for (Index c = 0; c < channels; ++c) weights(c, c * kBlocks + k) = sum;
  }
  return weights;
}

}  // namespace dcnn::frame_tcn
