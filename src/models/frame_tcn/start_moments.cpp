// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/start_moments.h"

#include <algorithm>

#include "models/frame_tcn/material.h"
#include "models/frame_tcn/pose_noise_moments.h"

namespace dcnn::frame_tcn {
namespace {

constexpr Index kStarts = 1000, kMostCuts = 16;  // of one motion
constexpr Index kLaterStride = 3;  // of rows whose own window is full: neighbours are nearly equal

/// Angles, then x, y, z but for a constant that no derivative sees: one column a group.
Eigen::MatrixXd pose_of(const Stream& motion, double dt) {
  Eigen::MatrixXd pose = Eigen::MatrixXd::Zero(motion.rows(), kGroups);
  pose.leftCols<3>() = motion.x.leftCols<3>();
  for (const Segment& s : stretches(motion.rows(), motion.segments)) {
    for (Index i = s.begin + 1; i < s.end; ++i) {
      pose.row(i).tail<3>() =
          pose.row(i - 1).tail<3>() +
          0.5 * dt * (motion.x.row(i - 1).segment<3>(3) + motion.x.row(i).segment<3>(3));
    }
  }
  return pose;
}

/// Which channels the estimator made: it says rest on a segment's first row. Others are logged.
std::vector<bool> made_by_estimator(const Stream& motion, const Eigen::VectorXd& scale) {
  std::vector<bool> made(kChannels, true);
  for (const Segment& s : stretches(motion.rows(), motion.segments)) {
    for (Index c = 0; c < kChannels; ++c) {
      const bool at_rest = std::abs(motion.x(s.begin, c)) <= 1e-6 * scale[c];
      made[static_cast<std::size_t>(c)] = made[static_cast<std::size_t>(c)] && c >= 3 && at_rest;
    }
  }
  return made;
}

/// Rows of a segment whose history reaches into its first window with most of its blocks; later a
/// few of the oldest, longest blocks do, and what they say matters little.
Index young_rows(Index edge) {
  const auto last = history_of(known_blocks(2 * edge));
  Index rows = std::min(2 * edge, kSpan - 1);
  while (rows < kSpan - 1 && history_of(known_blocks(rows + 1)) == last) ++rows;
  return rows;
}

/// Young segments from `offset` rows after the motion's own start on.
std::vector<Segment> cut(const Stream& motion, Index offset, Index length) {
  std::vector<Segment> cuts;
  for (const Segment& s : stretches(motion.rows(), motion.segments)) {
    for (Index begin = s.begin + offset; begin < s.end; begin += length) {
      cuts.push_back({begin, std::min(begin + length, s.end)});
    }
  }
  return cuts;
}

}  // namespace

/// Normalised, as young segments and as old ones have them, and which row each history serves.
struct StartMoments::Rows {
  const BlockMeans& young;
  const Eigen::MatrixXd& old;
  std::array<std::vector<Index>, kHistories.size()> of;
};

StartMoments::StartMoments(FeatureLayout layout, Eigen::VectorXd mean, Eigen::VectorXd scale)
    : layout_(std::move(layout)), mean_(std::move(mean)), scale_(std::move(scale)) {}

Eigen::MatrixXd StartMoments::features(const Eigen::MatrixXd& pose, const Stream& motion,
                                       const std::vector<Segment>& segments) const {
  Recording recording;
  recording.name = "starts";
  recording.dt = layout_.dt;
  recording.segments = segments;
  const Derivatives rates = differentiate(pose, recording, layout_.spec.derivative);
  const auto made = made_by_estimator(motion, scale_);
  Eigen::MatrixXd x = motion.x;
  for (Index g = 0; g < kGroups; ++g) {
    const Index count = channel_count(g);
    for (Index k = 0; k < count; ++k) {
      const Index channel = group_channel(g, k);
      if (!made[static_cast<std::size_t>(channel)]) continue;
      const Eigen::MatrixXd& rate = count - k == 2 ? rates.first : rates.second;
      for (const Segment& s : segments) {  // what lies outside has no rates
        x.col(channel).segment(s.begin, s.size()) = rate.col(g).segment(s.begin, s.size());
      }
    }
  }
  return normalised(x, mean_, scale_);
}

void StartMoments::add(const Stream& motion, double share) {
  const Index edge = edge_rows(layout_);
  const Eigen::MatrixXd pose = pose_of(motion, layout_.dt);
  const Eigen::MatrixXd old = features(pose, motion, stretches(motion.rows(), motion.segments));
  const Index length = young_rows(edge);
  const Index cuts = std::clamp<Index>(kStarts * length / motion.rows(), 1, kMostCuts);
  for (Index k = 0; k < cuts; ++k) {
    // The motion itself begins as young segments do: no truth there, nor where it is integrated.
    const auto segments = cut(motion, 2 * edge + k * length / cuts, length);
    const Eigen::MatrixXd x = features(pose, motion, segments);
    const BlockMeans young(x, segments);
    Rows rows{young, old, {}};
    for (const Segment& s : segments) {
      for (Index i = 0; i < s.size(); i += i <= edge ? 1 : kLaterStride) {
        rows.of[history_of(known_blocks(i + 1))].push_back(s.begin + i);
      }
    }
    for (std::size_t h = 1; h < kHistories.size(); ++h) {
      if (rows.of[h].empty()) continue;
      const double part = share / static_cast<double>(cuts);
      shares_[h] += part;
      for (Index g = 0; g < kGroups; ++g) add(rows, g, h, part);
    }
  }
}

void StartMoments::add(const Rows& rows, Index group, std::size_t history, double share) {
  const auto& list = rows.of[history];
  const Index channels = channel_count(group), count = static_cast<Index>(list.size());
  const Index known = kHistories[history];
  Moments& sum = sums_[static_cast<std::size_t>(group)][history];
  if (sum.blocks.size() == 0) {
    sum = {Eigen::MatrixXd::Zero(channels * kBlocks, channels * kBlocks),
           Eigen::MatrixXd::Zero(channels * kBlocks, channels), Eigen::VectorXd::Zero(channels)};
  }
  Eigen::MatrixXd past(channels * known, count), newest(channels, count);
  for (Index i = 0; i < count; ++i) {
    const Index row = list[static_cast<std::size_t>(i)];
    for (Index c = 0; c < channels; ++c) {
      rows.young.write(row, group_channel(group, c), known, past.col(i).data() + c * known);
      newest(c, i) = rows.old(row, group_channel(group, c));
    }
  }
  const double weight = share / static_cast<double>(count);
  const Eigen::MatrixXd blocks = weight * past * past.transpose();
  const Eigen::MatrixXd with_newest = weight * past * newest.transpose();
  for (Index c = 0; c < channels; ++c) {
    for (Index d = 0; d < channels; ++d) {
      sum.blocks.block(c * kBlocks, d * kBlocks, known, known) +=
          blocks.block(c * known, d * known, known, known);
    }
    sum.newest.middleRows(c * kBlocks, known) += with_newest.middleRows(c * known, known);
  }
  sum.power += weight * newest.rowwise().squaredNorm();
}

Moments StartMoments::of(Index group, std::size_t history) const {
  Moments mean = sums_[static_cast<std::size_t>(group)][history];
  const double share = shares_[history];
  if (share == 0.0) return mean;
  mean.blocks /= share;
  mean.newest /= share;
  mean.power /= share;
  return mean;
}

}  // namespace dcnn::frame_tcn
