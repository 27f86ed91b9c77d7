// SPDX-License-Identifier: Apache-2.0
// What training draws its batches from. Noise is linear in the estimates and quadratic in the
// roughness, so a sample with noise of any level is a sum of stored parts.
#pragma once

#include "dcnn/models/model.h"
#include "models/frame_tcn/front.h"

namespace dcnn::frame_tcn {

/// Noise of 0 dB on the channels, in units of their scale.
struct UnitNoise {
  Eigen::MatrixXd x;     ///< (N, 15)
  bool on_pose = false;  ///< coloured by the differentiator
};

/// The motion at `speed` times its pace: x(speed·t), rates and accelerations accordingly.
Stream at_speed(const Stream& motion, double speed);

/// (x - mean)/scale.
Eigen::MatrixXd normalised(const Eigen::MatrixXd& x, const Eigen::VectorXd& mean,
                           const Eigen::VectorXd& scale);

/// Estimates and roughness of a stream, one column a row.
struct Material {
  Eigen::MatrixXf experts;    ///< (15·experts, N)
  Eigen::MatrixXf roughness;  ///< (15, N)
  Eigen::MatrixXf clean;      ///< (15, N) the newest samples themselves

  /// `stride` keeps every stride-th row, `edge` is that of roughness().
  Material(const Front& front, const Eigen::MatrixXd& x, const std::vector<Segment>& segments,
           Index stride, Index edge);
  Index rows() const { return experts.cols(); }
};

}  // namespace dcnn::frame_tcn
