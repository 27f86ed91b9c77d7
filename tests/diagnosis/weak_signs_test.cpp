// SPDX-License-Identifier: Apache-2.0
// Effects whose signs are weak, bent or hidden behind a stronger one, and noise that looks like
// one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/random.h"
#include "diagnosis/noise_floor.h"
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

// A sum of first-order processes, one an octave, has a density that falls as 1/f.
TEST(WeakSigns, SlowNoiseAloneIsNothingMissing) {
  Rng rng({7u});
  const Bench bench(configuration(Json::array()));
  change(bench, [&](Recording& log) {
    for (const char* channel : {"fx", "fy", "fz"}) {
      Eigen::VectorXd force = log.column(channel);
      for (double seconds = 0.01; seconds < 20.0; seconds *= 2.0) {
        const double keep = std::exp(-0.002 / seconds);
        double x = rng.normal();
        for (Index i = 0; i < force.size(); ++i) {
          force(i) += 0.004 * x;
          x = keep * x + std::sqrt(1.0 - keep * keep) * rng.normal();
        }
      }
      log.set(channel, force);
    }
  });
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "consistent") << report["unnamed"].dump();
  EXPECT_TRUE(report["findings"].empty()) << report["findings"].dump(1);
}

TEST(WeakSigns, ALagOfAMillisecondIsALag) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json report =
      Bench(configuration(Json::array({hidden("lowpass", nullptr, {{"tau_s", 0.0011}})})))
          .diagnose()
          .report;
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  const auto name = report["findings"][0]["effect"].get<std::string>();
  EXPECT_TRUE(name == "lowpass" || name == "time_delay") << name;
}

TEST(WeakSigns, ACoggingNeedsNoWholeTurnInTheRange) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  // The angle covers about 2 rad: 0.85 of a turn.
  const Json report = Bench(configuration(Json::array(
                                {hidden("cogging", "alpha:sensor_x",
                                        {{"amp_n", 0.08}, {"order", 2.7}, {"phase_rad", 0.4}})})))
                          .diagnose()
                          .report;
  EXPECT_EQ(names(report), std::vector<std::string>{"cogging"}) << report["findings"].dump(1);
}

TEST(WeakSigns, FrictionOfARotationFallsWithItsOwnSpeeds) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json report =
      Bench(configuration(Json::array(
                {hidden("stribeck_friction", "w_sensor_x",
                        {{"fc_n", 0.04}, {"fs_n", 0.09}, {"vs_mps", 0.5}, {"v0_mps", 0.06}})})))
          .diagnose()
          .report;
  EXPECT_EQ(names(report), std::vector<std::string>{"stribeck_friction"})
      << report["findings"].dump(1);
}

// Inertial terms explain a hundred times what the others do, without a number that could be wrong.
TEST(WeakSigns, NothingHidesBehindTheInertialTerms) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  Json config =
      configuration({hidden("inertial_terms", nullptr, Json::object()),
                     hidden("linear_drift", nullptr,
                            {{"rate_x_nps", 0.001}, {"rate_y_nps", 0.0}, {"rate_z_nps", 0.002}})});
  config["simulator"]["model"] = {{"inertial", "none"}};
  config["hidden"].push_back(
      hidden("step_bias", nullptr, {{"step_x_n", 0.02}, {"step_y_n", 0.03}, {"step_z_n", -0.03}}));
  config["hidden"].back()["interval_s"] = {9.0, 45.0};
  const Json report = Bench(config).diagnose().report;
  EXPECT_EQ(found(report), (std::set<std::string>{"inertial_terms", "linear_drift", "step_bias"}))
      << report["findings"].dump(1);
}

// A spring that stiffens is no spring with a slow cogging beside it.
TEST(WeakSigns, ACurvedSpringIsNoSpringAndCogging) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(configuration(Json::array()));
  change(bench, [](Recording& log) {
    log.set("fz", log.column("fz") - (2.0 * log.column("beta").array().cube()).matrix());
  });
  const Json report = bench.diagnose().report;
  EXPECT_NE(report["verdict"], "explained") << report["findings"].dump(1);
  EXPECT_FALSE(found(report).count("cogging") && found(report).count("cable_spring"))
      << report["findings"].dump(1);
}

