// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/trajectory.h"

#include <gtest/gtest.h>

#include "physics/support.h"

namespace dcnn {
namespace {

Trajectory make(const Json& json, Index samples = 2000, std::uint64_t seed = 1) {
  Rng rng(seed);
  return make_trajectory(Options(json, "config.json", Exit::kUsage), {samples, 0.002, 3.0}, rng);
}

Json of_kind(const std::string& kind) {
  Json json = example_trajectory();
  json["kind"] = kind;
  return json;
}

TEST(Trajectory, DerivativesAgreeWithFiniteDifferences) {
  for (const std::string kind : {"multisine", "band_multisine"}) {
    const Trajectory x = make(of_kind(kind));
    const auto check = [&](const Eigen::MatrixXd& value, const Eigen::MatrixXd& rate) {
      const Index n = value.rows() - 2;
      const Eigen::MatrixXd numeric = (value.bottomRows(n) - value.topRows(n)) / 0.004;
      EXPECT_LT((numeric - rate.middleRows(1, n)).norm(), 1e-3 * rate.norm()) << kind;
    };
    check(x.position, x.velocity);
    check(x.velocity, x.acceleration);
    check(x.euler, x.euler_rate);
    check(x.euler_rate, x.euler_acceleration);
  }
}

TEST(Trajectory, StaysWithinItsSizeAboutItsCentre) {
  const Trajectory x = make(of_kind("multisine"), 20000);
  EXPECT_LE(x.position.col(2).cwiseAbs().maxCoeff(), 0.12);
  EXPECT_LE((x.euler.col(2).array() - 1.0).abs().maxCoeff(), 0.7);
  EXPECT_GT((x.euler.col(2).array() - 1.0).abs().maxCoeff(), 0.5);
}

TEST(Trajectory, BandMultisineReachesItsPeak) {
  const Trajectory x = make(of_kind("band_multisine"));
  EXPECT_NEAR(x.position.col(0).cwiseAbs().maxCoeff(), 0.1, 1e-12);
  EXPECT_NEAR((x.euler.col(0).array() - 0.2).abs().maxCoeff(), 0.9, 1e-12);
}

TEST(Trajectory, BeginsAtItsTimeAndDependsOnTheSeed) {
  const Trajectory one = make(of_kind("multisine")), same = make(of_kind("multisine"));
  EXPECT_EQ(one.t(0), 3.0);
  EXPECT_NEAR(one.t(1999), 3.0 + 1999 * 0.002, 1e-12);
  EXPECT_EQ(one.position, same.position);
  EXPECT_NE(one.position, make(of_kind("multisine"), 2000, 2).position);
}

TEST(Trajectory, StaticPosesAreAtRestAndSpread) {
  const Trajectory x = make(
      {{"kind", "static"}, {"angle_rad", {1, 0.5, 0.1}}, {"angle_center_rad", {0, 0, 3}}}, 200);
  EXPECT_TRUE(x.is_static());
  EXPECT_EQ(x.euler_rate.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_LE((x.euler.col(2).array() - 3.0).abs().maxCoeff(), 0.1);
  EXPECT_GT(x.euler.col(0).maxCoeff() - x.euler.col(0).minCoeff(), 1.8);
}

TEST(Trajectory, RefusesUnknownKindsKeysAndFrequencies) {
  const auto refused = [](Json json) {
    try {
      make(json);
    } catch (const Error& error) {
      return error.exit() == Exit::kUsage;
    }
    return false;
  };
  EXPECT_TRUE(refused(of_kind("spiral")));
  Json json = example_trajectory();
  json["tonse"] = 3;
  EXPECT_TRUE(refused(json));
  json = example_trajectory();
  json["hz"] = {0.1, 260.0};
  EXPECT_TRUE(refused(json));
  json = example_trajectory();
  json["tones"] = 0;
  EXPECT_TRUE(refused(json));
  EXPECT_TRUE(refused({{"kind", "static"}, {"tones", 3}}));
}

}  // namespace
}  // namespace dcnn
