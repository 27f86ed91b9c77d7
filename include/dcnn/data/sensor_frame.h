// SPDX-License-Identifier: Apache-2.0
// The rows of a wrist's features as channels in the sensor frame S.
#pragma once

#include <Eigen/Dense>
#include <array>

#include "dcnn/data/features.h"

namespace dcnn {

/// Turns [theta, v_B, theta', a_B, theta''] into [R^T e_z, R^T v, omega, R^T a, alpha], R = R_BS:
/// in them the force on a tool hardly depends on where the robot stands, and its law is the same
/// for all of them. The noise of the features goes through the transform with them.
class SensorFrame {
 public:
  /// The identity: what the sets `body` and `axes` need.
  SensorFrame() = default;
  /// Of the features of this layout; blocks that are left out are left out of the channels.
  explicit SensorFrame(const FeatureLayout& layout);

  /// (N, F) to (N, F), block by block in the same places.
  Eigen::MatrixXd of(Eigen::MatrixXd x) const;

  /// Of one row in its place; allocates nothing.
  void turn(Eigen::RowVectorXd& x) const;

  /// Null for the identity, else {rotation_rpy, blocks: first column of each block, -1 without}.
  Json to_json() const;
  static SensorFrame parse(const Json& json, Index features, const std::string& where, Exit exit);

 private:
  void mount(const Eigen::Vector3d& rpy);

  enum Block { kOrientation, kVelocity, kAngularVelocity, kAcceleration, kAngularAcceleration };
  bool identity_ = true;
  Eigen::Vector3d rpy_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_SE_ = Eigen::Matrix3d::Identity();
  std::array<Index, 5> first_{-1, -1, -1, -1, -1};
};

}  // namespace dcnn
