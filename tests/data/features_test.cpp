// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/features.h"

#include <gtest/gtest.h>

#include <numbers>

#include "data/sample_recording.h"
#include "data/testing.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::contains;
using testing::error_of;
using testing::sine_recording;
using testing::three;
using testing::with_quaternions;
using Set = FeatureSpec::Set;

FeatureSpec spec_of(Set set) {
  FeatureSpec spec;
  spec.set = set;
  spec.derivative.window_s = 0.03;
  return spec;
}

Eigen::MatrixXd features_of(const Recording& recording, Set set) {
  return make_features(recording, make_layout({recording}, spec_of(set), {})).x;
}

double largest(const Eigen::MatrixXd& m) { return m.cwiseAbs().maxCoeff(); }

TEST(Features, PoseHasTheFifteenOfThePaperInOrder) {
  const FeatureLayout layout = make_layout({sine_recording(200)}, {}, {});
  EXPECT_EQ(layout.names,
            (std::vector<std::string>{"alpha", "beta", "gamma", "vx", "vy", "vz", "dalpha", "dbeta",
                                      "dgamma", "ax", "ay", "az", "ddalpha", "ddbeta", "ddgamma"}));
  EXPECT_EQ(layout.units[3], "m/s");
  EXPECT_TRUE(layout.notes.empty());
}

TEST(Features, PoseIsTheMotionInB) {
  const Eigen::MatrixXd x = features_of(sine_recording(1000), Set::kPose);
  for (Index i = 50; i < 950; ++i) {
    const double t = 0.002 * static_cast<double>(i);
    const Vector3d row[] = {three(testing::kPositions, t, 1), three(testing::kAngles, t, 1),
                            three(testing::kPositions, t, 2), three(testing::kAngles, t, 2)};
    for (Index k = 0; k < 4; ++k) {
      ASSERT_LT((x.row(i).segment(3 + 3 * k, 3).transpose() - row[k]).norm(), 2e-2)
          << i << " " << k;
    }
  }
}

TEST(Features, BodyIsTheMotionInS) {
  const Eigen::MatrixXd x = features_of(sine_recording(1000), Set::kBody);
  for (Index i = 50; i < 950; ++i) {
    const double t = 0.002 * static_cast<double>(i);
    Vector3d euler = three(testing::kAngles, t, 0);
    euler[2] += 3.14159;
    const Vector3d rates = three(testing::kAngles, t, 1),
                   accelerations = three(testing::kAngles, t, 2);
    const Matrix3d R = rotation_from_euler(euler), W = euler_rate_matrix(euler);
    const Vector3d row[] = {R.transpose().col(2), R.transpose() * three(testing::kPositions, t, 1),
                            W * rates, R.transpose() * three(testing::kPositions, t, 2),
                            W * accelerations + euler_rate_matrix_derivative(euler, rates) * rates};
    for (Index k = 0; k < 5; ++k) {
      ASSERT_LT((x.row(i).segment(3 * k, 3).transpose() - row[k]).norm(), 2e-2) << i << " " << k;
    }
  }
}

TEST(Features, QuaternionsAndEulerAnglesGiveTheSame) {
  const Recording euler = sine_recording(500), quaternion = with_quaternions(euler);
  for (const Set set : {Set::kPose, Set::kBody}) {
    EXPECT_LT(largest(features_of(euler, set) - features_of(quaternion, set)), 1e-8);
  }
}

TEST(Features, BodyTurnsWithTheMounting) {
  const Recording recording = sine_recording(300);
  FeatureSpec spec = spec_of(Set::kBody);
  const Eigen::MatrixXd plain = make_features(recording, make_layout({recording}, spec, {})).x;
  spec.sensor_rotation_rpy = {0.1, -0.2, 0.3};
  const Eigen::MatrixXd turned = make_features(recording, make_layout({recording}, spec, {})).x;
  const Matrix3d R_ES = rotation_from_euler({0.3, -0.2, 0.1});
  for (Index k = 0; k < 5; ++k) {
    EXPECT_LT(largest(plain.middleCols(3 * k, 3) * R_ES - turned.middleCols(3 * k, 3)), 1e-10);
  }
}

/// Turns about the tool axis with the pitch at -90 degrees, where Euler angles are singular.
Recording singular_recording() {
  Recording recording = sine_recording(300);
  Eigen::VectorXd gamma = 0.5 * (3.0 * recording.column("t").array()).sin();
  recording.set("beta", Eigen::VectorXd::Constant(300, -std::numbers::pi / 2));
  recording.set("alpha", Eigen::VectorXd::Constant(300, 0.4));
  recording.set("gamma", gamma);
  return recording;
}

TEST(Features, BodyIsRightWherePitchIsSingular) {
  for (const Recording& recording :
       {singular_recording(), with_quaternions(singular_recording())}) {
    const Eigen::MatrixXd x = features_of(recording, Set::kBody);
    ASSERT_TRUE(x.allFinite());
    for (Index i = 20; i < 280; ++i) {
      const double t = 0.002 * static_cast<double>(i);
      EXPECT_NEAR(x(i, 0), 1.0, 1e-9);
      EXPECT_LT((x.row(i).segment(6, 3) - Eigen::RowVector3d(1.5 * std::cos(3 * t), 0, 0)).norm(),
                1e-3);
    }
  }
}

TEST(Features, PoseMarksTheSingularRowsAndStaysFinite) {
  Recording recording = singular_recording();
  recording.set("wx", Eigen::VectorXd::Ones(300));
  recording.set("wy", Eigen::VectorXd::Ones(300));
  recording.set("wz", Eigen::VectorXd::Ones(300));
  const Features features = make_features(recording, make_layout({recording}, {}, {}));
  EXPECT_EQ(features.invalid_count(), 300);
  EXPECT_TRUE(features.x.allFinite());
  const Recording plain = sine_recording(300);
  EXPECT_EQ(make_features(plain, make_layout({plain}, {}, {})).invalid_count(), 0);
}

