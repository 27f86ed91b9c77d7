// SPDX-License-Identifier: Apache-2.0
// What a young segment shows of a motion where derivatives look back alone. Before its first sample
// the estimator repeats it, so the rates of the first window rise from rest to what they are: a
// filter made for motion that goes on takes that for an acceleration.
#pragma once

#include "dcnn/data/features.h"
#include "dcnn/models/model.h"
#include "models/frame_tcn/front.h"

namespace dcnn::frame_tcn {

class StartMoments {
 public:
  /// The layout's estimator repeats_first_sample(); `mean` and `scale` normalise the channels.
  StartMoments(FeatureLayout layout, Eigen::VectorXd mean, Eigen::VectorXd scale);

  /// Segments are made to begin all over the motion, in SI; `share` is its weight.
  void add(const Stream& motion, double share);

  /// Of the rows that this history serves, block means as they are there and newest samples as they
  /// were had the segment been old; no blocks at all where no motion was long enough.
  Moments of(Index group, std::size_t history) const;

 private:
  struct Rows;
  Eigen::MatrixXd features(const Eigen::MatrixXd& pose, const Stream& motion,
                           const std::vector<Segment>& segments) const;
  void add(const Rows& rows, Index group, std::size_t history, double share);

  FeatureLayout layout_;
  Eigen::VectorXd mean_, scale_;
  std::array<std::array<Moments, kHistories.size()>, kGroups> sums_;
  std::array<double, kHistories.size()> shares_{};
};

}  // namespace dcnn::frame_tcn
