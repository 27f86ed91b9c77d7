// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/sensor_frame.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

FeatureLayout pose_layout() {
  FeatureLayout layout;
  layout.names = {"alpha",  "beta", "gamma", "vx", "vy",      "vz",     "dalpha", "dbeta",
                  "dgamma", "ax",   "ay",    "az", "ddalpha", "ddbeta", "ddgamma"};
  layout.spec.sensor_rotation_rpy = {0.3, -0.2, 0.7};
  return layout;
}

/// theta(t) of a turning tool with closed-form rates.
Eigen::Vector3d euler_at(const Eigen::Vector3d& at, const Eigen::Vector3d& rate,
                         const Eigen::Vector3d& acceleration, double t) {
  return at + t * rate + 0.5 * t * t * acceleration;
}

TEST(SensorFrame, IsTheRotatedMotionOnRandomPoses) {
  const FeatureLayout layout = pose_layout();
  const Eigen::Matrix3d R_ES = rotation_from_euler(layout.spec.sensor_rotation_rpy.reverse());
  Rng rng(4);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::RowVectorXd x(15);
    for (double& value : x) value = rng.uniform(-1.2, 1.2);
    const Eigen::RowVectorXd s = SensorFrame(layout).of(x);
    const Eigen::Vector3d theta = x.segment<3>(0).transpose(), rate = x.segment<3>(6).transpose();
    const Eigen::Vector3d acceleration = x.segment<3>(12).transpose();
    const auto R = [&](double t) -> Eigen::Matrix3d {
      return rotation_from_euler(euler_at(theta, rate, acceleration, t)) * R_ES;
    };
    EXPECT_LT((s.segment<3>(0) - R(0).row(2)).norm(), 1e-12);
    EXPECT_LT((s.segment<3>(3) - x.segment<3>(3) * R(0)).norm(), 1e-12);
    EXPECT_LT((s.segment<3>(9) - x.segment<3>(9) * R(0)).norm(), 1e-12);
    // R^T dR/dt is the cross-product matrix of omega in S: central differences.
    const auto omega = [&](double t) -> Eigen::Vector3d {
      const double h = 1e-5;
      const Eigen::Matrix3d skew = R(t).transpose() * (R(t + h) - R(t - h)) / (2.0 * h);
      return {skew(2, 1), skew(0, 2), skew(1, 0)};
    };
    EXPECT_LT((s.segment<3>(6).transpose() - omega(0.0)).norm(), 1e-8);
    const double h = 1e-3;
    EXPECT_LT((s.segment<3>(12).transpose() - (omega(h) - omega(-h)) / (2.0 * h)).norm(), 1e-4);
  }
}

TEST(SensorFrame, LeavesChannelsThatAreInTheSensorFrame) {
  FeatureLayout layout = pose_layout();
  layout.spec.set = FeatureSpec::Set::kBody;
  const Eigen::MatrixXd x = Eigen::MatrixXd::Random(5, 15);
  EXPECT_EQ(SensorFrame(layout).of(x), x);
  EXPECT_TRUE(SensorFrame(layout).to_json().is_null());
}

TEST(SensorFrame, ComesBackFromAFileAndRejectsAnotherOne) {
  const SensorFrame frame(pose_layout());
  const Eigen::MatrixXd x = Eigen::MatrixXd::Random(5, 15);
  EXPECT_EQ(SensorFrame::parse(frame.to_json(), 15, "file", Exit::kModel).of(x), frame.of(x));
  EXPECT_THROW(SensorFrame::parse(frame.to_json(), 12, "file", Exit::kModel), Error);
}

}  // namespace
}  // namespace dcnn
