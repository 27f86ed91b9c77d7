// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/pose_noise_moments.h"

#include <algorithm>

namespace dcnn::frame_tcn {
namespace {

constexpr Index kRowsTried = 4;  // of one history
// Where the estimator repeats the first sample, its noise is in every row of the first window by
// another weight, and in none from then on: filters for some rows are blind to that of the others.
constexpr Index kRowsTriedCausal = 32;

Index span_of(Index known) {
  Index span = 0;
  for (Index k = 0; k < known; ++k) span += block_size(k);
  return span;
}

/// Rows (counted from a segment's start) that a history serves: from its span on, up to the next.
std::vector<Index> rows_of(std::size_t history, Index edge, Index most) {
  const Index first = span_of(kHistories[history]) - 1;
  if (history == 0) return {first + edge};
  const std::size_t next = history + 1 < kHistories.size() ? history + 1 : 0;
  const Index end = span_of(kHistories[next]) - 1;
  const Index count = std::min(most, end - first);
  std::vector<Index> rows;
  for (Index i = 0; i < count; ++i) rows.push_back(first + i * (end - first) / count);
  return rows;
}

}  // namespace

Index edge_rows(const FeatureLayout& layout) {
  const DerivativeSpec& spec = layout.spec.derivative;
  if (layout.dt <= 0.0) return 0;
  if (spec.kind == DerivativeSpec::Kind::kSavitzkyGolay) return spec.window(layout.dt) / 2;
  if (spec.kind == DerivativeSpec::Kind::kCausalSavitzkyGolay) return spec.window(layout.dt) - 1;
  return 2;
}

bool repeats_first_sample(const FeatureLayout& layout) {
  return layout.dt > 0.0 &&
         layout.spec.derivative.kind == DerivativeSpec::Kind::kCausalSavitzkyGolay;
}

PoseNoiseMoments::PoseNoiseMoments(const FeatureLayout& layout)
    : edge_(edge_rows(layout)),
      rows_tried_(repeats_first_sample(layout) ? kRowsTriedCausal : kRowsTried),
      deviation_(layout.pose_deviation) {
  const Index samples = kSpan + 2 * edge_ + 1;
  Recording impulses;
  impulses.name = "impulses";
  impulses.dt = layout.dt;
  impulses.set(
      "t", Eigen::VectorXd::LinSpaced(samples, 0.0, layout.dt * static_cast<double>(samples - 1)));
  impulses.segments = {{0, samples}};
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(samples, samples);
  Derivatives rates = differentiate(unit, impulses, layout.spec.derivative);
  operators_ = {unit, std::move(rates.first), std::move(rates.second)};
}

Eigen::MatrixXd PoseNoiseMoments::response(Index group, Index row, Index known) const {
  const bool rotation = group < 3;
  const auto channels = static_cast<Index>(group_channels(group).size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(channels * kBlocks, operators_[0].cols());
  for (Index c = 0; c < channels; ++c) {
    const auto& rates = operators_[static_cast<std::size_t>(rotation ? c : c + 1)];
    Index high = row;
    for (Index k = 0; k < known; ++k) {
      const Index size = block_size(k);
      result.row(c * kBlocks + k) = rates.middleRows(high - size + 1, size).colwise().mean();
      high -= size;
    }
  }
  return result;
}

Eigen::MatrixXd PoseNoiseMoments::of(Index group, std::size_t history, const Eigen::VectorXd& scale,
                                     const Eigen::VectorXd& noisy) const {
  const auto channels = group_channels(group);
  // The pose is x, y, z and the angles, the groups are the angles and x, y, z.
  const double power = deviation_[(group + 3) % 6];
  Eigen::VectorXd factor(static_cast<Index>(channels.size()) * kBlocks);
  for (Index i = 0; i < factor.size(); ++i) {
    const Index channel = channels[static_cast<std::size_t>(i / kBlocks)];
    factor[i] = noisy[channel] * power / scale[channel];
  }
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(factor.size(), factor.size());
  const auto rows = rows_of(history, edge_, rows_tried_);
  for (const Index row : rows) {
    const Eigen::MatrixXd r = response(group, row, kHistories[history]);
    sum.noalias() += r * r.transpose() / static_cast<double>(rows.size());
  }
  return factor.asDiagonal() * sum * factor.asDiagonal();
}

}  // namespace dcnn::frame_tcn
