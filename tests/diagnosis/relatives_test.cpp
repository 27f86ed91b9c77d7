// SPDX-License-Identifier: Apache-2.0
// Laws that look like a listed one without being it, and listed ones where something else is loud.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "dcnn/data/rotation.h"
#include "diagnosis/load.h"
#include "diagnosis/support.h"
#include "diagnosis/whitener.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::Bench;
using test::change;
using test::configuration;
using test::found;
using test::frictions_along_base;
using test::hidden;
using test::names;

/// Rate of a column, by differences.
Eigen::VectorXd rate(const Eigen::VectorXd& x) {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(x.size());
  for (Index i = 5; i + 5 < x.size(); ++i) v(i) = (x(i + 5) - x(i - 5)) / 0.02;
  return v;
}

TEST(Relatives, FrictionThatGrowsWithTheLoadIsNotDry) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(configuration(Json::array()));
  change(bench, [](Recording& log) {
    const Eigen::VectorXd v = rate(log.column("x"));
    const Eigen::ArrayXd load = 0.7 + 0.3 * (log.column("fz") / 7.4).array().abs();
    log.set("fx", log.column("fx") - (0.15 * (v.array() / 0.05).tanh() * load).matrix());
  });
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "unexplained") << report["findings"].dump(1);
  EXPECT_TRUE(names(report).empty()) << report["findings"].dump(1);
}

TEST(Relatives, ASpringThatStiffensIsNotLinear) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(configuration(Json::array()));
  change(bench, [](Recording& log) {
    const Eigen::ArrayXd q = log.column("alpha").array();
    log.set("fx", log.column("fx") - (0.1 * q + 0.05 * q.cube()).matrix());
  });
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "unexplained") << report["findings"].dump(1);
  EXPECT_EQ(found(report).count("cable_spring"), 0U) << report["findings"].dump(1);
}

TEST(Relatives, AnOffsetThatGrowsWithTheTimeIsADrift) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json rate{{"rate_x_nps", 0.01}, {"rate_y_nps", 0.0}, {"rate_z_nps", -0.01}};
  const Json report =
      Bench(configuration(Json::array({hidden("linear_drift", nullptr, rate)}))).diagnose().report;
  EXPECT_EQ(names(report), std::vector<std::string>{"linear_drift"}) << report["findings"].dump(1);
}

// More laws than any other search may add, and an offset that wanders as no drift does.
TEST(Relatives, FrictionInEveryDirectionIsNamedBesideAWanderingOffset) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(configuration(frictions_along_base()));
  change(bench, [](Recording& log) {
    const Eigen::ArrayXd t = log.column("t").array();
    const Eigen::ArrayXd wander = (0.9 * t).sin() + (0.37 * t + 1.0).sin() * (0.11 * t).cos();
    log.set("fx", log.column("fx") + (0.012 * wander).matrix());
  });
  const Json report = bench.diagnose().report;
  std::set<std::string> where;
  for (const Json& f : report["findings"]) {
    where.insert(f["effect"].get<std::string>() + " " +
                 (f["axis"].is_string() ? f["axis"].get<std::string>() : ""));
  }
  for (const char* axis : {"base_x", "base_y", "base_z"}) {
    EXPECT_EQ(where.count(std::string("coulomb_friction ") + axis), 1U)
        << report["findings"].dump(1);
    EXPECT_EQ(where.count(std::string("viscous_friction ") + axis), 1U)
        << report["findings"].dump(1);
  }
}

// The recordings begin in the midst of the motion, where nobody knows how the cable is bent.
TEST(Relatives, AHysteresisMayBeginAnyhow) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(configuration(Json::array({hidden(
      "hysteresis", "alpha:sensor_x", {{"force_n", 0.4}, {"width_rad", 0.5}, {"asym", 0.4}})})));
  change(bench, [](Recording& log) {
    const Index rows = log.table.values.rows();
    log.table.values = log.table.values.bottomRows(rows - rows / 5).eval();
  });
  const Json report = bench.diagnose().report;
  ASSERT_EQ(names(report), std::vector<std::string>{"hysteresis"}) << report["findings"].dump(1);
  const Json& found = report["findings"][0]["parameters"];
  EXPECT_NEAR(found["width_rad"]["value"].get<double>(), 0.5, 0.015);
  EXPECT_NEAR(found["force_n"]["value"].get<double>(), 0.4, 0.012);
}

// The weight was hung on the sensor when the recording began: what has yet to settle is neither a
// drift nor an offset.
TEST(Relatives, ACreepMayBeginAnyhow) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(
      configuration(Json::array({hidden("creep", nullptr, {{"a", 0.05}, {"tau_s", 4.0}})})));
  change(bench, [](Recording& log) {
    const Eigen::VectorXd t = log.column("t");
    for (const char* name : {"fx", "fy", "fz"}) {
      const double load = log.column(name).head(20).mean() / 1.05;
      const Eigen::ArrayXd late = 0.05 * load * (-(t.array() - t(0)) / 4.0).exp();
      log.set(name, log.column(name) - late.matrix());
    }
  });
  const Json report = bench.diagnose().report;
  ASSERT_EQ(names(report), std::vector<std::string>{"creep"}) << report["findings"].dump(1);
  EXPECT_NEAR(report["findings"][0]["parameters"]["a"]["value"].get<double>(), 0.05, 0.002);
  EXPECT_NEAR(report["findings"][0]["parameters"]["tau_s"]["value"].get<double>(), 4.0, 0.3);
}

