// SPDX-License-Identifier: Apache-2.0
// Whether a motion lies in the band that training has seen.
#pragma once

#include "models/frame_tcn/blocks.h"

namespace dcnn::frame_tcn {

/// (15, N) of each row's last second, all log10 and over the three axes of a kind (theta, v,
/// theta', a, theta''): strength of the motion, how sharply its means over 32 samples bend, how
/// rough it is.
Eigen::MatrixXd motion_signs(const Eigen::MatrixXd& x, const std::vector<Segment>& segments);

/// Mahalanobis distance of the signs from the nearest of some clouds, one per range of noise.
class Novelty {
 public:
  static constexpr Index kSigns = 15;
  Novelty() = default;
  explicit Novelty(Index clouds);

  /// Cloud k: mean and shrunken covariance of `seen` (15, N); its limit is what one column in 10^4
  /// of `held_out` exceeds, with a margin.
  void learn(Index cloud, const Eigen::MatrixXd& seen, const Eigen::MatrixXd& held_out);
  /// (N) distances over the limit: above 1 is outside of every cloud.
  Eigen::VectorXd score(const Eigen::MatrixXd& signs) const;
  Index clouds() const { return limit.size(); }

  Eigen::MatrixXd mean;    ///< (15, clouds)
  Eigen::MatrixXd whiten;  ///< (15, 15·clouds): inverses of the Cholesky factors
  Eigen::VectorXd limit;   ///< (clouds)

 private:
  Eigen::VectorXd distance(Index cloud, const Eigen::MatrixXd& signs) const;
};

}  // namespace dcnn::frame_tcn
