// SPDX-License-Identifier: Apache-2.0
// The filters: moments of the motion and of the noise, then Wiener.
#include <algorithm>
#include <cmath>

#include "models/frame_tcn/pose_noise_moments.h"
#include "models/frame_tcn/recipe.h"
#include "models/frame_tcn/start_moments.h"

namespace dcnn::frame_tcn {
namespace {

constexpr Index kMomentStride = 6;  // neighbours are nearly equal
constexpr Index kMiddleExpert = 2;  // 20 dB on the features, 24 dB on the pose
// dB on the features. From rates that only begin to rise an expert for less noise reads what they
// will be, so strongly that the little share which the gates leave it at 10 dB is newtons.
constexpr double kCleanestStart = 41.0;

}  // namespace

/// Means over the speeds of each axis' own moments, (3).
std::array<Moments, 3> Recipe::axis_moments(Index first_group) const {
  std::array<Moments, 3> sum;
  const double share = 1.0 / static_cast<double>(spec_.speeds.size());
  for (const double speed : spec_.speeds) {
    const Stream copy = at_speed(training_, speed);
    const Eigen::MatrixXd x = normalised(copy.x, model_.net_.mean, model_.net_.scale);
    const BlockMeans blocks(x, copy.segments);
    for (Index axis = 0; axis < 3; ++axis) {
      const Moments part = moments(blocks, first_group + axis, kMomentStride);
      Moments& all = sum[static_cast<std::size_t>(axis)];
      if (all.blocks.size() == 0) {
        all = {share * part.blocks, share * part.newest, share * part.power};
        continue;
      }
      all.blocks += share * part.blocks;
      all.newest += share * part.newest;
      all.power += share * part.power;
    }
  }
  return sum;
}

/// What the group's moments would be if its axis moved as each of the three did: one trajectory
/// shows too few tones of one axis. Amplitudes are brought to those of the axis by one factor for
/// all channels of a group, or the channels would no longer be each other's derivatives.
Moments Recipe::pooled_moments(const std::array<Moments, 3>& axes, Index group) const {
  const Eigen::VectorXd& scale = model_.net_.scale;
  const auto own = group_channels(group);
  Moments sum;
  for (Index axis = 0; axis < 3; ++axis) {
    const auto others = group_channels(group - group % 3 + axis);
    Eigen::VectorXd factor(static_cast<Index>(own.size())), rows(factor.size() * kBlocks);
    for (std::size_t c = 0; c < own.size(); ++c) {
      factor[static_cast<Index>(c)] =
          (scale[others[c]] / scale[own[c]]) / (scale[others[0]] / scale[own[0]]);
    }
    for (Index i = 0; i < rows.size(); ++i) rows[i] = factor[i / kBlocks];
    const Moments& part = axes[static_cast<std::size_t>(axis)];
    const Eigen::MatrixXd blocks = rows.asDiagonal() * part.blocks * rows.asDiagonal();
    const Eigen::MatrixXd newest = rows.asDiagonal() * part.newest * factor.asDiagonal();
    const Eigen::VectorXd power = part.power.cwiseProduct(factor.cwiseAbs2());
    if (axis == 0) {
      sum = {blocks / 3.0, newest / 3.0, power / 3.0};
      continue;
    }
    sum.blocks += blocks / 3.0;
    sum.newest += newest / 3.0;
    sum.power += power / 3.0;
  }
  return sum;
}

/// Moments of segments that begin all over the training and its copies at other speeds.
StartMoments Recipe::start_moments() const {
  const Net& net = model_.net_;
  StartMoments starts(spec_.layout, net.mean, net.scale);
  for (const double speed : spec_.speeds) {
    starts.add(at_speed(training_, speed), 1.0 / static_cast<double>(spec_.speeds.size()));
  }
  return starts;
}

/// Pooled as those of old segments are; `old` where no start was long enough.
Moments Recipe::young_moments(const StartMoments& starts, Index group, std::size_t history,
                              const Moments& old) const {
  std::array<Moments, 3> axes;
  for (Index axis = 0; axis < 3; ++axis) {
    axes[static_cast<std::size_t>(axis)] = starts.of(group - group % 3 + axis, history);
  }
  return axes[0].blocks.size() == 0 ? old : pooled_moments(axes, group);
}

/// Variances of the noise on the features at 0 dB, of the group's channels.
Eigen::VectorXd Recipe::feature_noise_power(Index group) const {
  const auto channels = group_channels(group);
  Eigen::VectorXd power = Eigen::VectorXd::Zero(static_cast<Index>(channels.size()));
  double count = 0.0;
  for (const UnitNoise& noise : noise_) {
    if (noise.on_pose) continue;
    for (Index c = 0; c < power.size(); ++c) {
      power[c] += noise.x.col(channels[static_cast<std::size_t>(c)]).squaredNorm();
    }
    count += static_cast<double>(noise.x.rows());
  }
  return power / std::max(count, 1.0);
}

/// Which channels noise on the pose reaches: rates that the log itself holds carry none.
Eigen::VectorXd Recipe::reached_by_pose_noise() const {
  Eigen::VectorXd reached = Eigen::VectorXd::Zero(kChannels);
  for (const UnitNoise& noise : noise_) {
    if (!noise.on_pose) continue;
    for (Index c = 0; c < kChannels; ++c) {
      if (!noise.x.col(c).isZero(0.0)) reached[c] = 1.0;
    }
  }
  return reached;
}

void Recipe::make_filters() {
  Front& front = model_.front_;
  errors_ = Eigen::MatrixXd::Zero(
      static_cast<Index>(std::max<std::size_t>(1, spec_.x_snr.size() + spec_.pose_snr.size())),
      kChannels);
  if (spec_.dense) front.hand_on_blocks();
  if (spec_.line) {
    for (Index g = 0; g < kGroups; ++g) {
      const auto count = static_cast<Index>(group_channels(g).size());
      Bank& bank = front.weights[static_cast<std::size_t>(g)];
      for (std::size_t h = 0; h < bank.size(); ++h) bank[h] = line_fit(count, kHistories[h]);
    }
    return;
  }
  const auto features = static_cast<Index>(spec_.x_snr.size());
  std::optional<PoseNoiseMoments> pose;
  if (!spec_.pose_snr.empty()) pose.emplace(spec_.layout);
  const Eigen::VectorXd reached = reached_by_pose_noise();
  std::optional<StartMoments> starts;
  if (repeats_first_sample(spec_.layout) && !spec_.dense) starts = start_moments();
  std::array<Moments, 3> axes;
  for (Index g = 0; g < kGroups; ++g) {
    if (g % 3 == 0) axes = axis_moments(g);
    const Moments old = pooled_moments(axes, g);
    const Eigen::MatrixXd white = white_noise_moments(feature_noise_power(g));
    for (std::size_t h = 0; h < (spec_.dense ? 1 : kHistories.size()); ++h) {
      const Moments signal = starts && h > 0 ? young_moments(*starts, g, h, old) : old;
      const bool rising = starts && h > 0 && kHistories[h] <= known_blocks(edge_rows(spec_.layout));
      for (Index k = 0; k < features; ++k) {
        const double snr = spec_.x_snr[static_cast<std::size_t>(k)];
        make_expert(g, k, h, signal, white, rising ? std::min(snr, kCleanestStart) : snr);
      }
      if (!pose) continue;
      const Eigen::MatrixXd coloured = pose->of(g, h, model_.net_.scale, reached);
      for (std::size_t k = 0; k < spec_.pose_snr.size(); ++k) {
        make_expert(g, features + static_cast<Index>(k), h, signal, coloured, spec_.pose_snr[k]);
      }
    }
  }
}

/// The dense layers begin with the filter for a middle level as their linear part.
void Recipe::start_dense(Index group, const Eigen::MatrixXd& filter) {
  auto linear = Dense::linear(model_.net_.parameters.data());
  const auto channels = group_channels(group);
  for (std::size_t from = 0; from < channels.size(); ++from) {
    for (std::size_t to = 0; to < channels.size(); ++to) {
      linear.row(channels[to]).segment(channels[from] * kBlocks, kBlocks) =
          filter.row(static_cast<Index>(to)).segment(static_cast<Index>(from) * kBlocks, kBlocks);
    }
  }
  adam_ = Adam(model_.net_.parameters);
}

/// The filters of one expert and history; `unit` are moments of the noise at 0 dB.
void Recipe::make_expert(Index group, Index expert, std::size_t history, const Moments& signal,
                         const Eigen::MatrixXd& unit, double snr) {
  Front& front = model_.front_;
  const auto channels = group_channels(group);
  const Eigen::MatrixXd noise = std::pow(10.0, -snr / 10.0) * unit;
  const Eigen::MatrixXd w = wiener(signal, noise, kHistories[history]);
  if (spec_.dense) {
    if (expert == kMiddleExpert) start_dense(group, w);
  } else {
    for (Index c = 0; c < w.rows(); ++c) {
      front.weights[static_cast<std::size_t>(group)][history].row(c * front.experts + expert) =
          w.row(c);
    }
  }
  if (kHistories[history] < kBlocks) return;
  const Eigen::VectorXd error = expected_error(signal, noise, w);
  for (Index c = 0; c < w.rows(); ++c) {
    errors_(expert, channels[static_cast<std::size_t>(c)]) = std::max(error[c], 1e-9);
  }
}

}  // namespace dcnn::frame_tcn