TEST(Features, MeasuredRatesReplaceTheEstimates) {
  const Recording plain = sine_recording(600);
  const Eigen::MatrixXd body = features_of(plain, Set::kBody),
                        pose = features_of(plain, Set::kPose);
  Recording logged = plain;
  const char* names[] = {"vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay", "az", "dwx", "dwy", "dwz"};
  for (Index k = 0; k < 12; ++k) logged.set(names[k], body.col(3 + k));
  // The same signals, as measured: the pose set must turn them back into B and into Euler rates.
  EXPECT_LT(largest(features_of(logged, Set::kPose) - pose), 2e-2);
  logged.set("vx", Eigen::VectorXd::Constant(600, 9.0));
  EXPECT_EQ(features_of(logged, Set::kBody)(300, 3), 9.0);
}

TEST(Features, StartOnTheBranchOfTheTrainingRecording) {
  const Recording training = sine_recording(300);
  const FeatureLayout layout = make_layout({training}, {}, {});
  Recording other = training;
  other.set("gamma", (training.column("gamma").array() - 2.0 * std::numbers::pi).matrix());
  other.set("alpha", (training.column("alpha").array() + 4.0 * std::numbers::pi).matrix());
  EXPECT_LT(largest(make_features(other, layout).x - make_features(training, layout).x), 1e-8);
}

TEST(Features, DoNotDependOnAnyOtherRecording) {
  const Recording a = sine_recording(300);
  const FeatureLayout layout = make_layout({a}, {}, {});
  const Eigen::MatrixXd before = make_features(a, layout).x;
  make_features(with_quaternions(sine_recording(400)), layout);
  EXPECT_EQ(make_features(a, layout).x, before);
}

Recording without_position(Recording recording) {
  for (std::string& name : recording.table.columns) {
    if (name == "x") name = "other";
  }
  return recording;
}

TEST(Features, LeaveOutWhatIsNotLoggedInAllWithANote) {
  const Recording whole = sine_recording(300), poor = without_position(whole);
  const FeatureLayout layout = make_layout({whole, poor}, spec_of(Set::kBody), {});
  EXPECT_EQ(layout.names.size(), 9u);
  EXPECT_EQ(layout.notes.size(), 2u);
  EXPECT_EQ(make_features(poor, layout).x.cols(), 9);
  const FeatureLayout full = make_layout({whole}, spec_of(Set::kBody), {});
  EXPECT_TRUE(contains(error_of([&] { make_features(poor, full); }, Exit::kData), "vx,vy,vz"));
}

TEST(Features, OfAStaticListAreTheOrientation) {
  Recording list = sine_recording(30);
  list.dt = 0.0;
  EXPECT_EQ(make_layout({list}, {}, {}).names.size(), 3u);
  EXPECT_EQ(features_of(list, Set::kBody).cols(), 3);
}

TEST(Features, RejectAnotherRateAndNameResample) {
  const FeatureLayout layout = make_layout({sine_recording(300)}, {}, {});
  EXPECT_NO_THROW(make_features(sine_recording(300, 0.00201), layout));
  const auto message =
      error_of([&] { make_features(sine_recording(300, 0.0021), layout); }, Exit::kData);
  EXPECT_TRUE(contains(message, "--resample 500")) << message;
  error_of(
      [&] {
        make_layout({sine_recording(300), sine_recording(300, 0.001)}, {}, {});
      },
      Exit::kData);
}

TEST(Features, OfAxesAreLoggedOrDerived) {
  const System system = parse_system(Json::parse(R"({"kind":"axes","axes":[
    {"name":"j1","measured":"fx","position":"x","velocity":"y","signals":["z"]},
    {"name":"j2","measured":"fy","position":"alpha","signals":["z"]}]})"),
                                     "s.json");
  const Recording recording = sine_recording(300);
  const FeatureLayout layout = make_layout({recording}, {}, system);
  EXPECT_EQ(layout.names,
            (std::vector<std::string>{"j1_position", "j1_velocity", "j1_acceleration", "z",
                                      "j2_position", "j2_velocity", "j2_acceleration"}));
  const Eigen::MatrixXd x = make_features(recording, layout).x;
  EXPECT_EQ(x.col(1), recording.column("y"));
  EXPECT_EQ(x.col(2), differentiate(recording.block({"x"}), recording, {}).second.col(0));
}

TEST(Features, LayoutComesBackFromJson) {
  const Recording recording = without_position(sine_recording(300));
  const FeatureLayout layout = make_layout({recording}, spec_of(Set::kPose), {});
  const FeatureLayout back =
      parse_layout(parse_json(to_json(layout).dump(), "m", Exit::kModel), "m", Exit::kModel);
  EXPECT_EQ(back.names, layout.names);
  EXPECT_EQ(back.dt, layout.dt);
  EXPECT_EQ(back.circular_mean, layout.circular_mean);
  EXPECT_EQ(make_features(recording, back).x, make_features(recording, layout).x);
}

TEST(Features, LayoutWithForeignNamesIsRejected) {
  Json json = to_json(make_layout({sine_recording(300)}, {}, {}));
  json["names"][4] = "vw";
  error_of([&] { parse_layout(json, "m", Exit::kModel); }, Exit::kModel);
  json = to_json(make_layout({sine_recording(300)}, {}, {}));
  json["system"] = 7;
  error_of([&] { parse_layout(json, "m", Exit::kModel); }, Exit::kModel);
}

}  // namespace
}  // namespace dcnn
