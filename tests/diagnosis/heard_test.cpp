// SPDX-License-Identifier: Apache-2.0
// What was found by tests of its own, judged by recordings that decided nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/random.h"
#include "diagnosis/chain.h"
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
