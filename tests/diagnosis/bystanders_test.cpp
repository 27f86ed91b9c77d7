// SPDX-License-Identifier: Apache-2.0
// Laws side by side: two of one kind that look like one, and a listed one beside an unknown one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::Bench;
using test::change;
using test::configuration;
using test::found;
using test::hidden;
using test::names;

Json mode(double freq_hz, double zeta, double fraction) {
  return hidden("flexible_resonance", "sensor_y",
                {{"freq_hz", freq_hz}, {"zeta", zeta}, {"fraction", fraction}});
}

/// Motion fast enough to drive modes of a few hertz.
Json shaken(const Json& modes) {
  Json out = test::at_half_rate(configuration(modes));
  for (Json& recording : out["recordings"]) {
    recording["trajectory"].update({{"hz", {0.2, 12.0}},
                                    {"tones", 20},
                                    {"position_m", {0.003, 0.003, 0.003}},
                                    {"angle_rad", {0.03, 0.03, 0.03}}});
  }
  return out;
}

TEST(Bystanders, TwoModesOfAnAxisAreNotOne) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json one = Bench(shaken(Json::array({mode(6.0, 0.02, 0.5)}))).diagnose().report;
  EXPECT_EQ(names(one), std::vector<std::string>{"flexible_resonance"}) << one["findings"].dump(1);
  const Json two = Bench(shaken({mode(6.0, 0.02, 0.5), mode(9.0, 0.02, 0.4)})).diagnose().report;
  // Either is named at its own frequency, beside something unnamed, or neither.
  EXPECT_NE(two["verdict"], "explained");
  for (const Json& f : two["findings"]) {
    if (f["effect"] != "flexible_resonance") continue;
    const double hz = f["parameters"]["freq_hz"]["value"].get<double>();
    EXPECT_LT(std::min(std::abs(hz / 6.0 - 1.0), std::abs(hz / 9.0 - 1.0)), 0.02) << f.dump(1);
    EXPECT_EQ(f["axis"], "sensor_y") << f.dump(1);
  }
}

TEST(Bystanders, ADelayAndALowPassAreTwo) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json report = Bench(configuration({hidden("time_delay", nullptr, {{"delay_s", 0.03}}),
                                           hidden("lowpass", nullptr, {{"tau_s", 0.03}})}))
                          .diagnose()
                          .report;
  ASSERT_EQ(found(report), (std::set<std::string>{"time_delay", "lowpass"}))
      << report["findings"].dump(1);
  for (const Json& f : report["findings"]) {
    const char* number = f["effect"] == "lowpass" ? "tau_s" : "delay_s";
    EXPECT_NEAR(f["parameters"][number]["value"].get<double>(), 0.03, 0.003) << f.dump(1);
  }
}

// A spring that stiffens along x has no name; drag along the base's y does not hang on it.
TEST(Bystanders, AListedLawBesideAnUnknownOneKeepsItsName) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(
      configuration(Json::array({hidden("quadratic_drag", "base_y", {{"c2_ns2pm2", 20.0}})})));
  change(bench, [](Recording& log) {
    const Eigen::ArrayXd q = log.column("alpha").array();
    log.set("fx", log.column("fx") - (0.1 * q + 0.05 * q.cube()).matrix());
  });
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "partly-explained") << report["findings"].dump(1);
  EXPECT_EQ(names(report), std::vector<std::string>{"quadratic_drag"})
      << report["findings"].dump(1);
}

}  // namespace
}  // namespace dcnn
