// SPDX-License-Identifier: Apache-2.0
// The newest feature vector of a pose that comes sample by sample: what runs online.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/data/features.h"

namespace dcnn {

/// The rows that make_features() gives, to rounding, for a recording that holds the pose alone, on
/// the clock of the layout. Before the first sample it is taken to have been repeated. push()
/// allocates nothing and costs O(window).
class StreamingFeatures {
 public:
  /// Error(kUsage) unless the set is pose or body and the estimator is sg_causal.
  explicit StreamingFeatures(const FeatureLayout& layout);

  /// Forgets all samples: a new stretch of time begins.
  void reset() { count_ = 0; }
  /// (F) features at this sample, valid until the next one. Position in m, alpha, beta, gamma in
  /// rad.
  const Eigen::VectorXd& push(const Eigen::Vector3d& position, const Eigen::Vector3d& euler);
  /// The same with the orientation as a quaternion (w, x, y, z) of any length above zero.
  const Eigen::VectorXd& push(const Eigen::Vector3d& position, const Eigen::Vector4d& quaternion);

 private:
  static constexpr Index kChannels = 7;  // position, then Euler angles (and a zero) or quaternion
  using Sample = Eigen::Matrix<double, kChannels, 1>;

  const Eigen::VectorXd& advance(Sample sample);
  void join(Sample& sample) const;
  void store(const Sample& sample);
  void write(const Sample& now, const Sample& first, const Sample& second);

  FeatureLayout layout_;
  bool body_;
  std::vector<int> blocks_;  // which of the five groups of three each group of rows is
  Eigen::Matrix3d R_SE_;
  Eigen::VectorXd first_weights_, second_weights_;
  Eigen::Matrix<double, kChannels, Eigen::Dynamic>
      ring_;  // every sample twice: a window in one piece
  Index window_, next_ = 0, count_ = 0;
  Sample last_ = Sample::Zero();
  Eigen::VectorXd x_;
};

}  // namespace dcnn
