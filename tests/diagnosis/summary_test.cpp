// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dcnn/diagnosis/diagnose.h"

namespace dcnn {
namespace {

Json finding_of(const char* words, double gain) {
  return {{"effect", "contact"},
          {"axis", nullptr},
          {"parameters", Json::object()},
          {"words", words},
          {"holdout_gain", gain}};
}

/// Of a tool whose fx and fy are measured and simulated.
Json summary_report(const Json& findings) {
  return {{"targets", {"fx", "fy"}},
          {"units", {"N", "N"}},
          {"verdict", "explained"},
          {"findings", findings},
          {"unnamed", {{"words", nullptr}}},
          {"fit",
           {{"holdout_rmse_before", {1.0, 0.5}},
            {"holdout_rmse_after", {0.04, 0.5}},
            {"holdout_rms_measured", {2.0, 2.0}},
            {"holdout_explained_before", {0.75, 0.9}},
            {"noise_floor", {0.039, 0.49}}}}};
}

TEST(Headline, BeginsWithWhatTheHeldOutErrorTellsOf) {
  const Json report = summary_report(
      Json::array({finding_of("a contact of 3 N", 0.0), finding_of("dry friction of 0.4 N", 0.9)}));
  EXPECT_EQ(headline(report),
            "Dry friction of 0.4 N. The hold-out error of fx falls from 1 to 0.04 N; the sensor's "
            "noise is 0.039 N. In the fitted recordings, without effect on the held-out error: a "
            "contact of 3 N.");
}

TEST(Headline, SaysThatAllItNamesIsWithoutEffectOnTheHeldOutError) {
  const Json report = summary_report(Json::array({finding_of("a contact of 3 N", 0.004)}));
  EXPECT_TRUE(headline(report).starts_with(
      "A contact of 3 N, without effect on the held-out error. The hold-out error of fx"))
      << headline(report);
}

// One that explains less than what has no name, or that a channel speaks against.
TEST(Headline, SaysWhatIsNotEstablishedApart) {
  Json hum = finding_of("a hum of 0.5 N at 0.7 Hz", 0.02),
       friction = finding_of("dry friction of 0.4 N", 0.9);
  hum["confidence"] = 0.2;
  hum["shared_with"] = {{"cogging", 0.1}};
  friction["confidence"] = 0.3;
  friction["shared_with"] = {{"lugre_friction", 0.4}};
  const std::string both = headline(summary_report({hum, friction}));
  EXPECT_TRUE(
      both.starts_with("Either dry friction of 0.4 N (30 %) or friction with elastic presliding "
                       "(40 %), which these recordings "
                       "do not tell apart. The hold-out error of fx"))
      << both;
  EXPECT_TRUE(
      both.ends_with("Not established, each rather wrong than right: a hum of 0.5 N at 0.7 Hz."))
      << both;
  const std::string alone = headline(summary_report(Json::array({hum})));
  EXPECT_TRUE(
      alone.starts_with("Nothing that was found is established, each rather wrong than right: a "
                        "hum of 0.5 N at 0.7 Hz. The hold-out"))
      << alone;
}

TEST(Headline, SaysWhatIsBetterThanAllThatWasFound) {
  Json report = summary_report(Json::array({finding_of("dry friction of 0.4 N", 0.9)}));
  report["fit"]["holdout_rmse_after"] = {0.04, 0.45};
  report["fit"]["holdout_rmse_parameters"] = {0.9, 0.42};
  EXPECT_TRUE(headline(report).ends_with(
      "The simulator with its parameters refitted leaves less: 0.42 N of fy."))
      << headline(report);
  report["fit"]["holdout_rms_measured"] = {2.0, 0.3};
  EXPECT_NE(headline(report).find("A constant leaves less: 0.3 N of fy."), std::string::npos)
      << headline(report);
}

TEST(Headline, WhereNothingIsMissingSpeaksOfTheWorstChannel) {
  Json report = summary_report(Json::array());
  report["verdict"] = "consistent";
  report["fit"]["holdout_rmse_after"] = {0.04, 0.55};
  EXPECT_EQ(headline(report),
            "Nothing is missing: the simulator leaves 0.55 N on held-out fy; the sensor's noise is "
            "0.49 N.");
  report["fit"]["holdout_rmse_after"] = {0.08, 0.55};
  EXPECT_EQ(
      headline(report),
      "Nothing is missing: the simulator leaves 0.08 N on held-out fx; the sensor's noise is "
      "0.039 N. The noise of the measured motion, or what the fitted recordings leave as well, "
      "makes the rest.");
}

// Where the error bounds the noise, that is no knowledge of the noise.
TEST(Headline, SaysThatNoiseWhichTheErrorBoundsMayBeAllOfIt) {
  Json report = summary_report(Json::array({finding_of("dry friction of 0.4 N", 0.9)}));
  report["fit"]["noise_floor"] = {0.04, 0.5};
  EXPECT_EQ(headline(report),
            "Dry friction of 0.4 N. The hold-out error of fx falls from 1 to 0.04 N; all of it "
            "may be the sensor's noise.");
  report["unnamed"] = {{"words", "something that no effect of the catalogue explains"},
                       {"remains", {true, true}}};
  EXPECT_EQ(headline(report),
            "Dry friction of 0.4 N; and something that no effect of the catalogue explains. The "
            "hold-out error of fx falls from 1 to 0.04 N; how much of it is the sensor's noise is "
            "not known.");
}

TEST(Headline, SaysThatALawLeavesNothingElse) {
  Json report = summary_report(Json::array({finding_of("a force along the tool", 0.9)}));
  report["verdict"] = "unexplained";
  report["unnamed"] = {{"words", "no effect of the catalogue has this form"}, {"suffices", true}};
  EXPECT_TRUE(headline(report).starts_with(
      "A force along the tool; no effect of the catalogue has this form. The hold-out error"))
      << headline(report);
}

TEST(Headline, BeginsWithASimulatorThatExplainsNothing) {
  Json report = summary_report(Json::array({finding_of("dry friction of 0.4 N", 0.9)}));
  report["fit"]["holdout_explained_before"] = {-0.1, -3.0};
  EXPECT_TRUE(headline(report).starts_with(
      "The given simulator explains nothing of how fx and fy vary on held-out data: a constant "
      "errs no more. Check its units, signs, axes and clock first (dcnn-check). Dry friction"))
      << headline(report);
}

TEST(Headline, EndsWithTheTargetsThatTheSimulatorExplainsNothingOf) {
  Json report = summary_report(Json::array({finding_of("dry friction of 0.4 N", 0.9)}));
  report["fit"]["holdout_explained_before"] = {0.9, -3.0};
  EXPECT_TRUE(headline(report).starts_with("Dry friction")) << headline(report);
  EXPECT_TRUE(headline(report).ends_with(
      "The given simulator explains nothing of how fy varies on held-out data: a constant errs no "
      "more."))
      << headline(report);
  report["fit"]["holdout_rms_measured"] = {2.0, 0.7};  // what is little above the noise of 0.5 N
  EXPECT_EQ(headline(report).find("explains nothing"), std::string::npos) << headline(report);
}

}  // namespace
}  // namespace dcnn
