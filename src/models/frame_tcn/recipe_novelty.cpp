#include <algorithm>
#include <cmath>

#include "models/frame_tcn/recipe.h"

namespace dcnn::frame_tcn {
namespace {

constexpr double kHeldShare = 0.15;           // of the training, where there is no validation
constexpr double kWidth = 10.0, kHalf = 5.0;  // dB, of a cloud
constexpr double kAbove = 20.0;               // dB, between the least noise and none
constexpr Index kStride = 4;                  // neighbours are nearly equal

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

/// One cloud of the recording as it is, and one for every 10 dB of each kind of noise.
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
  std::vector<std::pair<const UnitNoise*, double>> clouds{{nullptr, 0.0}};
  for (std::size_t k = 0; k < noise_.size(); ++k) {
    if (k > 0 && noise_[k].on_pose == noise_[k - 1].on_pose)
      continue;  // one draw of a kind will do
    const double low = noise_[k].on_pose ? pose_low_ : x_low_;
    const double high = noise_[k].on_pose ? pose_high_ : x_high_;
    for (double snr = low; snr < high + kAbove; snr += kWidth) clouds.push_back({&noise_[k], snr});
  }
  model_.novelty_ = Novelty(static_cast<Index>(clouds.size()));
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    const auto& [noise, snr] = clouds[k];
    std::vector<Eigen::MatrixXd> own, other;
    for (const double off : {-kHalf, 0.0, kHalf}) {
      if (noise == nullptr && off != 0.0) continue;
      own.push_back(signs_at(seen, before, 0, noise, snr + off));
      other.push_back(signs_at(held, after, validated ? 0 : kept, noise, snr + off));
    }
    model_.novelty_.learn(static_cast<Index>(k), joined(own), joined(other));
  }
}

}  // namespace dcnn::frame_tcn