// A tanh that does not turn within the motion is no dry friction.
TEST(Relatives, FrictionThatGrowsFasterThanTheSpeedIsNotDry) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(configuration(Json::array()));
  change(bench, [](Recording& log) {
    const Eigen::VectorXd v = rate(log.column("x"));
    Eigen::MatrixXd F(v.size(), 3);
    F << log.column("fx"), log.column("fy"), log.column("fz");
    for (Index i = 0; i < v.size(); ++i) {
      const Eigen::Matrix3d R = rotation_from_euler(
          {log.column("alpha")(i), log.column("beta")(i), log.column("gamma")(i)});
      F.row(i) -= std::copysign(2.0 * std::pow(std::abs(v(i)), 1.5), v(i)) * R.row(0);
    }
    log.set("fx", F.col(0)), log.set("fy", F.col(1)), log.set("fz", F.col(2));
  });
  const Json report = bench.diagnose().report;
  EXPECT_EQ(found(report).count("coulomb_friction"), 0U) << report["findings"].dump(1);
  EXPECT_NE(report["verdict"], "consistent");
}

// How a cable is bent at first shows in the first piece of a recording alone: the pieces that judge
// the laws beside it know nothing of it.
TEST(Relatives, LawsBesideAHysteresisAreKept) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Json step{{"effect", "step_bias"},
                  {"interval_s", {9.0, 45.0}},
                  {"parameters", {{"step_x_n", 0.06}, {"step_y_n", -0.09}, {"step_z_n", 0.0}}}};
  const Bench bench(
      configuration(Json::array({hidden("hysteresis", "beta:sensor_z",
                                        {{"force_n", 0.1}, {"width_rad", 0.12}, {"asym", 0.5}}),
                                 hidden("quadratic_drag", "tool_z", {{"c2_ns2pm2", 3.0}}), step})));
  const Json report = bench.diagnose().report;
  const std::set<std::string> wanted{"hysteresis", "quadratic_drag", "step_bias"};
  EXPECT_EQ(found(report), wanted) << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "explained");
}

// Of the samples one in fifty is some seven times as noisy.
TEST(Relatives, KnocksAreHeardBesideFrictionAndWildSamples) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  Rng rng({3u});
  const Bench bench(
      configuration({hidden("stribeck_friction", "base_y",
                            {{"fc_n", 0.08}, {"fs_n", 0.2}, {"vs_mps", 0.05}, {"v0_mps", 0.004}}),
                     hidden("loose_load", "sensor_x", {{"slug_kg", 0.06}, {"gap_m", 0.004}})}));
  change(bench, [&](Recording& log) {
    for (const char* channel : {"fx", "fy", "fz"}) {
      Eigen::VectorXd force = log.column(channel);
      for (Index i = 0; i < force.size(); ++i) {
        if (rng.uniform() < 0.02) force(i) += 0.3 * rng.normal();
      }
      log.set(channel, force);
    }
  });
  const Json report = bench.diagnose().report;
  EXPECT_EQ(found(report), (std::set<std::string>{"stribeck_friction", "loose_load"}))
      << report["findings"].dump(1);
}

// Twice the sensor's noise in the second half: its blocks count half as much, but not where the
// noise is the pose's.
TEST(Relatives, ThePosesNoiseDoesNotVaryWithTheSensors) {
  const Bench bench(configuration(Json::array()));
  LoadedCase loaded = load_wrist(bench.request());
  Case& study = loaded.fit;
  set_derivative(study, {.kind = DerivativeSpec::Kind::kSpectral, .cutoff_hz = 8.0});
  const Index samples = study.logs[0].motion.samples();
  Eigen::MatrixXd level = Eigen::MatrixXd::Ones(samples, study.channel_count());
  level.bottomRows(samples / 2).setConstant(2.0);
  const Signals ones{Eigen::MatrixXd::Ones(samples, study.channel_count())};
  for (const double pose : {0.0, 1e6}) {
    std::vector<Floor> floors(3);
    for (Floor& floor : floors) {
      floor.white = 1.0;
      floor.static_part = pose;
      floor.pose_gain = {1.0};
      floor.dt = study.dt();
    }
    const Eigen::VectorXd white = Whitener(study, floors, {level})(ones);
    const Index blocks = white.size() / 3;
    EXPECT_NEAR(white(blocks / 4) / white(blocks - blocks / 4), pose > 0.0 ? 1.0 : 2.0, 1e-3);
  }
}

}  // namespace
}  // namespace dcnn
