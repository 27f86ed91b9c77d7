// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/streaming_features.h"

#include <gtest/gtest.h>

#include "data/sample_recording.h"
#include "data/testing.h"

namespace dcnn {
namespace {

using testing::sine_recording;
using testing::with_quaternions;
using Set = FeatureSpec::Set;

FeatureLayout streamed_layout(const Recording& recording, Set set, DerivativeSpec::Kind kind) {
  FeatureSpec spec;
  spec.set = set;
  spec.derivative.kind = kind;
  spec.derivative.order = 2;
  spec.sensor_rotation_rpy = {0.1, -0.2, 0.3};
  return make_layout({recording}, spec, {});
}

void expect_same(const Recording& recording, const FeatureLayout& layout, bool quaternion) {
  const Eigen::MatrixXd wanted = make_features(recording, layout).x;
  const Eigen::MatrixXd position = recording.block({"x", "y", "z"});
  const Eigen::MatrixXd turn = quaternion ? recording.block({"qw", "qx", "qy", "qz"})
                                          : recording.block({"alpha", "beta", "gamma"});
  StreamingFeatures stream(layout);
  for (Index i = 0; i < recording.samples(); ++i) {
    for (const Segment& segment : recording.segments) {
      if (segment.begin == i) stream.reset();
    }
    const Eigen::Vector3d p = position.row(i).transpose();
    const Eigen::VectorXd x = quaternion ? stream.push(p, Eigen::Vector4d(turn.row(i).transpose()))
                                         : stream.push(p, Eigen::Vector3d(turn.row(i).transpose()));
    for (Index j = 0; j < x.size(); ++j) {
      ASSERT_NEAR(x[j], wanted(i, j), 1e-7 * (1.0 + std::abs(wanted(i, j)))) << i << " " << j;
    }
  }
}

TEST(StreamingFeatures, AreThoseOfTheWholeRecording) {
  Recording recording = sine_recording(500);
  recording.segments = {{0, 220}, {220, 500}};
  Eigen::VectorXd gamma = recording.column("gamma");  // as logged: jumps by a turn at pi
  for (double& angle : gamma) angle = std::remainder(angle, 2.0 * 3.141592653589793);
  recording.set("gamma", gamma);
  for (const Set set : {Set::kPose, Set::kBody}) {
    const auto layout = streamed_layout(recording, set, DerivativeSpec::Kind::kCausalSavitzkyGolay);
    expect_same(recording, layout, false);
    expect_same(with_quaternions(recording), layout, true);
  }
}

TEST(StreamingFeatures, RefuseDerivativesThatLookAhead) {
  const Recording recording = sine_recording(200);
  const auto layout = streamed_layout(recording, Set::kPose, DerivativeSpec::Kind::kSavitzkyGolay);
  EXPECT_TRUE(testing::contains(
      testing::error_of([&] { StreamingFeatures stream(layout); }, Exit::kUsage), "--online"));
}

}  // namespace
}  // namespace dcnn
