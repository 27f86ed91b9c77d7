#include "models/frame_tcn/novelty.h"

#include <algorithm>
#include <cmath>

namespace dcnn::frame_tcn {
namespace {

constexpr Index kCoarse = 8;  // blocks of 32 samples, the oldest of the 48

}  // namespace

Signs::Signs(const Eigen::MatrixXd& x, const std::vector<Segment>& segments)
    : bend(kChannels, x.rows()),
      range(kChannels, x.rows()),
      level(levels(roughness(x, x, segments))) {
  const BlockMeans blocks(x, segments);
  double means[kBlocks];
  for (Index i = 0; i < x.rows(); ++i) {
    for (Index c = 0; c < kChannels; ++c) {
      blocks.write(i, c, means);
      const double* m = means + kBlocks - kCoarse;
      double sum = 0.0;
      for (Index k = 1; k + 1 < kCoarse; ++k) {
        const double second = m[k - 1] - 2.0 * m[k] + m[k + 1];
        sum += second * second;
      }
      bend(c, i) = std::sqrt(sum / (kCoarse - 2));
      range(c, i) = std::abs(m[0]);
    }
  }
}

Novelty::Novelty()
    : limits(Eigen::MatrixXd::Zero(kChannels, kBins)),
      range(Eigen::MatrixXd::Zero(kChannels, kBins)),
      level_span(kChannels, 2) {
  level_span.col(0).setConstant(100.0);
  level_span.col(1).setConstant(-100.0);
}

void Novelty::learn_levels(const Signs& signs) {
  level_span.col(0) = level_span.col(0).cwiseMin(signs.level.rowwise().minCoeff());
  level_span.col(1) = level_span.col(1).cwiseMax(signs.level.rowwise().maxCoeff());
}

Index Novelty::bin(Index channel, double level) const {
  const double low = level_span(channel, 0), high = level_span(channel, 1);
  const double place = (level - low) / std::max(high - low, 1e-6) * static_cast<double>(kBins);
  return std::clamp<Index>(static_cast<Index>(std::floor(place)), 0, kBins - 1);
}

void Novelty::learn(const Signs& signs) {
  for (Index i = 0; i < signs.bend.cols(); ++i) {
    for (Index c = 0; c < kChannels; ++c) {
      const Index b = bin(c, signs.level(c, i));
      limits(c, b) = std::max(limits(c, b), signs.bend(c, i));
      range(c, b) = std::max(range(c, b), signs.range(c, i));
    }
  }
}

void Novelty::finish() {
  for (Eigen::MatrixXd* m : {&limits, &range}) {
    for (Index c = 0; c < kChannels; ++c) {
      // More noise never lowers a limit; what was never seen counts as the least noisy one seen.
      for (Index b = 1; b < kBins; ++b) (*m)(c, b) = std::max((*m)(c, b), (*m)(c, b - 1));
      for (Index b = kBins - 1; b-- > 0;) {
        if ((*m)(c, b) <= 0.0) (*m)(c, b) = (*m)(c, b + 1);
      }
    }
    *m = m->cwiseMax(1e-6);
  }
}

Eigen::VectorXd Novelty::score(const Signs& signs) const {
  Eigen::VectorXd result(signs.bend.cols());
  for (Index i = 0; i < result.size(); ++i) {
    double worst = 0.0;
    for (Index c = 0; c < kChannels; ++c) {
      const Index b = bin(c, signs.level(c, i));
      const double above = std::pow(10.0, signs.level(c, i) - level_span(c, 1));
      worst = std::max({worst, signs.bend(c, i) / limits(c, b), signs.range(c, i) / range(c, b), above});
    }
    result[i] = worst / calibration;
  }
  return result;
}

}  // namespace dcnn::frame_tcn
