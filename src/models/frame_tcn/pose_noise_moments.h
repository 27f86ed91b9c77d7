// SPDX-License-Identifier: Apache-2.0
// Noise on the pose as the convolutions see it: white on the angles, coloured on the rates by the
// estimator that made them, and much stronger on the first rows of a segment, where its window is
// off-centre.
#pragma once

#include "dcnn/data/features.h"
#include "models/frame_tcn/front.h"

namespace dcnn::frame_tcn {

/// Rows at the start of a segment whose rates are not made as those of the others are.
Index edge_rows(const FeatureLayout& layout);
/// Its estimator looks back alone and takes the first sample for all before it.
bool repeats_first_sample(const FeatureLayout& layout);

class PoseNoiseMoments {
 public:
  explicit PoseNoiseMoments(const FeatureLayout& layout);

  /// Second moments of a group's block means for white noise of the layout's pose deviation (0 dB)
  /// on rows of that history, (48·channels, 48·channels); blocks that it does not know are zero.
  /// `scale` (15) divides the channels; where `noisy` is 0 a channel carries no noise.
  Eigen::MatrixXd of(Index group, std::size_t history, const Eigen::VectorXd& scale,
                     const Eigen::VectorXd& noisy) const;

 private:
  /// Block means at `row` of the group's noise, (48·channels, samples), of unit impulses.
  Eigen::MatrixXd response(Index group, Index row, Index known) const;

  Index edge_, rows_tried_;
  Eigen::VectorXd deviation_;                 // (6)
  std::array<Eigen::MatrixXd, 3> operators_;  // value, first and second derivative of impulses
};

}  // namespace dcnn::frame_tcn
