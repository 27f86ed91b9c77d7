// SPDX-License-Identifier: Apache-2.0
// What was found by tests of its own, judged by recordings that decided nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/random.h"
#include "diagnosis/chain.h"
#include "diagnosis/impact_forces.h"
#include "diagnosis/impacts.h"
#include "diagnosis/load.h"
#include "diagnosis/search.h"
#include "diagnosis/support.h"

namespace dcnn {
namespace {

Json with_a_slug() {
  return test::configuration(
      Json::array({test::hidden("loose_load", "sensor_x", {{"slug_kg", 0.06}, {"gap_m", 0.004}})}));
}

TEST(Heard, ImpactsOfAnotherRecordingBearThemOut) {
  const test::Bench loose(with_a_slug()), firm(test::configuration(Json::array()));
  const LoadedCase with = load_wrist(loose.request()), without = load_wrist(firm.request());
  const auto left = [](const Case& study) { return difference(study, predict(study, {})); };
  const Impacts impacts = find_impacts(with.fit, left(with.fit));
  ASSERT_TRUE(impacts.member);
  double all = 0.0;
  for (const Impacts::Tried& tried : impacts.tried) all += tried.probability;
  EXPECT_NEAR(all, 1.0, 1e-9);
  EXPECT_GT(impacts_support(with.holdout, left(with.holdout), impacts), 5.0);
  EXPECT_LT(impacts_support(without.holdout, left(without.holdout), impacts), -5.0);
}

/// Student's t with 2 degrees of freedom, whose variance is infinite.
Eigen::VectorXd heavy_tailed(Index n, Rng& rng) {
  return Eigen::VectorXd::NullaryExpr(n, [&] {
    const double a = rng.normal(), b = rng.normal();
    return rng.normal() / std::sqrt(0.5 * (a * a + b * b));
  });
}

TEST(Heard, ScoresOfForcesAreNormalWhateverTheTails) {
  Rng rng({11u});
  const Index n = 20000;
  const Eigen::VectorXd noise = heavy_tailed(n, rng);
  const Channel channel(noise, Eigen::VectorXd::Constant(n, 0.5));
  const Template shape(2);
  const Forces& forces = channel.about(shape);
  ASSERT_TRUE(forces.has(shape.far()) && !forces.has(shape.far() - 1));
  const Index inner = n - 2 * shape.far();
  const auto scores = forces.scores.segment(shape.far(), inner).array();
  EXPECT_NEAR(scores.square().mean(), 1.0, 0.01);
  EXPECT_NEAR((scores.abs() < 1.0).cast<double>().mean(), 0.6827, 0.002);
  EXPECT_NEAR(scores.abs().maxCoeff(), 4.2145, 0.001);  // normal quantile at 1 - 1/(4 n)
  const double middle =
      2.0 * shape.weights().dot(noise.segment(777 - shape.far(), 2 * shape.far() + 1));
  EXPECT_NEAR(forces.values(777), middle, 1e-12);
  EXPECT_GT(forces.values(777) * forces.scores(777), 0.0);
}

TEST(Heard, OutliersOfNoiseAreNoImpacts) {
  const test::Bench firm(test::configuration(Json::array()));
  const Case study = load_wrist(firm.request()).fit;
  Rng rng({11u});
  for (int draw = 0; draw < 10; ++draw) {
    Signals noise;
    for (const Log& log : study.logs) {
      const Index n = log.motion.samples();
      noise.emplace_back(n, 3);
      for (Index j = 0; j < 3; ++j) noise.back().col(j) = 0.04 * heavy_tailed(n, rng);
    }
    EXPECT_FALSE(find_impacts(study, noise).member) << draw;
  }
}

/// Of 0.05 N at 60 Hz, beside noise of 0.04 N. The phase that it has in the recording that is held
/// out is that of the other, or half a turn off.
Json report_beside_mains(double turned) {
  const test::Bench bench(test::configuration(Json::array()));
  bool held_out = false;
  test::change(bench, [&](Recording& log) {
    const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * 60.0 * log.column("t").array();
    log.set("fy", log.column("fy").array() + 0.05 * (angle + (held_out ? turned : 0.0)).sin());
    held_out = true;
  });
  return bench.diagnose().report;
}

TEST(Heard, AHumThatGoesOnIsFound) {
  const Json report = report_beside_mains(0.0);
  EXPECT_EQ(test::found(report), std::set<std::string>{"hum"}) << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "explained");
}

TEST(Heard, AHumWhosePhaseDoesNotLastIsNoise) {
  const Json report = report_beside_mains(std::numbers::pi);
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"].dump(1);
  EXPECT_EQ(report["notes"].back(),
            "a line at 60 Hz, the phase of which does not last: it counts as noise");
}

}  // namespace
}  // namespace dcnn
