// SPDX-License-Identifier: Apache-2.0
#include "dcnn/design/design.h"

#include <gtest/gtest.h>

#include <cmath>

#include "design/decision.h"
#include "design/proposals.h"
#include "design/separation.h"
#include "support/design.h"

namespace dcnn::design {
namespace {

TEST(Design, SeparatesTwoFrictionsFartherThanArbitraryMotionsDo) {
  const DesignRequest request = test::friction_request();
  const Question question = question_of(request.report, request.model, "report.json");
  const Predictor predictor(question, 100.0);
  Rng rng({3});
  double mean = 0.0;
  constexpr int kMotions = 20;
  for (int k = 0; k < kMotions; ++k) {
    const Spline s =
        within(draw_spline(request.limits, request.seconds, rng), request.limits, 100.0);
    const Motion m = play(s, request.limits, question.tool, 100.0, 0.0).motion;
    mean += std::sqrt(separation(predictor.predict(0, m), predictor.predict(1, m))) / kMotions;
  }
  const Design design = make_design(request, {});
  ASSERT_EQ(design.verdicts.size(), 2U);
  EXPECT_GT(design.verdicts[0].separation, 1.3 * mean);
  EXPECT_LE(design.greatest_use, 1.0);
  ASSERT_TRUE(design.probability.has_value());
  EXPECT_GT(*design.probability, 0.5);
}

TEST(Design, SameSeedSameMotion) {
  DesignRequest request = test::friction_request();
  request.evaluations = 10;
  const Design a = make_design(request, {}), b = make_design(request, {});
  EXPECT_EQ(a.motion.values, b.motion.values);
  EXPECT_EQ(a.words, b.words);
  request.seed = 2;
  EXPECT_NE(a.motion.values, make_design(request, {}).motion.values);
}

TEST(Design, NextMotionNamesThePairAndSaysHowProbableADecisionIs) {
  DesignRequest request = test::friction_request();
  request.evaluations = 5;
  const Design design = make_design(request, {});
  const Json next = next_motion(design, request.seconds);
  EXPECT_EQ(next["separates"][0].get<std::string>(), "coulomb_friction");
  EXPECT_EQ(next["separates"][1].get<std::string>(), "viscous_friction");
  EXPECT_EQ(next["probability"].get<double>(), *design.probability);
  EXPECT_NE(next["words"].get<std::string>().find("reversals"), std::string::npos);
  request.report["rivals"] = Json::array();
  EXPECT_TRUE(
      next_motion(make_design(request, {}), 10.0).is_null());  // nothing is left to be decided
}

TEST(Design, SaysWhereNoMotionDecides) {
  DesignRequest request = test::friction_request();
  request.evaluations = 5;
  request.report["fit"]["noise_floor"] = {2e6, 2e6, 2e6};
  const Design design = make_design(request, {});
  const std::string all = design.words + to_text(design);
  EXPECT_NE(all.find("no motion that was tried within these limits tells dry friction from"),
            std::string::npos)
      << all;
  EXPECT_EQ(all.find("e-"), std::string::npos) << all;
}

TEST(Design, LeavesOutWhatTheNextRecordingCannotHold) {
  DesignRequest request = test::friction_request();
  Json contact = test::effect_json("contact", "",
                                   {{"force_x_n", 1.0}, {"force_y_n", 0.0}, {"force_z_n", 0.0}});
  contact["axis"] = nullptr;
  contact["interval_s"] = {3.0, 5.0};
  Json drift = test::effect_json(
      "thermal_drift", "",
      {{"k_x_npk", 0.1}, {"k_y_npk", 0.0}, {"k_z_npk", 0.0}, {"t_ref_degc", 20.0}});
  drift["axis"] = nullptr;
  request.model["effects"].push_back(contact);
  request.model["effects"].push_back(drift);
  const Question question = question_of(request.report, request.model, "report.json");
  EXPECT_EQ(question.hypotheses[0].effects.size(), 1U);
  EXPECT_NEAR(question.hypotheses[0].mass + question.hypotheses[1].mass + question.unknown, 1.0,
              1e-12);
}

TEST(Design, RefusesReportsOfOtherMachinesAndOlderOnes) {
  DesignRequest request = test::friction_request();
  request.report["targets"] = Json::array({Json("tau1")});
  EXPECT_THROW(make_design(request, {}), Error);
  request = test::friction_request();
  request.report.erase("rivals");
  EXPECT_THROW(make_design(request, {}), Error);
}

TEST(DesignSeparation, IsWhatARefittedRivalLeaves) {
  const DesignRequest request = test::friction_request();
  const Question question = question_of(request.report, request.model, "report.json");
  const Predictor predictor(question, 100.0);
  Rng rng({4});
  const Spline s = within(draw_spline(request.limits, 10.0, rng), request.limits, 100.0);
  const Motion m = play(s, request.limits, question.tool, 100.0, 0.0).motion;
  const Prediction dry = predictor.predict(0, m), viscous = predictor.predict(1, m);
  // Viscous friction is linear in its number: projecting is fitting.
  const double fitted = predictor.fitted_square(1, m, dry.force);
  EXPECT_NEAR(separation(dry, viscous), fitted, 1e-4 * fitted);
  EXPECT_GT(fitted, 1.0);
  // Dry friction can spread its turning point until it is viscous: fitting its width leaves less
  // than a line does.
  EXPECT_LT(predictor.fitted_square(0, m, viscous.force), 0.5 * separation(viscous, dry));
  EXPECT_EQ(separation(dry, dry), 0.0);
}

TEST(DesignDecision, ProbabilityIsTheShareOfSimulatedRecordingsThatDecide) {
  DesignRequest request = test::friction_request();
  request.report["fit"]["noise_floor"] = {0.2, 0.2, 0.2};
  const Question question = question_of(request.report, request.model, "report.json");
  constexpr double kHz = 50.0;
  const Predictor predictor(question, kHz);
  Rng rng({5});
  const Spline s = within(draw_spline(request.limits, 6.0, rng), request.limits, kHz);
  const Motion m = play(s, request.limits, question.tool, kHz, 0.0).motion;
  const Prediction dry = predictor.predict(0, m), viscous = predictor.predict(1, m);
  const double square = predictor.fitted_square(1, m, dry.force),
               shared = shared_dimension(dry, viscous);
  const Contest contest{square, static_cast<double>(dimension(dry)) - shared,
                        static_cast<double>(dimension(viscous)) - shared};
  // At thresholds below, at and above the mean the share of simulated recordings is the
  // probability.
  constexpr int kRecordings = 300;
  std::vector<double> differences;
  for (int k = 0; k < kRecordings; ++k) {
    Eigen::VectorXd y = dry.force;
    for (double& value : y) value += rng.normal();
    differences.push_back(predictor.fitted_square(1, m, y) - predictor.fitted_square(0, m, y));
  }
  for (const double shift : {-1.0, 0.0, 1.0}) {
    const double threshold = square + 2.0 * shift * std::sqrt(square);
    const double p = probability_above(contest, threshold);
    double share = 0.0;
    for (const double d : differences) share += d > threshold ? 1.0 / kRecordings : 0.0;
    EXPECT_GT(threshold, 0.0);
    EXPECT_NEAR(share, p, 3.5 * std::sqrt(p * (1.0 - p) / kRecordings) + 0.005) << shift;
  }
}

TEST(DesignDecision, ProbabilityIsThatOfDrawnChiSquares) {
  Rng rng({6});
  for (const Contest& c : {Contest{0.0, 2.0, 0.0}, Contest{9.0, 1.0, 0.0}, Contest{16.0, 1.0, 2.0},
                           Contest{0.0, 0.0, 3.0}}) {
    constexpr int kDraws = 20000;
    for (const double threshold : {-5.0, 2.0, 6.0, 20.0}) {
      double share = 0.0;
      for (int k = 0; k < kDraws; ++k) {
        double difference = 0.0;
        for (int i = 0; i < static_cast<int>(c.own); ++i) {
          const double z = rng.normal() + (i == 0 ? std::sqrt(c.separation) : 0.0);
          difference += z * z;
        }
        for (int i = 0; i < static_cast<int>(c.rival); ++i) {
          const double z = rng.normal();
          difference -= z * z;
        }
        share += difference > threshold ? 1.0 / kDraws : 0.0;
      }
      EXPECT_NEAR(probability_above(c, threshold), share, 0.015)
          << c.separation << " " << c.own << " " << threshold;
    }
  }
}

TEST(DesignDecision, ThresholdIsTheRuleOfTheDiagnosis) {
  EXPECT_EQ(exclusion_threshold(0), 12.0);   // listed within 12 of chi-square
  EXPECT_EQ(exclusion_threshold(-1), 22.0);  // and 10 for each number that it saves
  EXPECT_EQ(exclusion_threshold(2), -10.0);  // or where each further number gains half of its price
}

}  // namespace
}  // namespace dcnn::design
