// SPDX-License-Identifier: Apache-2.0
#include "dcnn/calibration/calibration.h"

#include <gtest/gtest.h>

#include "data/testing.h"
#include "dcnn/core/random.h"
#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::contains;
using testing::error_of;

const Matrix3d kMounting = rotation_from_euler({-0.52, 0.03, -0.026});
constexpr double kDegree = M_PI / 180.0;

/// n forces of 5 N in random directions: r in E, s = R^T r + bias + noise in S.
ForcePairs random_pairs(Index n, double noise, const Vector3d& bias = Vector3d::Zero(),
                        std::uint64_t seed = 1) {
  Rng rng(seed);
  ForcePairs pairs{
      "pairs.csv", Eigen::MatrixXd(n, 3), Eigen::MatrixXd(n, 3), Eigen::VectorXd::Ones(n), {}};
  for (Index i = 0; i < n; ++i) {
    const Vector3d r = 5.0 * Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Vector3d e(rng.normal(), rng.normal(), rng.normal());
    pairs.reference.row(i) = r;
    pairs.sensor.row(i) = kMounting.transpose() * r + bias + noise * e;
  }
  return pairs;
}

TEST(Calibration, NoiseFreePairsGiveTheMountingToTheLastDigits) {
  const Calibration c = calibrate(random_pairs(20, 0.0), {});
  EXPECT_LT(angle_between(c.R_ES, kMounting), 1e-9);
  EXPECT_NEAR(c.gain, 1.0, 1e-12);
  EXPECT_LT(c.residual_rms, 1e-12);
  EXPECT_LT(c.offset.norm(), 1e-12);
  EXPECT_TRUE(c.notes.empty());
}

/// 2.7 mrad a turn about each axis: half a degree is 3.2 deviations, which 1 draw in 60 exceeds.
TEST(Calibration, TwentyNoisyOrientationsStayBelowHalfADegree) {
  int below = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Calibration c = calibrate(random_pairs(20, 0.05, Vector3d::Zero(), seed), {});
    const double error = angle_between(c.R_ES, kMounting);
    below += error < 0.5 * kDegree;
    EXPECT_LT(error, 0.8 * kDegree) << seed;
    EXPECT_NEAR(c.residual_rms, 0.05, 0.02);
    EXPECT_NEAR(c.gain, 1.0, 0.02);
  }
  EXPECT_GE(below, 48);
}

TEST(Calibration, CovarianceDescribesTheScatterOfTheEstimates) {
  constexpr int kRuns = 400;
  Matrix3d scatter = Matrix3d::Zero(), stated = Matrix3d::Zero();
  for (int run = 0; run < kRuns; ++run) {
    ForcePairs pairs = random_pairs(20, 0.0);
    pairs.reference.col(2) *= 0.1;  // unequal: the turn about some axes is known better
    pairs.sensor = pairs.reference * kMounting;
    Rng rng({7, static_cast<std::uint64_t>(run)});
    for (Index i = 0; i < 60; ++i) pairs.sensor(i / 3, i % 3) += 0.05 * rng.normal();
    const Calibration c = calibrate(pairs, {});
    const Eigen::AngleAxisd turn(kMounting.transpose() * c.R_ES);
    const Vector3d v = turn.angle() * turn.axis();
    scatter += v * v.transpose() / kRuns;
    stated += c.covariance / kRuns;
  }
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(scatter(i, i) / stated(i, i), 1.0, 0.25) << i;
}

TEST(Calibration, BiasIsFoundWithTheTurn) {
  const Vector3d bias(0.6, -0.4, 1.1);
  const Calibration c = calibrate(random_pairs(20, 0.0, bias), {.with_bias = true, .nominal = {}});
  EXPECT_LT(angle_between(c.R_ES, kMounting), 1e-9);
  EXPECT_LT((c.offset + kMounting * bias).norm(), 1e-12);
}

TEST(Calibration, ABiasThatWasNotAskedForIsPointedOut) {
  const auto notes = [](const Vector3d& bias) {
    return calibrate(random_pairs(12, 0.05, bias), {}).notes;
  };
  EXPECT_TRUE(notes(Vector3d::Zero()).empty());
  const auto said = notes({1.0, -0.5, 0.3});
  ASSERT_FALSE(said.empty());
  EXPECT_TRUE(contains(said.back(), "--with-bias")) << said.back();
}

TEST(Calibration, WeightsLeaveOutWhatTheyDoNotTrust) {
  ForcePairs pairs = random_pairs(20, 0.0);
  pairs.sensor.row(3) += Eigen::RowVector3d(4, 4, 4);
  pairs.weights[3] = 1e-14;
  EXPECT_LT(angle_between(calibrate(pairs, {}).R_ES, kMounting), 1e-9);
}

TEST(Calibration, CollinearForcesNameTheAxisThatIsNotDetermined) {
  ForcePairs pairs = random_pairs(8, 0.0);
  for (Index i = 0; i < 8; ++i) {
    pairs.sensor.row(i) = Eigen::RowVector3d(0, static_cast<double>(i + 1), 0);
    pairs.reference.row(i) = pairs.sensor.row(i) * kMounting.transpose();
  }
  const auto message = error_of([&] { calibrate(pairs, {}); }, Exit::kData);
  EXPECT_TRUE(contains(message, "1.00, 0.00)")) << message;
  EXPECT_TRUE(contains(message, "undetermined")) << message;
}

