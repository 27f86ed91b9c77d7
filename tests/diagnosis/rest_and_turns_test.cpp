// SPDX-License-Identifier: Apache-2.0
// Machines that stand still most of the time, and motors that turn fast.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/position_bins.h"
#include "diagnosis/rest.h"
#include "diagnosis/search.h"
#include "support/process.h"

namespace dcnn {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

std::vector<std::string> effects_in(const Json& report) {
  std::vector<std::string> names;
  for (const Json& finding : report["findings"]) names.push_back(finding["effect"]);
  return names;
}

Json axis_with(const Json& more) {
  Json axis{{"name", "joint"},
            {"measured", "current"},
            {"unit", "A"},
            {"position", "q"},
            {"velocity", "dq"}};
  axis.update(more);
  return axis;
}

/// A system of one axis, with a recording to fit and one that is held out.
class Machine {
 public:
  Machine(const Json& axis, const Table& fit, const Table& hold) {
    write_file(folder_ / "system.json",
               Json{{"kind", "axes"}, {"axes", Json::array({axis})}}.dump());
    write_csv(folder_ / "fit.csv", fit);
    write_csv(folder_ / "hold.csv", hold);
  }
  DiagnosisRequest request() const {
    DiagnosisRequest request;
    request.system = folder_ / "system.json";
    request.fit = {folder_ / "fit.csv"};
    request.holdout = {folder_ / "hold.csv"};
    return request;
  }

 private:
  test::TemporaryFolder folder_;
};

/// Moves of 1 s between places, 3 s of rest after each, at 125 Hz: a current of 0.1 A per N m of
/// the simulated torque beside dry friction, which at rest holds any force up to 0.8 A. The noise
/// at rest is a thirtieth of that in motion.
Table moved_and_held(std::uint64_t seed) {
  constexpr double kRowSeconds = 0.008, kMove = 1.0, kPause = 3.0, kFriction = 0.8;
  Rng rng({seed});
  Table table;
  table.columns = {"t", "q", "dq", "current", "torque"};
  table.values.resize(std::llround(60.0 / kRowSeconds), 5);
  double from = 0.0, to = 0.0, held = 0.0;
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double t = static_cast<double>(k) * kRowSeconds, into = std::fmod(t, kMove + kPause);
    if (into < 0.5 * kRowSeconds) {
      from = to, to = rng.uniform(-1.2, 1.2), held = kFriction * rng.uniform(-1.0, 1.0);
    }
    const double phase = std::min(1.0, into / kMove);
    const double q = from + (to - from) * (phase - std::sin(kTurn * phase) / kTurn);
    const double v = into < kMove ? (to - from) * (1.0 - std::cos(kTurn * phase)) / kMove : 0.0;
    const double known = 25.0 * std::sin(q) + 12.0;
    const bool moves = std::abs(v) > 1e-3;
    table.values.row(k) << t, q, v,
        0.1 * known + (moves ? kFriction * std::tanh(v / 0.01) : held) +
            (moves ? 0.15 : 0.005) * rng.normal(),
        known;
  }
  return table;
}

TEST(RestAndTurns, FrictionIsFoundAlthoughItStandsStillMostOfTheTime) {
  const Machine machine(axis_with({{"simulated", "torque"}}), moved_and_held(1), moved_and_held(2));
  const Json report = diagnose(machine.request(), nullptr).report;
  const auto names = effects_in(report);
  const std::vector<std::string> gain_and_friction{"gain", "coulomb_friction"};
  EXPECT_EQ(names, gain_and_friction) << report["findings"].dump(1);
  EXPECT_NEAR(report["fit"]["noise_floor"][0].get<double>(), 0.15, 0.02);  // in motion
}

/// 20 s at 500 Hz of a motor that turns at 0.8 turns a second, give or take 3 %: a current that
/// varies 72 and 18 times a turn.
Table turned(double begin, std::uint64_t seed) {
  constexpr double kRowSeconds = 0.002, kSpeed = 0.8 * kTurn;
  Rng rng({seed});
  Table table;
  table.columns = {"t", "q", "dq", "current"};
  table.values.resize(10'000, 4);
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double t = static_cast<double>(k) * kRowSeconds, w = kTurn * 0.13, s = t + begin;
    const double q = kSpeed * (s + 0.03 / w * std::sin(w * s)),
                 v = kSpeed * (1.0 + 0.03 * std::cos(w * s));
    table.values.row(k) << t, q, v,
        0.35 + 0.2 * std::sin(72.0 * q) + 0.08 * std::cos(18.0 * q + 1.0) + 0.02 * rng.normal();
  }
  return table;
}

TEST(RestAndTurns, CoggingOfAMotorThatTurnsFastIsNoHum) {
  const Machine machine(axis_with({{"base", Json::array({"acceleration"})}}), turned(0.0, 1),
                        turned(31.0, 2));
  const Json report = diagnose(machine.request(), nullptr).report;
  std::vector<double> orders;
  for (const Json& finding : report["findings"]) {
    EXPECT_NE(finding["effect"], "hum");
    if (finding["effect"] == "cogging") {
      orders.push_back(finding["parameters"]["order"]["value"]);
    }
  }
  ASSERT_EQ(orders.size(), 2U) << report["findings"].dump(1);
  EXPECT_NEAR(std::max(orders[0], orders[1]), 72.0, 0.05);
  EXPECT_NEAR(std::min(orders[0], orders[1]), 18.0, 0.05);
}