// A force that grows with the product of a position and an angle stands in no catalogue.
TEST(WeakSigns, WhatHasNoNameGetsALaw) {
  const Bench bench(configuration(Json::array()));
  change(bench, [](Recording& log) {
    log.set("fz", log.column("fz") + 2.0 * log.column("x").cwiseProduct(log.column("beta")));
  });
  const Diagnosis diagnosis = bench.diagnose();
  const Json& report = diagnosis.report;
  EXPECT_EQ(report["verdict"], "unexplained") << report["findings"].dump(1);
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  const Json& finding = report["findings"][0];
  EXPECT_EQ(finding["effect"], "discovered");
  EXPECT_EQ(finding["axis"], "tool_z");
  const auto formula = finding["law"]["expression"].get<std::string>();
  EXPECT_NE(formula.find("x"), std::string::npos) << formula;
  EXPECT_NE(formula.find("beta"), std::string::npos) << formula;
  EXPECT_EQ(report["unnamed"]["formula"], formula);
  EXPECT_GT(finding["holdout_gain"].get<double>(), 0.01);
  // The law is part of the model that is written, which predicts the force of the noise's size.
  EXPECT_LT(report["fit"]["holdout_rmse_after"][2].get<double>(), 0.042);
  const Simulator again = parse_simulator(diagnosis.model, "model.json", Exit::kModel);
  ASSERT_EQ(again.effects.size(), 1U);
  const Recording held = read_recording(bench / "hold.csv", ReadOptions(), System());
  const Recording predicted = predict_motion(again, held, DerivativeSpec());
  EXPECT_LT((predicted.column("fz") - diagnosis.holdout[0].after.col(2)).cwiseAbs().maxCoeff(),
            1e-6);
}

// |1 + fraction (H - 1)|^2 at the mode, where H = 1/(2 zeta i).
TEST(WeakSigns, UnseenMotionRingsInAMode) {
  Floor floor;
  floor.static_part = 2e-6;
  floor.pose_gain = {1.0};
  const double plain = floor.pose_density(7.0);
  floor.modes = {{7.0, 0.02, 0.8}};
  const double real = 0.2, imaginary = 0.8 / 0.04;
  EXPECT_NEAR(floor.pose_density(7.0) / plain, real * real + imaginary * imaginary, 1e-9);
  EXPECT_NEAR(floor.pose_density(0.01) / floor.static_part, 1.0, 1e-4);
}

// A slug of 4 g: each of its knocks is within the noise.
TEST(WeakSigns, KnocksThatAreFaintOneByOneAreHeardTogether) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json report =
      Bench(configuration(Json::array(
                {hidden("loose_load", "sensor_x", {{"slug_kg", 0.004}, {"gap_m", 0.005}})})))
          .diagnose()
          .report;
  ASSERT_EQ(names(report), std::vector<std::string>{"loose_load"}) << report["findings"].dump(1);
  EXPECT_EQ(report["findings"][0]["axis"], "sensor_x");
  const Json& found = report["findings"][0]["parameters"];
  EXPECT_NEAR(found["slug_kg"]["value"].get<double>(), 0.004, 0.0008);
  EXPECT_NEAR(found["gap_m"]["value"].get<double>(), 0.005, 0.001);
}

// In no channel does the line stand out of 10,000 samples of noise.
TEST(WeakSigns, AHumFaintInEachChannelIsHeardInAllTogether) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const auto report = [](double amplitude) {
    const Bench bench(configuration(Json::array()));
    change(bench, [&](Recording& log) {
      const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * 7.3 * log.column("t").array();
      for (const char* channel : {"fx", "fy", "fz"}) {
        log.set(channel, log.column(channel) + (amplitude * angle.sin()).matrix());
      }
    });
    return bench.diagnose().report;
  };
  const Json heard = report(0.0032);
  ASSERT_EQ(names(heard), std::vector<std::string>{"hum"}) << heard["findings"].dump(1);
  EXPECT_NEAR(heard["findings"][0]["parameters"]["freq_hz"]["value"].get<double>(), 7.3, 0.01);
  EXPECT_EQ(report(0.001)["verdict"], "consistent");
}

// Both forms of a thermal drift were seeded once, and the one that follows the clock hid the other.
TEST(WeakSigns, AnOffsetFollowsATemperatureThatHardlyBends) {
  const Bench bench(configuration(Json::array()));
  Rng rng({9u});
  change(bench, [&](Recording& log) {
    const Eigen::ArrayXd t = log.column("t").array();
    Eigen::VectorXd temperature = 20.6 + 3.2 * (1.0 - (-t / 25.0).exp());
    const Eigen::VectorXd drift = (temperature.array() - 21.4) * 0.05;
    for (double& x : temperature) x += 0.01 * rng.normal();
    log.set("temperature", temperature);
    log.set("fy", log.column("fy") + drift);
  });
  const Json report = bench.diagnose().report;
  ASSERT_EQ(names(report), std::vector<std::string>{"thermal_drift"}) << report["findings"].dump(1);
  const Json& found = report["findings"][0]["parameters"];
  ASSERT_TRUE(found.contains("t_ref_degc")) << found.dump(1);
  EXPECT_NEAR(found["k_y_npk"]["value"].get<double>(), 0.05, 0.004);
}

// Teeth of a joint that repeat within 6 degrees of it.
TEST(WeakSigns, OfTeethOfAHighOrderAreSeen) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(test::configuration(Json::array({hidden(
      "cogging", "beta:sensor_x", {{"amp_n", 0.03}, {"order", 60.0}, {"phase_rad", 0.4}})})));
  const Json report = bench.diagnose().report;
  ASSERT_EQ(names(report), std::vector<std::string>{"cogging"}) << report["findings"].dump(1);
  EXPECT_NEAR(report["findings"][0]["parameters"]["order"]["value"].get<double>(), 60.0, 0.3);
}

}  // namespace
}  // namespace dcnn
