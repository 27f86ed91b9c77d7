// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/predictor.h"

#include <algorithm>
#include <utility>

#include "models/frame_tcn/model.h"

namespace dcnn::frame_tcn {
namespace {

/// How long ago the last of each level's 8 blocks ended.
std::vector<Index> block_lags() {
  std::vector<Index> lags;
  Index covered = 0;
  for (Index k = 0; k < kBlocks; ++k) {
    if (k % 8 == 7) lags.push_back(covered);
    covered += block_size(k);
  }
  return lags;
}

/// Of kLevelSpan = 2^8 rows the newest sum alone is asked for.
std::vector<Index> level_lags() {
  static_assert(kLevelSpan == 256);
  return std::vector<Index>(9, 0);
}

}  // namespace

FrameTcnPredictor::FrameTcnPredictor(Front front, Net net, const Eigen::VectorXd& spread)
    : front_(std::move(front)),
      net_(std::move(net)),
      spread_(spread),
      rows_(kChannels, block_lags()),
      bends_(kChannels, level_lags()),
      row_(Eigen::VectorXd::Zero(kChannels)),
      before_(row_),
      second_before_(row_),
      bend_(row_),
      roughness_(kChannels, 1),
      y_(3 * spread.size()) {
  for (std::size_t g = 0; g < kGroups; ++g) {
    past_[g] = Eigen::VectorXd::Zero(front_.weights[g][0].cols());
    estimates_[g] = Eigen::VectorXd::Zero(front_.weights[g][0].rows());
  }
  pass_.experts = Eigen::MatrixXd::Zero(kChannels * front_.experts, 1);
  push(net_.mean);  // gives the layers their memory
  reset();
}

void FrameTcnPredictor::reset() noexcept {
  rows_.reset();
  bends_.reset();
  count_ = 0;
}

void FrameTcnPredictor::put_roughness() noexcept {
  for (Index j = 0; j < kChannels; ++j) {
    const Index begin = j < 3 ? 2 : net_.edge + 2;
    const double bend = row_[j] - 2.0 * before_[j] + second_before_[j];
    bend_[j] = count_ <= begin ? 0.0 : bend * bend;
  }
  bends_.push(bend_);
  for (Index j = 0; j < kChannels; ++j) {
    const Index seen = std::min(count_ - (j < 3 ? 2 : net_.edge + 2), kLevelSpan);
    roughness_(j, 0) = seen < kFewest ? kUnknown : bends_.at(8, 0)[j] / static_cast<double>(seen);
  }
}

void FrameTcnPredictor::put_experts() noexcept {
  const std::size_t history = history_of(known_blocks(count_));
  const Index known = kHistories[history];
  for (std::size_t g = 0; g < kGroups; ++g) {
    const auto& weights = front_.weights[g][history];
    const auto group = static_cast<Index>(g);
    Index lag = 0;
    for (Index k = 0; k < known; ++k) {
      const auto sums = rows_.at(static_cast<std::size_t>(k / 8), lag);
      const auto size = static_cast<double>(block_size(k));
      for (Index c = 0; c < channel_count(group); ++c) {
        past_[g][c * known + k] = sums[group_channel(group, c)] / size;
      }
      lag += block_size(k);
    }
    estimates_[g].noalias() = weights * past_[g].head(weights.cols());
    for (Index c = 0; c < channel_count(group); ++c) {
      pass_.experts.col(0).segment(group_channel(group, c) * front_.experts, front_.experts) =
          estimates_[g].segment(c * front_.experts, front_.experts);
    }
  }
}

const Eigen::VectorXd& FrameTcnPredictor::push(const Eigen::VectorXd& x) noexcept {
  second_before_.swap(before_);
  before_.swap(row_);
  row_ = (x - net_.mean).cwiseQuotient(net_.scale);
  ++count_;
  rows_.push(row_);
  put_roughness();
  put_experts();
  net_.put_standard_levels(roughness_, pass_.levels);
  net_.denoise(pass_);
  net_.features(pass_);
  net_.product(pass_);
  for (Index i = 0; i < y_.size(); ++i) y_[i] = spread_[i / 3] * pass_.out(i, 0);
  return y_;
}

std::unique_ptr<Predictor> FrameTcn::predictor() const {
  return std::make_unique<FrameTcnPredictor>(front_, net_, spread_);
}

}  // namespace dcnn::frame_tcn