TEST(RestAndTurns, RestIsWhereTheAxisDoesNotMove) {
  const Machine machine(axis_with({{"base", Json::array({"acceleration"})}}), moved_and_held(1),
                        moved_and_held(2));
  const Case study = load_axes(machine.request()).cases[0].fit;
  const std::vector<Span> spans = rests(study);
  ASSERT_EQ(spans.size(), 15U);  // one after each move
  for (std::size_t k = 0; k < spans.size(); ++k) {
    EXPECT_NEAR(spans[k].begin, 4.0 * double(k) + 1.0, 0.4);
    EXPECT_NEAR(spans[k].end, 4.0 * double(k) + 4.0, 0.4);
  }
  EXPECT_NEAR(share_within(study, spans), 0.75, 0.03);
  Case tool = study;
  tool.axis = nullptr;
  EXPECT_TRUE(rests(tool).empty());
}

/// The mean rate over 0.2 s of an oscillation at 5 Hz is zero.
TEST(RestAndTurns, AnOscillationIsNoRest) {
  for (const double hz : {1.0, 5.0, 10.0}) {
    Table table;
    table.columns = {"t", "q", "dq", "current"};
    table.values.resize(5000, 4);
    for (Index k = 0; k < table.values.rows(); ++k) {
      const double t = 0.002 * static_cast<double>(k), w = kTurn * hz;
      table.values.row(k) << t, std::sin(w * t) / w, std::cos(w * t), std::sin(w * t);
    }
    const Machine machine(axis_with({{"base", Json::array({"acceleration"})}}), table, table);
    EXPECT_TRUE(rests(load_axes(machine.request()).cases[0].fit).empty()) << hz << " Hz";
  }
}

/// A pendulum on a geared motor that steps from place to place and rings for a while there, which
/// nothing explains: its weight is seen at rest.
Table stepped(const std::vector<double>& places, std::uint64_t seed) {
  constexpr double kRowSeconds = 0.005, kEvery = 5.0, kMove = 0.5;
  Rng rng({seed});
  Table table;
  table.columns = {"t", "q", "dq", "current"};
  table.values.resize(1000 * static_cast<Index>(places.size()), 4);
  double from = 0.0;
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double t = static_cast<double>(k) * kRowSeconds;
    const auto step = static_cast<std::size_t>(k / 1000);
    if (k % 1000 == 0 && step > 0) from = places[step - 1];
    const double s = std::clamp((t - kEvery * double(step) - 1.0) / kMove, 0.0, 1.0);
    const double way = places[step] - from;
    const double q = from + way * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
                 v = way / kMove * 30.0 * s * s * (1.0 - s) * (1.0 - s),
                 a = way / (kMove * kMove) * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
    const double since = t - kEvery * double(step) - 1.0;
    const double ringing =
        since > 0.0 ? 0.15 * way * std::exp(-4.0 * since) * std::sin(kTurn * 8.0 * since) : 0.0;
    table.values.row(k) << t, q, v,
        0.4 * std::sin(q) + 0.0055 * a + 0.016 * v + ringing + 0.01 * rng.normal();
  }
  return table;
}

TEST(RestAndTurns, OfAMachineThatMostlyRestsTheWeightIsFound) {
  const Machine machine(axis_with({{"base", Json::array()}}), stepped({2.6, -2.6, 0.9, 0.0}, 1),
                        stepped({-0.9, 2.4, 1.2}, 2));
  const Json report = diagnose(machine.request(), nullptr).report;
  const std::vector<std::string> names = effects_in(report);
  const auto weight = std::find(names.begin(), names.end(), "gravity_load");
  ASSERT_NE(weight, names.end()) << report["findings"].dump(1);
  const Json& found = report["findings"][static_cast<std::size_t>(weight - names.begin())];
  EXPECT_NEAR(found["parameters"]["amp"]["value"].get<double>(), 0.4, 0.04);
}

TEST(RestAndTurns, WhatWasRefutedIsNotTriedAgain) {
  const Machine machine(axis_with({{"simulated", "torque"}}), moved_and_held(1), moved_and_held(2));
  Search search(load_axes(machine.request()).cases[0].fit, {}, nullptr);
  search.run();
  ASSERT_FALSE(search.fit().members.empty());
  const std::string name = search.fit().members[0].name();
  const auto is_offered = [&] {
    const auto trials = search.additions();
    return std::any_of(trials.begin(), trials.end(),
                       [&](const Trial& trial) { return trial.member.name() == name; });
  };
  search.settle(search.members_without(0));
  EXPECT_TRUE(is_offered());
  search.run();
  search.leave_out({0});
  EXPECT_FALSE(is_offered());
}

