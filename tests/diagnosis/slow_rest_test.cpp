// SPDX-License-Identifier: Apache-2.0
// What is named where something is left that no effect explains, and what only looks like it.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::at_half_rate;
using test::Bench;
using test::change;
using test::configuration;
using test::found;
using test::frictions_along_base;
using test::hidden;

// Both bend the force over the speed as a Stribeck curve does whose shapes are at their ends.
TEST(SlowRest, DryFrictionAndDragAreNoStribeckCurve) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(
      configuration({hidden("coulomb_friction", "base_y", {{"fc_n", 0.18}, {"v0_mps", 0.011}}),
                     hidden("quadratic_drag", "base_y", {{"c2_ns2pm2", 12.0}}),
                     hidden("hum", nullptr,
                            {{"freq_hz", 6.6},
                             {"sin_x_n", 0.12},
                             {"sin_y_n", 0.03},
                             {"sin_z_n", 0.08},
                             {"cos_x_n", 0.0},
                             {"cos_y_n", 0.0},
                             {"cos_z_n", 0.15}})}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(found(report), (std::set<std::string>{"coulomb_friction", "quadratic_drag", "hum"}))
      << report["findings"].dump(1);
}

// A drift that settles and a wave of two thirds of the recording: neither is certain, their mean
// is.
TEST(SlowRest, OfAnOffsetThatWandersTheMeanIsKept) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(at_half_rate(configuration(frictions_along_base())));
  change(bench, [](Recording& log) {
    const Eigen::ArrayXd t = log.column("t").array();
    const char* axes[] = {"fx", "fy", "fz"};
    for (int k = 0; k < 3; ++k) {
      const Eigen::ArrayXd wander = 0.06 * (1.0 - (-t / 15.0).exp()) + 0.02 * (0.5 * t + k).sin();
      log.set(axes[k], log.column(axes[k]) + (k == 1 ? -0.7 : 1.0) * wander.matrix());
    }
  });
  const Json report = bench.diagnose().report;
  const auto after = report["fit"]["holdout_rmse_after"].get<std::vector<double>>();
  EXPECT_TRUE(found(report).count("bias") || found(report).count("thermal_drift"))
      << report["findings"].dump(1);
  for (const double rmse : after) EXPECT_LT(rmse, 0.037) << "the noise is 0.028 N";
  for (const Json& f : report["findings"]) {
    EXPECT_NE(f["effect"], "stribeck_friction") << "what wanders does not bend a law";
  }
}

}  // namespace
}  // namespace dcnn
