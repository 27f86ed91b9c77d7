// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "models/frame_tcn/recipe.h"

namespace dcnn::frame_tcn {
namespace {

constexpr double kHeldShare = 0.15;           // of the training, where there is no validation
constexpr double kWidth = 10.0, kHalf = 5.0;  // dB, of a cloud
constexpr double kAbove = 20.0;               // dB, between the least noise and none
constexpr Index kStride = 4;                  // neighbours are nearly equal
constexpr double kPaceWidth = 5.0;            // dB, between two levels

Eigen::MatrixXd joined(const std::vector<Eigen::MatrixXd>& parts) {
  Index columns = 0, filled = 0;
  for (const auto& part : parts) columns += part.cols();
  Eigen::MatrixXd all(parts.front().rows(), columns);
  for (const auto& part : parts) {
    all.middleCols(filled, part.cols()) = part;
    filled += part.cols();
  }
  return all;
}

}  // namespace

/// Of `x`, whose noise is that of training rows from `first` on, at one level; every fourth row.
Eigen::MatrixXd Recipe::signs_at(const Eigen::MatrixXd& x, const std::vector<Segment>& segments,
                                 Index first, const UnitNoise* noise, double snr) const {
  Eigen::MatrixXd noisy = x;
  const double factor = std::pow(10.0, -snr / 20.0);
  for (Index i = 0; noise != nullptr && i < x.rows(); ++i) {
    noisy.row(i) += factor * noise->x.row((first + i) % noise->x.rows());
  }
  const Eigen::MatrixXd signs = motion_signs(noisy, segments);
  return signs(Eigen::all, Eigen::seq(kStride - 1, signs.cols() - 1, kStride));
}

/// The recording as it is, then every so many dB of each kind of noise.
std::vector<Recipe::Draw> Recipe::noise_cases(double width) const {
  std::vector<Draw> cases{Draw{}};
  for (std::size_t k = 0; k < noise_.size(); ++k) {
    if (k > 0 && noise_[k].on_pose == noise_[k - 1].on_pose) {
      continue;  // one draw of a kind will do
    }
    const double low = noise_[k].on_pose ? pose_low_ : x_low_;
    const double high = noise_[k].on_pose ? pose_high_ : x_high_;
    for (double snr = low; snr < high + kAbove; snr += width) {
      cases.push_back({0, 0, static_cast<int>(k), snr, std::pow(10.0, -snr / 20.0)});
    }
  }
  return cases;
}

/// A cloud for each of the cases.
void Recipe::calibrate_novelty() {
  const bool validated = validation_.rows() >= kLevelSpan;
  const auto kept = validated
                        ? x_.rows()
                        : static_cast<Index>((1.0 - kHeldShare) * static_cast<double>(x_.rows()));
  std::vector<Segment> before, after;
  for (const Segment& s : stretches(x_.rows(), training_.segments)) {
    if (s.begin < kept) before.push_back({s.begin, std::min(s.end, kept)});
    if (s.end > kept) after.push_back({std::max(s.begin, kept) - kept, s.end - kept});
  }
  const Eigen::MatrixXd seen = x_.topRows(kept);
  const Eigen::MatrixXd held = validated
                                   ? normalised(validation_.x, model_.net_.mean, model_.net_.scale)
                                   : Eigen::MatrixXd(x_.bottomRows(x_.rows() - kept));
  if (validated) after = stretches(held.rows(), validation_.segments);
  const std::vector<Draw> clouds = noise_cases(kWidth);
  model_.novelty_ = Novelty(static_cast<Index>(clouds.size()));
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    const double snr = clouds[k].snr;
    const UnitNoise* noise =
        clouds[k].noise < 0 ? nullptr : &noise_[static_cast<std::size_t>(clouds[k].noise)];
    std::vector<Eigen::MatrixXd> own, other;
    for (const double off : {-kHalf, 0.0, kHalf}) {
      if (noise == nullptr && off != 0.0) continue;
      own.push_back(signs_at(seen, before, 0, noise, snr + off));
      other.push_back(signs_at(held, after, validated ? 0 : kept, noise, snr + off));
    }
    model_.novelty_.learn(static_cast<Index>(k), joined(own), joined(other));
  }
}

/// Every kStride-th row of one material, in order of time.
Recipe::Batch Recipe::in_order(std::size_t source, Draw draw) const {
  draw.source = source;
  const Index step = source == 0 ? Pace::kStride : Pace::kStride / kCopyStride;
  Batch batch;
  for (draw.row = step - 1; draw.row < material_[source].rows(); draw.row += step) {
    batch.draws.push_back(draw);
  }
  fill(batch);
  return batch;
}

/// At every pace that the filters were made for: beyond them the gates know no filter.
void Recipe::calibrate_pace() {
  const std::vector<Draw> cases = noise_cases(kPaceWidth);
  model_.pace_ = Pace(static_cast<Index>(cases.size()));
  for (std::size_t k = 0; k < cases.size(); ++k) {
    std::vector<Eigen::MatrixXd> signs, levels;
    for (std::size_t source = 0; source < material_.size(); ++source) {
      Batch batch = in_order(source, cases[k]);
      if (batch.draws.empty()) continue;
      model_.net_.denoise(batch.pass);
      signs.push_back(Pace::signs(batch.pass.clean));
      levels.push_back(Pace::mean_levels(batch.pass.levels));
    }
    model_.pace_.learn(static_cast<Index>(k), joined(signs), joined(levels));
  }
}

}  // namespace dcnn::frame_tcn
