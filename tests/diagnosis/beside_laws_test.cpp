// SPDX-License-Identifier: Apache-2.0
// Names and laws without a name, together; and names that held-out data refute.
#include <gtest/gtest.h>

#include "diagnosis/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::Bench;
using test::hidden;

Json slow_case(const Json& effects) { return test::at_half_rate(test::configuration(effects)); }

/// A law of the speed along the tool: shape "peaked" is that of an eddy-current brake, u/(1 + u^2).
Json drag(const char* shape, const Json& parameters) {
  Json effect = hidden("discovered", nullptr, parameters);
  effect["law"] = {{"axis", "tool_z"}, {"factors", {{{"shape", shape}, {"of", "v_tool_z"}}}}};
  return effect;
}

TEST(BesideLaws, AListedEffectKeepsItsName) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(slow_case(
      {drag("peaked", {{"amplitude_n", -4.0}, {"scale_1_mps", 0.06}}),
       hidden("com", nullptr,
              {{"delta_com_x_m", 0.02}, {"delta_com_y_m", 0.0}, {"delta_com_z_m", 0.03}})}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(test::names(report), std::vector<std::string>{"com"}) << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "partly-explained");
  EXPECT_EQ(report["findings"].back()["effect"], "discovered");
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_LT(report["fit"]["holdout_rmse_after"][j].get<double>(),
              1.05 * report["fit"]["noise_floor"][j].get<double>());
  }
}

// Both are laws to the discoverer; one of them has a name.
TEST(BesideLaws, AnEffectWithANameIsNoSecondLaw) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  Json guide = hidden("discovered", nullptr,
                      {{"amplitude_n", -1.0}, {"scale_1_mps", 0.08}, {"scale_2_m", 0.1}});
  guide["law"] = {
      {"axis", "base_x"},
      {"factors", {{{"shape", "linear"}, {"of", "v_base_x"}}, {{"shape", "linear"}, {"of", "y"}}}}};
  const Bench bench(slow_case(
      {guide, hidden("cable_spring", "gamma:base_y", {{"k_nprad", 1.2}, {"rest_rad", 3.2}})}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(test::names(report), std::vector<std::string>{"cable_spring"})
      << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "partly-explained");
  ASSERT_EQ(report["findings"].size(), 2u);
  EXPECT_EQ(report["findings"][1]["axis"], "base_x");
  EXPECT_LT(report["findings"][0]["confidence"].get<double>(), 0.8);  // another form may hold it
}

// An eddy-current brake fades as Stribeck's curve does, whose four numbers the brake's two outdo.
TEST(BesideLaws, ALawOfFewerNumbersTakesThePlaceOfOneName) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(
      slow_case(Json::array({drag("peaked", {{"amplitude_n", -0.7}, {"scale_1_mps", 0.05}})})));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "unexplained") << report["findings"].dump(1);
  ASSERT_EQ(report["findings"].size(), 1u);
  const Json& law = report["findings"][0];
  ASSERT_EQ(law["effect"], "discovered");
  EXPECT_NEAR(law["parameters"]["scale_1_mps"]["value"].get<double>(), 0.05, 0.01);
}

// What the catalogue lacks is a formula, be it only that its name was left out.
TEST(BesideLaws, AnEffectLeftOutOfTheCatalogueIsFoundAsAFormula) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(
      slow_case(Json::array({hidden("quadratic_drag", "tool_z", {{"c2_ns2pm2", 3.0}})})));
  DiagnosisRequest request = bench.request();
  request.without = ablation_of({"quadratic_drag"});
  const Json report = diagnose(request, nullptr).report;
  EXPECT_EQ(report["without"], Json::array({"quadratic_drag"}));
  ASSERT_EQ(report["findings"].size(), 1u) << report["findings"].dump(1);
  const Json& law = report["findings"][0];
  ASSERT_EQ(law["effect"], "discovered");
  EXPECT_EQ(law["axis"], "tool_z");
  EXPECT_NEAR(law["parameters"]["power_1"]["value"].get<double>(), 2.0, 0.1);
  EXPECT_THROW(ablation_of({"quadratic_drags"}), Error);
}

// The 1.5th power of the speed lies between a viscous friction and a drag that grows as its square.
TEST(BesideLaws, OneLawTakesThePlaceOfTwoNamesThatImitateIt) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(slow_case(Json::array(
      {drag("power", {{"amplitude_n", -3.0}, {"scale_1_mps", 0.1}, {"power_1", 1.5}})})));
  const Json report = bench.diagnose().report;
  EXPECT_TRUE(test::names(report).empty()) << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "unexplained");
  ASSERT_FALSE(report["findings"].empty());
  EXPECT_NEAR(report["findings"][0]["parameters"]["power_1"]["value"].get<double>(), 1.5, 0.05);
}

