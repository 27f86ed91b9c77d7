// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "models/frame_tcn/recipe.h"
#include "models/random_streams.h"

namespace dcnn::frame_tcn {
namespace {

constexpr int kDraws = 3;             // of unit noise of each kind
constexpr double kNoisiest = 5.0;     // dB above the least that are called so
constexpr double kLeastShare = 0.01;  // of the largest scale among an axis' sisters
constexpr double kBelow = 2.0, kAboveX = 8.0,
                 kAbovePose = 15.0;  // dB around the levels of the tests

}  // namespace

/// Deviation of each channel; one that hardly moves beside its sisters gets their scale.
void Recipe::scale_channels() {
  Net& net = model_.net_;
  net.mean = model_.map_.mean();
  net.scale = model_.map_.deviation();
  for (Index k = 0; k < kChannels; k += 3) {
    auto sisters = net.scale.segment(k, 3);
    sisters = sisters.cwiseMax(std::max(kLeastShare * sisters.maxCoeff(), 1e-9)).eval();
  }
  x_ = normalised(training_.x, net.mean, net.scale);
}

void Recipe::make_noise() {
  const Eigen::VectorXd& scale = model_.net_.scale;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(kChannels);
  if (!spec_.x_snr.empty()) {
    const Eigen::VectorXd deviation =
        noise_deviation(spec_.noise, model_.map_, training_.x, 0.0).cwiseQuotient(scale);
    for (std::uint64_t k = 0; k < kDraws; ++k) {
      noise_.push_back({with_noise(Eigen::MatrixXd::Zero(x_.rows(), kChannels), deviation,
                                   Rng({spec_.seed, kTcnNoise, k}).bits()),
                        false});
    }
  }
  const bool on_pose = spec_.noise.on != NoiseSpec::Signal::kFeatures;
  require(!on_pose || !training_.pose_noise.empty(), Exit::kUsage,
          "noise.on 'pose' needs features derived from a logged pose");
  if (on_pose) {
    for (const auto& draw : training_.pose_noise) {
      noise_.push_back({normalised(draw, zero, scale), true});
    }
  }
  double low = 1e9, high = -1e9;
  bool clean = false;
  for (const SnrLevel& level : spec_.noise.levels) {
    clean = clean || !level;
    if (!level) continue;
    low = std::min(low, *level);
    high = std::max(high, *level);
  }
  if (!clean) clean_share_ = 0.0;
  if (low > high) clean_share_ = 1.0;
  x_low_ = pose_low_ = low - kBelow;
  x_high_ = high + kAboveX;
  pose_high_ = high + kAbovePose;
}

void Recipe::make_material() {
  const Front& front = model_.front_;
  const Index edge = model_.net_.edge;
  material_.emplace_back(front, x_, training_.segments, 1, edge);
  for (const UnitNoise& noise : noise_) {
    const Material part(front, noise.x, training_.segments, 1, edge);
    noise_experts_.push_back(part.experts);
    noise_roughness_.push_back(part.roughness);
    noise_cross_.push_back(
        roughness(x_, noise.x, training_.segments, model_.net_.edge).cast<float>());
  }
  if (model_.net_.gate_size() == 0) return;
  for (const double speed : spec_.speeds) {
    if (speed == 1.0) continue;
    const Stream copy = at_speed(training_, speed);
    const Eigen::MatrixXd x = normalised(copy.x, model_.net_.mean, model_.net_.scale);
    if (x.rows() >= kCopyStride) material_.emplace_back(front, x, copy.segments, kCopyStride, edge);
  }
}

/// Mean and deviation of the levels over what training will draw.
void Recipe::scale_levels() {
  Rng rng({spec_.seed, 111});
  Net& net = model_.net_;
  net.level_mean.setZero();
  net.level_scale.setOnes();
  const Batch sample = batch(rng, std::min<Index>(4000, 4 * x_.rows()), false);
  const Eigen::MatrixXd& l = sample.pass.levels;
  const Eigen::VectorXd mean = l.rowwise().mean();
  net.level_scale =
      (l.colwise() - mean).array().square().rowwise().mean().sqrt().max(1e-3).matrix();
  net.level_mean = mean;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kChannels);
  double noisy = 0.0;
  for (Index i = 0; i < l.cols(); ++i) {
    const Draw& d = sample.draws[static_cast<std::size_t>(i)];
    if (d.noise < 0 || d.snr > (on_pose(d) ? pose_low_ : x_low_) + kNoisiest) continue;
    sum += (l.col(i) - mean).cwiseQuotient(net.level_scale);
    noisy += 1.0;
  }
  if (noisy > 0.0) net.level_noisy = sum / noisy;
}

