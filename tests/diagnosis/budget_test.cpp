// SPDX-License-Identifier: Apache-2.0
// Which kind of physics a difference is made of, before anything is named.
#include <gtest/gtest.h>

#include <map>

#include "diagnosis/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::Bench;
using test::configuration;
using test::hidden;

std::map<std::string, double> shares(const Json& effects) {
  const Json report = Bench(configuration(effects)).diagnose().report;
  std::map<std::string, double> shares;
  double sum = 0.0;
  for (const Json& part : report["where"]["budget"]) {
    sum += shares[part["part"].get<std::string>()] = part["share"].get<double>();
  }
  EXPECT_LE(sum, 1.0 + 1e-9);
  return shares;
}

Json one(const Json& effect) { return Json::array({effect}); }

std::string largest(const std::map<std::string, double>& shares) {
  std::string most = "other";
  for (const auto& [part, share] : shares) {
    if (part != "noise" && share > shares.at(most)) most = part;
  }
  return most;
}

TEST(Budget, WhereNothingIsMissingAllIsNoise) {
  const auto all = shares(Json::array());
  EXPECT_GT(all.at("noise"), 0.95);
}

TEST(Budget, TellsKindsOfPhysicsApart) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const auto kind = [](const char* effect, const Json& axis, const Json& parameters) {
    return largest(shares(one(hidden(effect, axis, parameters))));
  };
  EXPECT_EQ(kind("mass", nullptr, {{"delta_mass_kg", 0.02}}), "parameter");
  EXPECT_EQ(kind("coulomb_friction", "base_y", {{"fc_n", 0.2}, {"v0_mps", 0.01}}), "state");
}

// An offset takes a part of a drift.
TEST(Budget, SeesTheClock) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json rate{{"rate_x_nps", 0.02}, {"rate_y_nps", 0.0}, {"rate_z_nps", 0.0}};
  const auto all = shares(one(hidden("linear_drift", nullptr, rate)));
  EXPECT_GT(all.at("clock"), 0.1);
  EXPECT_LT(all.at("state"), 0.05);
}

TEST(Budget, SeesPushes) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  Json push =
      hidden("contact", nullptr, {{"force_x_n", 0.5}, {"force_y_n", 0.4}, {"force_z_n", 0.0}});
  push["interval_s"] = {6.0, 9.0};
  EXPECT_EQ(largest(shares(one(push))), "event");
}

// A cable with 0.3 rad of slack: neither the angle nor the rate tells its force.
TEST(Budget, SeesWhereTheMotionCameFrom) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json cable{{"force_n", 0.3}, {"width_rad", 0.3}, {"asym", 0.4}};
  EXPECT_GT(shares(one(hidden("hysteresis", "alpha:sensor_x", cable))).at("memory"), 0.1);
}

}  // namespace
}  // namespace dcnn