TEST(BesideLaws, TwoNamesThatActStayTwo) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(
      slow_case({hidden("coulomb_friction", "tool_z", {{"fc_n", 0.5}, {"v0_mps", 0.01}}),
                 hidden("viscous_friction", "tool_z", {{"c_nspm", 6.0}})}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(test::found(report), (std::set<std::string>{"coulomb_friction", "viscous_friction"}));
  EXPECT_EQ(report["verdict"], "explained");
  EXPECT_TRUE(report["refuted"].empty());
}

/// The held-out error over the noise, in the worst channel.
double worst_ratio(const Json& report) {
  double worst = 0.0;
  for (std::size_t j = 0; j < 3; ++j) {
    worst = std::max(worst, report["fit"]["holdout_rmse_after"][j].get<double>() /
                                report["fit"]["noise_floor"][j].get<double>());
  }
  return worst;
}

// A search among names alone finds names that imitate the law, refutes them and removes all.
TEST(BesideLaws, ADriftIsFoundBesideADragOfOneDirection) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  Json drag = hidden("discovered", nullptr,
                     {{"amplitude_n", -2.5}, {"scale_1_mps", 0.1}, {"ratio_1", 0.0}});
  drag["law"] = {{"axis", "base_z"}, {"factors", {{{"shape", "asymmetric"}, {"of", "v_base_z"}}}}};
  const Bench bench(slow_case(
      {drag, hidden("linear_drift", nullptr,
                    {{"rate_x_nps", 0.0}, {"rate_y_nps", 0.004}, {"rate_z_nps", -0.03}})}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(test::names(report), std::vector<std::string>{"linear_drift"})
      << report["findings"].dump(1);
  ASSERT_EQ(report["findings"].size(), 2u);
  EXPECT_EQ(report["findings"][1]["axis"], "base_z");
  EXPECT_LT(worst_ratio(report), 1.05);
}

// c n (n·v), with n no axis of any frame, is one law and no sum of three; what a scale of the
// sensor does beside it is no mass.
TEST(BesideLaws, AScaleIsFoundBesideAnObliqueDrag) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  Json drag =
      hidden("discovered", nullptr,
             {{"amplitude_n", -0.6}, {"axis_x", 0.12}, {"axis_y", 0.07}, {"scale_1_mps", 0.05}});
  drag["law"] = {{"axis", "tool_z"},
                 {"oblique", true},
                 {"factors", {{{"shape", "linear"}, {"of", "v_along"}}}}};
  const Bench bench(test::configuration(
      {hidden("gain", nullptr, {{"gain_x", 0.03}, {"gain_y", 0.0}, {"gain_z", 0.05}}), drag}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(test::names(report), std::vector<std::string>{"gain"}) << report["findings"].dump(1);
  ASSERT_EQ(report["findings"].size(), 2u);
  EXPECT_NEAR(report["findings"][1]["parameters"]["axis_x"]["value"].get<double>(), 0.12, 0.01);
  EXPECT_LT(worst_ratio(report), 1.05);
}

// The size of a law is fitted with the names beside it: a mass would else make up for it.
TEST(BesideLaws, AScaleBesideALawComesWithoutAMass) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(test::configuration(
      {hidden("gain", nullptr, {{"gain_x", 0.03}, {"gain_y", 0.0}, {"gain_z", 0.05}}),
       drag("asymmetric", {{"amplitude_n", -0.8}, {"scale_1_mps", 0.1}, {"ratio_1", 0.0}})}));
  const Json report = bench.diagnose().report;
  EXPECT_FALSE(test::found(report).count("mass")) << report["findings"].dump(1);
  EXPECT_TRUE(test::found(report).count("gain"));
  EXPECT_LT(worst_ratio(report), 1.05);
}

// A scale of all axes and a mass make the same force: that three scales are one is a tenth as
// likely.
TEST(SharedConfidence, IsThatOfAliases) {
  const Bench bench(slow_case(Json::array(
      {hidden("gain", nullptr, {{"gain_x", 0.03}, {"gain_y", 0.03}, {"gain_z", 0.03}})})));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "explained");
  ASSERT_EQ(test::names(report), std::vector<std::string>{"mass"}) << report["findings"].dump(1);
  const Json& mass = report["findings"][0];
  EXPECT_EQ(mass["alternatives"], Json::array({"gain"}));
  EXPECT_NEAR(mass["confidence"].get<double>(), 0.9, 0.05);
  EXPECT_NEAR(mass["shared_with"]["gain"].get<double>(), 0.1, 0.05);
}

// Scales that differ are no mass.
TEST(SharedConfidence, IsWholeWhereTheRecordingsDecide) {
  const Bench bench(slow_case(Json::array(
      {hidden("gain", nullptr, {{"gain_x", 0.03}, {"gain_y", -0.03}, {"gain_z", 0.02}})})));
  const Json report = bench.diagnose().report;
  ASSERT_EQ(test::names(report), std::vector<std::string>{"gain"}) << report["findings"].dump(1);
  EXPECT_GT(report["findings"][0]["confidence"].get<double>(), 0.95);
  EXPECT_FALSE(report["findings"][0].contains("shared_with"));
}

TEST(HeldOutData, TakeBackWhatTheyRefute) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json friction = Json::array({hidden("viscous_friction", "tool_z", {{"c_nspm", 4.0}})});
  const Bench with(slow_case(friction)), without(slow_case(Json::array()));
  DiagnosisRequest request = with.request();
  request.holdout = {without / "hold.csv"};
  const Json report = diagnose(request, nullptr).report;
  EXPECT_TRUE(report["findings"].empty()) << report["findings"].dump(1);
  // The name, and a formula for the same force where one was found in its place.
  ASSERT_FALSE(report["refuted"].empty());
  EXPECT_EQ(report["refuted"][0]["effect"], "viscous_friction");
  for (const Json& law : report["refuted"]) EXPECT_LT(law["confidence"].get<double>(), 0.5);
  EXPECT_EQ(report["verdict"], "unexplained");
}

}  // namespace
}  // namespace dcnn