bool Recipe::on_pose(const Draw& d) const {
  return d.noise < 0 ? spec_.x_snr.empty() : noise_[static_cast<std::size_t>(d.noise)].on_pose;
}

Recipe::Draw Recipe::draw(Rng& rng, bool copies) const {
  Draw d;
  // Half of the samples are of the motion as it was.
  if (copies && material_.size() > 1 && rng.below(2) == 0) {
    d.source = 1 + rng.below(material_.size() - 1);
  }
  d.row = static_cast<Index>(rng.below(static_cast<std::uint64_t>(material_[d.source].rows())));
  const double chance = rng.uniform(), place = rng.uniform();
  const auto which = rng.bits();
  if (chance < clean_share_ || noise_.empty()) return d;
  std::vector<int> kinds[2];
  for (std::size_t k = 0; k < noise_.size(); ++k) {
    kinds[noise_[k].on_pose ? 1 : 0].push_back(static_cast<int>(k));
  }
  const bool pose = kinds[0].empty() || (!kinds[1].empty() && which % 2 == 1);
  const auto& list = kinds[pose ? 1 : 0];
  d.noise = list[(which >> 1) % list.size()];
  d.snr = pose ? pose_low_ + place * (pose_high_ - pose_low_) : x_low_ + place * (x_high_ - x_low_);
  d.factor = std::pow(10.0, -d.snr / 20.0);
  return d;
}

Recipe::Batch Recipe::batch(Rng& rng, Index size, bool copies) const {
  Batch b;
  b.draws.reserve(static_cast<std::size_t>(size));
  for (Index i = 0; i < size; ++i) b.draws.push_back(draw(rng, copies));
  fill(b);
  return b;
}

void Recipe::fill(Batch& b) const {
  const auto n = static_cast<Index>(b.draws.size());
  b.pass.experts.resize(kChannels * model_.front_.experts, n);
  b.clean.resize(kChannels, n);
  Eigen::MatrixXd rough(kChannels, n);
  for (Index i = 0; i < n; ++i) {
    const Draw& d = b.draws[static_cast<std::size_t>(i)];
    const Material& m = material_[d.source];
    b.clean.col(i) = m.clean.col(d.row).cast<double>();
    b.pass.experts.col(i) = m.experts.col(d.row).cast<double>();
    rough.col(i) = m.roughness.col(d.row).cast<double>();
    if (d.noise < 0) continue;
    const auto k = static_cast<std::size_t>(d.noise);
    const Index row = d.source == 0 ? d.row : d.row * kCopyStride % x_.rows();
    b.pass.experts.col(i) += d.factor * noise_experts_[k].col(row).cast<double>();
    const Eigen::VectorXd clean = rough.col(i), noise = noise_roughness_[k].col(row).cast<double>();
    rough.col(i) += d.factor * d.factor * noise;
    if (d.source == 0) rough.col(i) += 2.0 * d.factor * noise_cross_[k].col(row).cast<double>();
    for (Index c = 0; c < kChannels; ++c) {
      if (clean[c] == kUnknown || noise[c] == kUnknown) rough(c, i) = kUnknown;
    }
  }
  const Net& net = model_.net_;
  b.pass.levels = net.standard_levels(rough);
}

/// Of the expert made for this level, between its neighbours in the list.
double Recipe::wanted_error(const Draw& d, Index channel) const {
  const bool pose =
      d.noise < 0 ? spec_.x_snr.empty() : noise_[static_cast<std::size_t>(d.noise)].on_pose;
  const auto& list = pose ? spec_.pose_snr : spec_.x_snr;
  const Index begin = pose ? static_cast<Index>(spec_.x_snr.size()) : 0;
  const auto last = static_cast<Index>(list.size()) - 1;
  if (d.noise < 0) return errors_(begin + last, channel);
  Index k = 0;
  while (k < last && list[static_cast<std::size_t>(k + 1)] < d.snr) ++k;
  if (k == last) return errors_(begin + last, channel);
  const double low = list[static_cast<std::size_t>(k)],
               high = list[static_cast<std::size_t>(k + 1)];
  const double share = std::clamp((d.snr - low) / (high - low), 0.0, 1.0);
  return std::exp((1.0 - share) * std::log(errors_(begin + k, channel)) +
                  share * std::log(errors_(begin + k + 1, channel)));
}

}  // namespace dcnn::frame_tcn
