// SPDX-License-Identifier: Apache-2.0
#include "identification/whitener.h"

#include <algorithm>
#include <cmath>

namespace dcnn::identification {
namespace {

using Eigen::VectorXd;

constexpr Index kMostOrder = 24;
constexpr Index kRowsPerOrder = 10;  // an order is estimated from at least so many rows
constexpr double kWhite = 1e-12;     // share of the variance below which an error is rounding

Index longest_of(const std::vector<Segment>& segments) {
  Index longest = 1;
  for (const Segment& segment : segments) longest = std::max(longest, segment.size());
  return longest;
}

/// Sums of products at lags 0 … most over all segments, over the number of all rows: positive
/// definite.
VectorXd autocovariance(const VectorXd& x, const std::vector<Segment>& segments, Index most) {
  VectorXd c = VectorXd::Zero(most + 1);
  Index rows = 0;
  for (const Segment& s : segments) {
    rows += s.size();
    for (Index lag = 0; lag <= std::min(most, s.size() - 1); ++lag) {
      c[lag] += x.segment(s.begin, s.size() - lag).dot(x.segment(s.begin + lag, s.size() - lag));
    }
  }
  return c / static_cast<double>(std::max<Index>(rows, 1));
}

}  // namespace

ChannelNoise::ChannelNoise(const VectorXd& residual, const std::vector<Segment>& segments,
                           double parameters) {
  const auto n = static_cast<double>(residual.size());
  const Index most =
      std::min({kMostOrder, residual.size() / kRowsPerOrder, longest_of(segments) - 1});
  const VectorXd c = autocovariance(residual, segments, std::max<Index>(most, 0));
  const double freedom = n / std::max(1.0, n - parameters);
  variance_ = {std::max(c[0], 1e-300)};
  VectorXd a(0);
  double least = n * std::log(variance_[0]);
  std::size_t best = 0;
  for (Index p = 1; p <= most; ++p) {
    double reflection = c[p];
    for (Index i = 0; i < p - 1; ++i) reflection -= a[i] * c[p - 1 - i];
    reflection /= variance_.back();
    VectorXd next(p);
    for (Index i = 0; i < p - 1; ++i) next[i] = a[i] - reflection * a[p - 2 - i];
    next[p - 1] = reflection;
    const double error = variance_.back() * (1.0 - reflection * reflection);
    if (!(error > kWhite * variance_[0])) break;
    a = next;
    weights_.push_back(a);
    variance_.push_back(error);
    const double criterion = n * std::log(error) + 2.0 * static_cast<double>(p);
    if (criterion < least) {
      least = criterion;
      best = static_cast<std::size_t>(p);
    }
  }
  weights_.resize(best);
  variance_.resize(best + 1);
  for (double& v : variance_) v *= freedom;
}

void ChannelNoise::whiten(Eigen::Ref<Eigen::MatrixXd> rows,
                          const std::vector<Segment>& segments) const {
  const auto order = static_cast<Index>(weights_.size());
  for (Index column = 0; column < rows.cols(); ++column) {
    VectorXd x = rows.col(column);
    for (const Segment& s : segments) {
      for (Index k = s.begin; k < s.end; ++k) {
        const Index p = std::min(k - s.begin, order);
        double error = x[k];
        for (Index i = 0; i < p; ++i) {
          error -= weights_[static_cast<std::size_t>(p - 1)][i] * x[k - 1 - i];
        }
        rows(k, column) = error / std::sqrt(variance_[static_cast<std::size_t>(p)]);
      }
    }
  }
}

double ChannelNoise::correlated_rows() const {
  if (weights_.empty()) return 1.0;
  const double gain = 1.0 - weights_.back().sum();
  return std::max(1.0, variance_.back() / (gain * gain) / variance_.front());
}

ChannelNoise ChannelNoise::white(const Eigen::VectorXd& residual) {
  std::vector<Segment> alone;
  for (Index i = 0; i < residual.size(); ++i) alone.push_back({i, i + 1});
  return {residual, alone, 0.0};
}

}  // namespace dcnn::identification