TEST(Calibration, MirroredInputIsRejectedAndTheSignThatFitsIsNamed) {
  ForcePairs pairs = random_pairs(20, 0.05);
  pairs.sensor *= -1.0;
  const auto message = error_of([&] { calibrate(pairs, {}); }, Exit::kData);
  EXPECT_TRUE(contains(message, "left-handed axes or swapped sign")) << message;
  EXPECT_TRUE(contains(message, "--force-sign -1")) << message;
  pairs.sensor *= -1.0;
  pairs.sensor.col(1) *= -1.0;
  error_of([&] { calibrate(pairs, {}); }, Exit::kData);
}

TEST(Calibration, TooFewPairsAreRejected) {
  error_of([] { calibrate(random_pairs(1, 0.0), {}); }, Exit::kData);
  error_of([] { calibrate(random_pairs(2, 0.0), {.with_bias = true, .nominal = {}}); },
           Exit::kData);
  EXPECT_LT(angle_between(calibrate(random_pairs(2, 0.0), {}).R_ES, kMounting), 1e-9);
}

TEST(Calibration, SaysHowToReadPermutedAxes) {
  ForcePairs pairs = random_pairs(20, 0.05);
  const Eigen::MatrixXd right = pairs.sensor;
  pairs.sensor << -right.col(1), right.col(0), right.col(2);  // logged x is -y, logged y is x
  const Calibration c = calibrate(pairs, {.with_bias = false, .nominal = kMounting});
  ASSERT_TRUE(c.convention && c.nominal_angle);
  EXPECT_NEAR(*c.nominal_angle, M_PI / 2, 0.01);
  EXPECT_EQ(c.convention->axes, "+y -x +z");
  EXPECT_EQ(c.convention->force_sign, 1);
  ASSERT_FALSE(c.notes.empty());
  EXPECT_TRUE(contains(c.notes.back(), "+y -x +z")) << c.notes.back();
  const Calibration agreeing =
      calibrate(random_pairs(20, 0.05), {.with_bias = false, .nominal = kMounting});
  EXPECT_EQ(agreeing.convention->axes, "+x +y +z");
  EXPECT_LT(*agreeing.nominal_angle, 0.5 * kDegree);
  EXPECT_TRUE(agreeing.notes.empty());
}

TEST(Calibration, AGainThatIsOffIsReportedNotApplied) {
  ForcePairs pairs = random_pairs(20, 0.0);
  pairs.sensor /= 9.81;
  const Calibration c = calibrate(pairs, {});
  EXPECT_NEAR(c.gain, 9.81, 1e-9);
  ASSERT_EQ(c.notes.size(), 1U);
  EXPECT_TRUE(contains(c.notes[0], "kgf"));
}

TEST(Calibration, AFileThatIsNoRotationIsRefused) {
  Json json = to_json(calibrate(random_pairs(20, 0.0), {}));
  const auto good = testing::temporary_file("c.json", json.dump());
  EXPECT_LT(angle_between(read_calibration(good).R_ES, kMounting), 1e-9);
  json["rotation_es"][0][0] = 2.0;
  const auto bad = testing::temporary_file("bad.json", json.dump());
  EXPECT_TRUE(contains(error_of([&] { read_calibration(bad); }, Exit::kData), "not a rotation"));
}

// A controller has subtracted the weight: what is left follows the reference in no mounting.
TEST(Calibration, ForcesThatDoNotFollowTheReferenceAreRefused) {
  ForcePairs pairs = random_pairs(24, 0.0);
  Rng rng(11);
  for (double& value : pairs.sensor.reshaped()) value = 0.02 * rng.normal();
  EXPECT_TRUE(contains(error_of([&] { calibrate(pairs, {}); }, Exit::kData), "explains only"));
  EXPECT_TRUE(
      contains(error_of([&] { calibrate(pairs, {.with_bias = true, .nominal = {}}); }, Exit::kData),
               "payload"));
}

/// 24 poses of a real ATI Gamma sensor on a KUKA LBR Med (see docs/use/calibrate.md).
TEST(Calibration, RealStaticPosesAreFittedToATenthOfANewton) {
  const auto path = testing::shared("data/ntnu_wrist/static_24_poses.csv");
  if (path.empty()) GTEST_SKIP() << "the recordings are not beside the checkout";
  ReadOptions read;
  read.static_list = true;
  const Recording poses = read_recording(path, read, System());
  const Calibration c =
      calibrate(static_pairs(poses, {}, true), {.with_bias = true, .nominal = {}});
  EXPECT_EQ(c.pairs, 24);
  EXPECT_LT(c.residual_rms, 0.12);
  ASSERT_TRUE(c.mass_kg);
  EXPECT_NEAR(*c.mass_kg, 0.94, 0.3);
}

}  // namespace
}  // namespace dcnn
