// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/novelty.h"

#include <algorithm>
#include <cmath>

#include "core/linear_algebra.h"

namespace dcnn::frame_tcn {
namespace {

constexpr Index kFirstLong = 24;    // blocks of 8 samples and more
constexpr Index kFirstCoarse = 40;  // the 8 blocks of 32 samples
constexpr double kShrink = 0.1, kLeastVariance = 1e-3;
constexpr double kRareRadiusShare = 1e-4, kRadiusMargin = 1.25;

/// Mean square over the last second, the newest 56 samples aside.
double strength(const double* means) {
  double sum = 0.0, samples = 0.0;
  for (Index k = kFirstLong; k < kBlocks; ++k) {
    sum += static_cast<double>(block_size(k)) * means[k] * means[k];
    samples += static_cast<double>(block_size(k));
  }
  return sum / samples;
}

/// Mean square of the second differences of the coarse means.
double bend(const double* means) {
  double sum = 0.0;
  for (Index k = kFirstCoarse + 1; k + 1 < kBlocks; ++k) {
    const double second = means[k - 1] - 2.0 * means[k] + means[k + 1];
    sum += second * second;
  }
  return sum / static_cast<double>(kBlocks - kFirstCoarse - 2);
}

}  // namespace

Eigen::MatrixXd motion_signs(const Eigen::MatrixXd& x, const std::vector<Segment>& segments) {
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(3 * kChannelKinds, x.rows());
  const Eigen::MatrixXd rough = roughness(x, x, segments, 0, 1);
  const BlockMeans blocks(x, segments);
  double means[kBlocks];
  for (Index i = 0; i < x.rows(); ++i) {
    for (Index c = 0; c < kChannels; ++c) {
      blocks.write(i, c, kBlocks, means);
      square(c / 3, i) += strength(means) / 3.0;
      square(kChannelKinds + c / 3, i) += bend(means) / 3.0;
      square(2 * kChannelKinds + c / 3, i) += std::max(rough(c, i), 0.0) / 3.0;
    }
  }
  // At rest the logarithms would fall without end.
  square.topRows(kChannelKinds).array() += 1e-2;
  square.middleRows(kChannelKinds, kChannelKinds).array() += 1e-6;
  square.bottomRows(kChannelKinds).array() += 1e-12;
  return 0.5 * square.array().log10();
}

Novelty::Novelty(Index clouds)
    : mean(Eigen::MatrixXd::Zero(kSigns, clouds)),
      whiten(Eigen::MatrixXd::Zero(kSigns, kSigns * clouds)),
      limit(Eigen::VectorXd::Ones(clouds)) {}

void Novelty::learn(Index cloud, const Eigen::MatrixXd& seen, const Eigen::MatrixXd& held_out) {
  mean.col(cloud) = seen.rowwise().mean();
  const Eigen::MatrixXd centred = seen.colwise() - mean.col(cloud);
  Eigen::MatrixXd covariance = centred * centred.transpose() / static_cast<double>(seen.cols());
  const Eigen::VectorXd variance = covariance.diagonal();
  covariance *= 1.0 - kShrink;
  covariance.diagonal() = variance.array() + kLeastVariance;
  whiten.middleCols(cloud * kSigns, kSigns) = inverse_cholesky(covariance);
  Eigen::VectorXd far = distance(cloud, held_out);
  const auto rare = static_cast<Index>(kRareRadiusShare * static_cast<double>(far.size()));
  std::nth_element(far.begin(), far.end() - 1 - rare, far.end());
  limit[cloud] = kRadiusMargin * std::max(far[far.size() - 1 - rare], 1.0);
}

Eigen::VectorXd Novelty::distance(Index cloud, const Eigen::MatrixXd& signs) const {
  return (whiten.middleCols(cloud * kSigns, kSigns) * (signs.colwise() - mean.col(cloud)))
      .colwise()
      .norm();
}

Eigen::VectorXd Novelty::score(const Eigen::MatrixXd& signs) const {
  Eigen::VectorXd least = distance(0, signs) / limit[0];
  for (Index k = 1; k < clouds(); ++k) least = least.cwiseMin(distance(k, signs) / limit[k]);
  return least;
}

}  // namespace dcnn::frame_tcn
