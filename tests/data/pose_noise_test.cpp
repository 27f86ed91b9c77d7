// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/pose_noise.h"

#include <gtest/gtest.h>

#include "data/sample_recording.h"
#include "data/testing.h"

namespace dcnn {
namespace {

using testing::contains;
using testing::error_of;
using testing::sine_recording;
using testing::with_quaternions;
using Set = FeatureSpec::Set;
using Kind = DerivativeSpec::Kind;

FeatureLayout layout_of(const Recording& recording, Set set, Kind kind = Kind::kSavitzkyGolay) {
  FeatureSpec spec;
  spec.set = set;
  spec.derivative.kind = kind;
  return make_layout({recording}, spec, {});
}

double largest_entry(const Eigen::MatrixXd& m) { return m.cwiseAbs().maxCoeff(); }

/// Two stretches, as after a gap: derivatives of the noise must not cross it either.
Recording two_stretches() {
  Recording recording = sine_recording(600);
  recording.segments = {{0, 250}, {250, 600}};
  return recording;
}

TEST(PoseNoise, IsTheChangeOfTheFeaturesWhenThePoseIsPerturbed) {
  const Recording recording = two_stretches();
  const double scale = std::pow(10.0, -80.0 / 20.0);
  for (const Kind kind :
       {Kind::kSavitzkyGolay, Kind::kCausalSavitzkyGolay, Kind::kCentral, Kind::kSpline}) {
    const FeatureLayout layout = layout_of(recording, Set::kPose, kind);
    const Eigen::MatrixXd clean = make_features(recording, layout).x;
    const Eigen::MatrixXd moved =
        make_features(with_pose_noise(recording, layout, scale, 5), layout).x;
    const Eigen::MatrixXd noise = scale * pose_noise(recording, layout, 5);
    EXPECT_LT(largest_entry(clean + noise - moved), 1e-7 * largest_entry(noise))
        << static_cast<int>(kind);
    EXPECT_GT(largest_entry(noise.leftCols<3>()), 1e-5);
  }
}

TEST(PoseNoise, HasTheVarianceEachCoordinateHadInTraining) {
  const Recording recording = sine_recording(20000);
  const FeatureLayout layout = layout_of(recording, Set::kPose);
  const Eigen::MatrixXd draw = pose_draw(recording, layout, 1);
  Eigen::MatrixXd pose(20000, 6);
  pose << recording.block({"x", "y", "z"}), recording.block({"alpha", "beta", "gamma"});
  for (Index k = 0; k < 6; ++k) {
    const double wanted =
        std::sqrt((pose.col(k).array() - pose.col(k).mean()).square().sum() / 19999.0);
    EXPECT_NEAR(layout.pose_deviation[k], wanted, 1e-9) << k;
    EXPECT_NEAR(std::sqrt(draw.col(k).squaredNorm() / 20000.0), wanted, 0.03 * wanted) << k;
  }
  EXPECT_EQ(draw, pose_draw(recording, layout, 1));
  EXPECT_NE(draw, pose_draw(recording, layout, 2));
}

TEST(PoseNoise, AccelerationNoiseFollowsTheClosedFormOfTheLocalFit) {
  // sigma·sqrt(720/(N(N^2-1)(N^2-4)))/dt^2 for a quadratic or a cubic on N samples
  const Recording recording = sine_recording(20000);
  const FeatureLayout layout = layout_of(recording, Set::kPose);
  const double n = layout.spec.derivative.window(layout.dt), dt = layout.dt;
  const Eigen::MatrixXd noise = pose_noise(recording, layout, 3);
  const double factor = std::sqrt(720.0 / (n * (n * n - 1) * (n * n - 4))) / (dt * dt);
  const double measured = std::sqrt(noise.col(9).squaredNorm() / 20000.0);
  EXPECT_NEAR(measured, factor * layout.pose_deviation[0], 0.08 * measured);
}

TEST(PoseNoise, RatesThatAreLoggedCarryNone) {
  Recording recording = sine_recording(300);
  for (const char* name : {"vx", "vy", "vz"}) recording.set(name, Eigen::VectorXd::Ones(300));
  const FeatureLayout layout = layout_of(recording, Set::kPose);
  const Eigen::MatrixXd noise = pose_noise(recording, layout, 1);
  EXPECT_EQ(largest_entry(noise.middleCols<3>(3)), 0.0);
  EXPECT_GT(largest_entry(noise.middleCols<3>(6)), 0.0);
}

TEST(PoseNoise, MovesQuaternionsAsItMovesEulerAngles) {
  const Recording euler = sine_recording(300), quaternion = with_quaternions(euler);
  const FeatureLayout layout = layout_of(euler, Set::kBody);
  const auto body = [&](const Recording& recording) {
    return make_features(with_pose_noise(recording, layout, 1e-3, 4), layout).x;
  };
  EXPECT_LT(largest_entry(body(euler) - body(quaternion)), 1e-6);
  EXPECT_GT(largest_entry(body(euler) - make_features(euler, layout).x), 1e-3);
}

TEST(PoseNoise, TheModelFileHoldsItsPower) {
  const Recording recording = sine_recording(300);
  const FeatureLayout layout = layout_of(recording, Set::kPose);
  const FeatureLayout again = parse_layout(to_json(layout), "m", Exit::kModel);
  EXPECT_EQ(again.pose_deviation, layout.pose_deviation);
  Json json = to_json(layout);
  json.erase("pose_deviation");
  const FeatureLayout old = parse_layout(json, "m", Exit::kModel);
  EXPECT_TRUE(
      contains(error_of([&] { pose_noise(recording, old, 1); }, Exit::kModel), "train again"));
  json["pose_deviation"] = {1, 2, 3, 4, 5, -6};
  EXPECT_TRUE(contains(error_of([&] { parse_layout(json, "m", Exit::kModel); }, Exit::kModel),
                       "pose_deviation"));
}

TEST(PoseNoise, SetsThatAreNotLinearInThePoseAreRefused) {
  const Recording recording = sine_recording(300);
  const FeatureLayout body = layout_of(recording, Set::kBody);
  EXPECT_TRUE(contains(error_of([&] { pose_noise(recording, body, 1); }, Exit::kUsage), "'pose'"));
  FeatureLayout axes;
  axes.spec.set = Set::kAxes;
  EXPECT_TRUE(
      contains(error_of([&] { pose_draw(recording, axes, 1); }, Exit::kUsage), "on the features"));
}

}  // namespace
}  // namespace dcnn
