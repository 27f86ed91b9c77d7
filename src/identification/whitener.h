// SPDX-License-Identifier: Apache-2.0
// Coloured noise: an autoregression for every channel of a log, by which rows become white.
#pragma once

#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn::identification {

/// AR(p) predictors of orders 0 … p of one channel (Levinson and Durbin), p chosen by Akaike's
/// criterion: row k of a segment is predicted from min(k, p) rows before it, which is the exact
/// Gaussian likelihood.
class ChannelNoise {
 public:
  ChannelNoise() = default;
  /// Of residuals from a fit with `parameters` in this channel.
  ChannelNoise(const Eigen::VectorXd& residual, const std::vector<Segment>& segments,
               double parameters);

  /// Of the residual's size alone: rows that are independent of each other.
  static ChannelNoise white(const Eigen::VectorXd& residual);

  /// Rows that tell as much as one independent row does, for a regressor that is slow: spectral
  /// density at 0 Hz over the variance.
  double correlated_rows() const;

  /// Rows of unit variance, without correlation; (n, k) in place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> rows, const std::vector<Segment>& segments) const;
  /// Standard deviation of one row.
  double deviation() const { return std::sqrt(variance_.empty() ? 1.0 : variance_.front()); }
  int order() const { return static_cast<int>(weights_.size()); }

 private:
  std::vector<Eigen::VectorXd>
      weights_;  // of order 1 … p: of the row before, the one before that …
  std::vector<double> variance_{1.0};  // of the errors of order 0 … p
};

}  // namespace dcnn::identification
