// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/pace.h"

#include <algorithm>
#include <cmath>

namespace dcnn::frame_tcn {
namespace {

constexpr Index kColumns = Pace::kSpan / Pace::kStride;
constexpr Index kFewestColumns = kColumns / 2;  // a shorter past counts as rest before it
constexpr double kAtRest = 1e-4;                // mean squares, in units of the training's
constexpr double kSlow = 0.09;  // a rate below 0.3 of the training's is no measure of a pace
constexpr double kRarePaceShare = 1e-3;  // of the training
constexpr double kPaceMargin = 0.04;  // log10: another motion of the same band is a tenth stronger

/// Sums of each row over its last kColumns columns, over how many there are.
Eigen::MatrixXd sliding_mean(const Eigen::MatrixXd& rows, Index fewest) {
  Eigen::MatrixXd mean(rows.rows(), rows.cols());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows.rows());
  for (Index i = 0; i < rows.cols(); ++i) {
    sum += rows.col(i);
    if (i >= kColumns) sum -= rows.col(i - kColumns);
    mean.col(i) = sum / static_cast<double>(std::clamp(i + 1, fewest, kColumns));
  }
  return mean;
}

}  // namespace

Pace::Pace(Index levels)
    : level(Eigen::MatrixXd::Zero(kChannels, levels)),
      limit(Eigen::MatrixXd::Zero(kSigns, levels)) {}

Eigen::MatrixXd Pace::signs(const Eigen::MatrixXd& clean) {
  Eigen::MatrixXd square(kChannelKinds, clean.cols());
  for (Index k = 0; k < kChannelKinds; ++k) {
    square.row(k) = clean.middleRows(3 * k, 3).colwise().squaredNorm() / 3.0;
  }
  const Eigen::ArrayXXd mean = sliding_mean(square, kFewestColumns).array().max(0.0);
  const Eigen::ArrayXXd rate = mean.middleRows(1, 2) + kSlow, second = mean.bottomRows(2) + kAtRest;
  Eigen::MatrixXd result(kSigns, clean.cols());
  result << second, second / rate;
  return 0.5 * result.array().log10();
}

Eigen::MatrixXd Pace::mean_levels(const Eigen::MatrixXd& levels) { return sliding_mean(levels, 1); }

void Pace::learn(Index k, const Eigen::MatrixXd& signs, const Eigen::MatrixXd& mean_levels) {
  level.col(k) = mean_levels.rowwise().mean();
  const auto rare = static_cast<Index>(kRarePaceShare * static_cast<double>(signs.cols()));
  for (Index j = 0; j < kSigns; ++j) {
    Eigen::VectorXd sign = signs.row(j).transpose();
    std::nth_element(sign.begin(), sign.end() - 1 - rare, sign.end());
    limit(j, k) = sign[sign.size() - 1 - rare] + kPaceMargin;
  }
}

Eigen::VectorXd Pace::score(const Eigen::MatrixXd& clean, const Eigen::MatrixXd& levels) const {
  const Eigen::MatrixXd own = signs(clean), now = mean_levels(levels);
  Eigen::VectorXd result(clean.cols());
  for (Index i = 0; i < clean.cols(); ++i) {
    Index nearest = 0;
    (level.colwise() - now.col(i)).colwise().squaredNorm().minCoeff(&nearest);
    result[i] = std::pow(10.0, (own.col(i) - limit.col(nearest)).maxCoeff());
  }
  return result;
}

}  // namespace dcnn::frame_tcn