/// Noise of unit variance beside `size`·sin(order·q) in 4,000 places from -3 to 3 rad.
PositionBins binned(double order, double size, std::uint64_t seed) {
  Rng rng({seed});
  PositionBins bins(-3.0, 3.0, 0.004);
  for (int k = 0; k < 4000; ++k) {
    const double q = rng.uniform(-3.0, 3.0);
    bins.add(q, 0.5 * q + size * std::sin(order * q) + rng.normal(), 1.0);
  }
  return bins;
}

TEST(PositionBins, TellTheOrderBesideALine) {
  for (const double order : {3.4, 20.0, 73.3, 110.0}) {
    EXPECT_NEAR(best_order(binned(order, 1.0, 3), 1.0, 120.0), order, 0.07) << order;
  }
}

/// 4 s at 1 kHz at 5 rad/s, give or take a tenth.
std::vector<Eigen::VectorXd> fast_turn(double order, double size, Rng& rng, Eigen::VectorXd* q) {
  Eigen::VectorXd force(4'000);
  q->resize(force.size());
  for (Index k = 0; k < force.size(); ++k) {
    const double t = 0.001 * static_cast<double>(k);
    (*q)(k) = 5.0 * t + 0.5 * std::sin(t);
    force(k) = rng.normal() + size * std::sin(order * (*q)(k));
  }
  return {force};
}

TEST(PositionBins, ALineOfThePositionWidensTheBand) {
  Rng rng({11u});
  Eigen::VectorXd q;
  const auto forces = fast_turn(72.0, 1.0, rng, &q);
  const double hz = band_of_position_lines(forces, {q}, 0.001, 20.0);
  EXPECT_GT(hz, 72.0 * 5.0 / kTurn);
  EXPECT_LT(hz, 1.5 * 72.0 * 5.0 / kTurn);
}

// Nominally one of a thousand, of which all must be a tenth of the power besides.
TEST(PositionBins, NoiseHasNoLines) {
  Rng rng({12u});
  int widened = 0;
  for (int k = 0; k < 100; ++k) {
    Eigen::VectorXd q;
    const auto forces = fast_turn(1.0, 0.0, rng, &q);
    widened += band_of_position_lines(forces, {q}, 0.001, 20.0) > 0.0;
  }
  EXPECT_EQ(widened, 0);
}

TEST(PositionBins, OfNoMotionAreNone) {
  Rng rng({13u});
  Eigen::VectorXd force(3000);
  for (double& x : force) x = rng.normal();
  EXPECT_EQ(band_of_position_lines({force}, {Eigen::VectorXd::Constant(3000, 0.4)}, 0.001, 20.0),
            0.0);
  EXPECT_EQ(PositionBins(0.4, 0.4, 0.0).size(), 1);
}

/// A motor's voltage in proportion to acceleration and speed, and a bend of that line which is a
/// seventh of what is left beside them; 60 s at 50 Hz.
Table bent(std::uint64_t seed) {
  constexpr double kRowSeconds = 0.02, kBend = 0.67, kNoise = 0.05;
  Rng rng({seed});
  Table table;
  table.columns = {"t", "q", "dq", "current"};
  table.values.resize(3000, 4);
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double t = static_cast<double>(k) * kRowSeconds;
    const double w[3] = {kTurn * 0.11, kTurn * 0.27, kTurn * 0.53};
    double q = 0.0, v = 0.0, a = 0.0;
    for (const double each : w) {
      q -= std::cos(each * t + each) / each;
      v += std::sin(each * t + each), a += each * std::cos(each * t + each);
    }
    // v |v| less its line: the odd shape that base coefficients do not take.
    table.values.row(k) << t, q, v,
        0.3 * a + 0.5 * v + kBend * kNoise * (v * std::abs(v) - 1.9 * v) + kNoise * rng.normal();
  }
  return table;
}

TEST(RestAndTurns, ALawThatTakesOffASeventhOfWhatIsLeftIsNamed) {
  const Machine machine(axis_with({{"base", Json::array({"acceleration", "velocity"})}}), bent(1),
                        bent(2));
  const auto names = effects_in(diagnose(machine.request(), nullptr).report);
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "quadratic_drag");
}

/// A robot on a wall: a turn about gravity changes nothing, and is no part of a tilt.
TEST(TiltOfABase, OfARobotOnAWallIsAboutTheOtherTwoAxes) {
  Json config = test::configuration(Json::array(
      {test::hidden("gravity_tilt", nullptr, {{"tilt_y_rad", 0.1}, {"tilt_z_rad", -0.06}})}));
  config["simulator"]["gravity_mps2"] = {9.81, 0.0, 0.0};
  const Json report = test::Bench(test::at_half_rate(config)).diagnose().report;
  ASSERT_EQ(test::names(report), std::vector<std::string>{"gravity_tilt"}) << report["findings"];
  const Json& tilt = report["findings"][0]["parameters"];
  ASSERT_TRUE(tilt.contains("tilt_y_rad") && tilt.contains("tilt_z_rad")) << tilt;
  EXPECT_NEAR(tilt["tilt_y_rad"]["value"].get<double>(), 0.1, 0.002);
  EXPECT_NEAR(tilt["tilt_z_rad"]["value"].get<double>(), -0.06, 0.002);
}

}  // namespace
}  // namespace dcnn
