// SPDX-License-Identifier: Apache-2.0
// What counts as right of an axis: aliases, what the log itself does, laws without a name,
// confidence.
#include <gtest/gtest.h>

#include "conceal/tally.h"
#include "dcnn/conceal/challenge.h"

namespace dcnn::conceal {
namespace {

Json axis_answer(const char* group, const std::vector<Json>& hidden) {
  return {{"id", "s0001"},       {"drawn", "x"},
          {"group", group},      {"family", "axis"},
          {"motion", "tones"},   {"noise", {{"kind", "white"}}},
          {"hidden", hidden},    {"optional", {"time_delay"}},
          {"oracle_rmse", {1.0}}};
}

Json axis_hidden(const char* effect, bool listed) {
  return {{"effect", effect}, {"axis", "motor"},     {"interval_s", nullptr},
          {"listed", listed}, {"foreign", false},    {"amplitude", 3.0},
          {"class", "scale"}, {"aliases", {"gain"}}, {"parameters", Json::object()}};
}

Json axis_report(const char* verdict, double after, const std::vector<Json>& findings) {
  return {{"verdict", verdict},
          {"findings", findings},
          {"fit", {{"holdout_rmse_before", {5.0}}, {"holdout_rmse_after", {after}}}}};
}

Json axis_finding(const char* effect, double confidence) {
  return {{"effect", effect},
          {"axis", "motor"},
          {"interval_s", nullptr},
          {"confidence", confidence},
          {"alternatives", Json::array()},
          {"parameters", Json::object()}};
}

TEST(AxisScore, AnAliasIsTheNameAndWhatTheLogDoesIsNoFalseName) {
  const Json s = score(
      axis_answer("single", {axis_hidden("inertia", true)}),
      axis_report("explained", 1.0, {axis_finding("time_delay", 0.9), axis_finding("gain", 0.8)}));
  EXPECT_TRUE(s["set"] && s["top1"] && s["effects"][0]["named"]);
  EXPECT_EQ(s["false_names"], 0);
  EXPECT_EQ(s["confidences"].size(), 1U);
  EXPECT_TRUE(
      score(axis_answer("null", {}),
            axis_report("explained", 1.0, {axis_finding("time_delay", 0.9)}))["verdict_right"]
          .get<bool>());
  EXPECT_EQ(score(axis_answer("null", {}),
                  axis_report("explained", 1.0, {axis_finding("gain", 0.9)}))["false_names"],
            1);
}

TEST(AxisScore, AnUnlistedLawIsRightUnnamedOrPredicted) {
  const Json answer = axis_answer("unlisted", {axis_hidden("belt_slip", false)});
  Json law = axis_finding("discovered", 0.8);
  law["law"] = {{"established", true}};
  const auto right = [&](const char* verdict, double after, const std::vector<Json>& findings) {
    return score(answer, axis_report(verdict, after, findings))["verdict_right"].get<bool>();
  };
  EXPECT_TRUE(right("unexplained", 3.0, {}));
  EXPECT_TRUE(right("explained", 1.04, {law}));
  EXPECT_FALSE(right("explained", 1.5, {law}));
  EXPECT_FALSE(right("explained", 1.0, {axis_finding("gain", 0.9)}));
  EXPECT_FALSE(right("consistent", 1.0, {}));
}

TEST(Tally, ConfidencesAreHeldAgainstWhatWasRight) {
  Json scenarios = Json::array();
  for (int k = 0; k < 4; ++k) {
    scenarios.push_back({{"confidences", {{{"said", 0.9}, {"right", k > 0}}}}});
  }
  const Json table = confidence_table(scenarios);
  EXPECT_EQ(table["n"], 4);
  EXPECT_NEAR(table["said"].get<double>(), 0.9, 1e-12);
  EXPECT_NEAR(table["right"].get<double>(), 0.75, 1e-12);
  EXPECT_NEAR(table["brier"].get<double>(), (3 * 0.01 + 0.81) / 4.0, 1e-12);
  ASSERT_EQ(table["bins"].size(), 1U);
  EXPECT_NEAR(table["bins"][0]["from"].get<double>(), 0.85, 1e-12);
  EXPECT_TRUE(confidence_table(Json::array()).is_null());
}

}  // namespace
}  // namespace dcnn::conceal
