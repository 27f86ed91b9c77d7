// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/front.h"

#include <algorithm>

#include "core/linear_algebra.h"

namespace dcnn::frame_tcn {
namespace {

/// The newest block means of the channels of a group under one another, (known·channels).
void write_group(const BlockMeans& blocks, const std::vector<Index>& channels, Index row,
                 Index known, double* out) {
  for (const Index channel : channels) {
    blocks.write(row, channel, known, out);
    out += known;
  }
}

/// Rows of the newest `known` blocks of each channel among those of all 48.
std::vector<Index> newest_blocks(Index channels, Index known) {
  std::vector<Index> rows;
  for (Index c = 0; c < channels; ++c) {
    for (Index k = 0; k < known; ++k) rows.push_back(c * kBlocks + k);
  }
  return rows;
}

}  // namespace

std::vector<Index> group_channels(Index group) {
  std::vector<Index> channels;
  for (Index k = 0; k < channel_count(group); ++k) channels.push_back(group_channel(group, k));
  return channels;
}

std::size_t history_of(Index known) {
  if (known == kBlocks) return 0;
  std::size_t h = 1;
  while (h + 1 < kHistories.size() && kHistories[h + 1] <= known) ++h;
  return h;
}

Front::Front(Index count) : experts(count) {
  for (Index g = 0; g < kGroups; ++g) {
    const auto c = static_cast<Index>(group_channels(g).size());
    for (std::size_t h = 0; h < kHistories.size(); ++h) {
      weights[static_cast<std::size_t>(g)][h] =
          Eigen::MatrixXd::Zero(c * experts, c * kHistories[h]);
    }
  }
}

void Front::hand_on_blocks() {
  for (Index g = 0; g < kGroups; ++g) {
    for (std::size_t h = 0; h < kHistories.size(); ++h) {
      const Index known = kHistories[h];
      Eigen::MatrixXd& w = weights[static_cast<std::size_t>(g)][h];
      w.setZero();
      for (Index c = 0; c < channel_count(g); ++c) {
        for (Index k = 0; k < experts; ++k) {
          w(c * experts + k, c * known + std::min(k, known - 1)) = 1.0;
        }
      }
    }
  }
}

Eigen::MatrixXd Front::apply(const BlockMeans& blocks, Index first, Index count) const {
  Eigen::MatrixXd result(kChannels * experts, count);
  for (Index begin = 0, end = 0; begin < count; begin = end) {
    const std::size_t history = history_of(blocks.known(first + begin));
    while (end < count && history_of(blocks.known(first + end)) == history) ++end;
    apply(blocks, first + begin, history, result.middleCols(begin, end - begin));
  }
  return result;
}

void Front::apply(const BlockMeans& blocks, Index first, std::size_t history,
                  Eigen::Ref<Eigen::MatrixXd> result) const {
  const Index known = kHistories[history];
  Eigen::MatrixXd past;
  for (Index g = 0; g < kGroups; ++g) {
    const auto channels = group_channels(g);
    past.resize(known * static_cast<Index>(channels.size()), result.cols());
    for (Index i = 0; i < result.cols(); ++i) {
      write_group(blocks, channels, first + i, known, past.col(i).data());
    }
    const Eigen::MatrixXd estimates = weights[static_cast<std::size_t>(g)][history] * past;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      result.middleRows(channels[c] * experts, experts) =
          estimates.middleRows(static_cast<Index>(c) * experts, experts);
    }
  }
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
  for (const Index least : {kBlocks, Index{0}}) {
    if (total > 0) break;
    for (Index row = stride - 1; row < blocks.rows(); row += stride) {
      if (blocks.known(row) < least) continue;
      write_group(blocks, channels, row, kBlocks, past.col(filled++).data());
      if (filled == kBatch) flush();
    }
    flush();
  }
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

Eigen::MatrixXd wiener(const Moments& signal, const Eigen::MatrixXd& noise, Index known) {
  constexpr double kRidge = 1e-7;
  const auto rows = newest_blocks(signal.newest.cols(), known);
  Eigen::MatrixXd normal = signal.blocks(rows, rows) + noise(rows, rows);
  normal.diagonal().array() += kRidge;
  return solve_definite(normal, signal.newest(rows, Eigen::all)).value().transpose();
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

Eigen::MatrixXd line_fit(Index channels, Index known) {
  // Over n samples the newest point's weight of lag l is (4n - 2 - 6l)/(n(n+1)), 1 where n is 1; a
  // block has the sum.
  Index span = 0;
  for (Index k = 0; k < known; ++k) span += block_size(k);
  const auto n = static_cast<double>(std::min<Index>(span, 64));
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(channels, channels * known);
  Index lag = 0;
  for (Index k = 0; k < known; ++k) {
    double sum = 0.0;
    for (Index i = 0; i < block_size(k); ++i, ++lag) {
      const auto l = static_cast<double>(lag);
      if (l < n) sum += (4.0 * n - 2.0 - 6.0 * l) / (n * (n + 1.0));
    }
    for (Index c = 0; c < channels; ++c) weights(c, c * known + k) = sum;
  }
  return weights;
}

}  // namespace dcnn::frame_tcn
