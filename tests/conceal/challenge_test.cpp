// SPDX-License-Identifier: Apache-2.0
#include "dcnn/conceal/challenge.h"

#include <gtest/gtest.h>

#include <set>

#include "conceal/tally.h"
#include "dcnn/conceal/scenario.h"
#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "dcnn/physics/simulator.h"
#include "support/process.h"

namespace dcnn::conceal {
namespace {

TEST(Challenge, EveryGroupHasItsShareAndNoScenarioComesTwice) {
  const auto ids = plan(200, 7);
  EXPECT_EQ(ids.size(), 200U);
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), 200U);
  std::map<std::string, int> count;
  for (const auto& id : ids) ++count[id.substr(0, id.find(':'))];
  EXPECT_EQ(count["null"], 30);
  EXPECT_EQ(count["single"], 70);
  EXPECT_EQ(count["unlisted"], 12);
  EXPECT_EQ(plan(200, 7), ids);
  EXPECT_NE(plan(200, 8), ids);
  EXPECT_EQ(plan(1, 1).size(), 1U);
  EXPECT_THROW(plan(0, 1), Error);
}

TEST(Challenge, EveryListedEffectHasItsTurnAmongSingles) {
  std::set<std::string> seen;
  for (const auto& id : plan(100, 3)) {
    if (id.rfind("single:", 0) == 0)
      seen.insert(id.substr(id.find('/') + 1, id.rfind('/') - id.find('/') - 1));
  }
  EXPECT_EQ(seen.size(), listed_effects().size());
}

TEST(Scenario, TheSameSeedGivesTheSameScenario) {
  const Scenario a = draw("single:0.5/cable_spring/1", 3), b = draw("single:0.5/cable_spring/1", 3);
  EXPECT_EQ(truth(a), truth(b));
  ASSERT_EQ(a.recordings.size(), b.recordings.size());
  EXPECT_EQ(a.recordings[0].measured, b.recordings[0].measured);
  EXPECT_EQ(a.recordings[0].pose, b.recordings[0].pose);
  EXPECT_NEAR(a.hidden.at(0).amplitude, 0.5, 0.01);
  EXPECT_THROW(draw("single:0.5/nothing/1", 3), Error);
  EXPECT_THROW(draw("nobody:0.5/mass/1", 3), Error);
}

// The first draws of these rest where the effect acts: half of a planar motion's axes do.
TEST(Scenario, WhatChangesNothingOnItsMotionIsDrawnAnew) {
  for (int k = 0; k < 12; ++k) {
    const std::string id = "poor:0.5/hysteresis/" + std::to_string(k);
    const Scenario s = draw(id, 4003);
    ASSERT_EQ(s.hidden.size(), 1U) << id;
    EXPECT_NEAR(s.hidden[0].amplitude, 0.5, 0.02) << id;
    EXPECT_EQ(truth(s)["drawn"], id);
  }
}

// A mode must be driven to ring that much, and a load must slide to knock: most first draws do not.
TEST(Scenario, AnAmplitudeIsTheOneAskedFor) {
  for (const char* effect : {"flexible_resonance", "loose_load"}) {
    for (const char* amplitude : {"0.3", "1"}) {
      const std::string id = std::string("single:") + amplitude + "/" + effect + "/4";
      const double asked = std::stod(amplitude);
      const Scenario s = draw(id, 1288057598);
      ASSERT_EQ(s.hidden.size(), 1U) << id;
      EXPECT_GT(s.hidden[0].amplitude, asked / 1.25) << id;
      EXPECT_LT(s.hidden[0].amplitude, asked * 1.25) << id;
    }
  }
}

// Another implementation reads the nominal simulator and the recordings: nothing is left but noise.
TEST(Scenario, WithNothingHiddenTheSimulatorLeavesTheNoise) {
  const test::TemporaryFolder folder;
  const Scenario s = draw("null:white/none/2", 5);
  const Files files = write(s, folder.path());
  ASSERT_EQ(files.holdout.size(), 1U);
  const Json sim = read_json(files.simulator, Exit::kData);
  EXPECT_EQ(sim["tool"]["mass_kg"].get<double>(), s.tool.mass);
  EXPECT_EQ(sim["model"]["inertial"], "full");
  const Recording log = read_recording(files.holdout[0], ReadOptions(), System());
  const Recording said = predict_motion(read_simulator(files.simulator), log, DerivativeSpec());
  const std::vector<std::string> forces{"fx", "fy", "fz"};
  const auto n = log.samples() - 500;
  const Eigen::MatrixXd left = (log.block(forces) - said.block(forces)).middleRows(250, n);
  const double rms = std::sqrt(left.squaredNorm() / static_cast<double>(3 * n));
  EXPECT_NEAR(rms / s.noise.sigma, 1.0, 0.05);
  EXPECT_NEAR(truth(s)["oracle_rmse"][0].get<double>() / s.noise.sigma, 1.0, 0.03);
}

TEST(Seal, IsTheHashOfTheAnswersAndLiesElsewhere) {
  const test::TemporaryFolder folder;
  const auto set = folder / "set", seal = folder / "answers.json";
  const std::string digest = conceal_challenge({"single:1/bias/0"}, 9, set, seal, [](int, int) {});
  EXPECT_EQ(digest, sha256_hex({test::slurp(seal)}));
  EXPECT_EQ(test::slurp(set / "seal.sha256").substr(0, 64), digest);
  const Json answers = open_seal(set, seal);
  EXPECT_EQ(answers["scenarios"][0]["hidden"][0]["effect"], "bias");
  std::set<std::string> files;
  for (const auto& file : std::filesystem::directory_iterator(set / "s0001")) {
    files.insert(file.path().filename().string());
    EXPECT_EQ(answers["scenarios"][0]["sha256"][file.path().filename().string()],
              sha256_hex({test::slurp(file.path())}));
  }
  EXPECT_TRUE(files.count("sim.json") && files.count("fit_0.csv") && files.count("holdout_0.csv"));

  write_file(seal, test::slurp(seal) + " ");
  EXPECT_THROW(open_seal(set, seal), Error);
  EXPECT_THROW(write_seal(answers, set, set / "s0001" / "answers.json"), Error);
}

Json hidden(const char* effect, const char* axis, const Json& parameters) {
  return {{"effect", effect}, {"axis", axis},     {"interval_s", nullptr},   {"listed", true},
          {"foreign", false}, {"amplitude", 1.0}, {"parameters", parameters}};
}

Json answer(const char* group, const std::vector<Json>& effects) {
  return {{"id", "s0001"},
          {"drawn", "x"},
          {"group", group},
          {"motion", "human"},
          {"noise", {{"kind", "white"}}},
          {"hidden", effects},
          {"oracle_rmse", {0.1, 0.1, 0.1}}};
}

Json finding(const char* effect, const char* axis, const std::vector<std::string>& alternatives,
             const Json& parameters) {
  return {{"effect", effect},
          {"axis", axis},
          {"interval_s", nullptr},
          {"alternatives", alternatives},
          {"parameters", parameters}};
}

Json report(const char* verdict, const std::vector<Json>& findings) {
  return {{"verdict", verdict},
          {"findings", findings},
          {"fit", {{"holdout_rmse_after", {0.1, 0.1, 0.13}}, {"noise_floor", {0.1, 0.1, 0.1}}}}};
}

TEST(Score, TheRightNameItsAxisAndItsNumber) {
  const Json number{{"fc_n", {{"value", 0.42}, {"ci95", {0.39, 0.43}}}}};
  const Json s = score(answer("single", {hidden("coulomb_friction", "tool_z", {{"fc_n", 0.4}})}),
                       report("explained", {finding("coulomb_friction", "sensor_z", {}, number)}));
  EXPECT_TRUE(s["top1"] && s["set"] && s["class_set"] && s["verdict_right"]);
  EXPECT_EQ(s["false_names"], 0);
  const Json& e = s["effects"][0];
  EXPECT_TRUE(e["named"] && e["axis_right"]);  // along the tool is the sensor's z axis
  EXPECT_NEAR(e["parameters"]["fc_n"]["error"].get<double>(), 0.05, 1e-12);
  EXPECT_TRUE(e["parameters"]["fc_n"]["covered"]);
  EXPECT_NEAR(s["holdout"]["after"].get<double>(), 0.11, 1e-12);
}

TEST(Score, AnAlternativeCountsInTheClassAlone) {
  const Json s = score(answer("double", {hidden("lowpass", "", {}), hidden("mass", "", {})}),
                       report("explained", {finding("time_delay", "", {"lowpass"}, {}),
                                            finding("hum", "", {}, {})}));
  EXPECT_FALSE(s["set"] || s["class_set"] || s["effects"][0]["named"] ||
               s["effects"][1]["in_class"]);
  EXPECT_TRUE(s["effects"][0]["in_class"]);
  EXPECT_EQ(s["false_names"], 1);
}

TEST(Score, NothingHiddenAndADiagnosisThatFailed) {
  const Json null = answer("null", {});
  EXPECT_TRUE(score(null, report("consistent", {}))["verdict_right"]);
  EXPECT_EQ(score(null, report("explained", {finding("hum", "", {}, {})}))["false_names"], 1);
  const Json failed = score(null, nullptr);
  EXPECT_EQ(failed["verdict"], "failed");
  EXPECT_FALSE(failed["verdict_right"] || failed["set"]);
}

TEST(Score, APhaseIsComparedOnTheCircle) {
  const Json s = score(
      answer("single", {hidden("cogging", "alpha:sensor_x", {{"phase_rad", 3.1}})}),
      report("explained", {finding("cogging", "alpha:sensor_x", {},
                                   {{"phase_rad", {{"value", -3.1}, {"ci95", {-3.2, -3.0}}}}})}));
  const Json& p = s["effects"][0]["parameters"]["phase_rad"];
  EXPECT_NEAR(p["error"].get<double>(), 2.0 * 3.14159265358979 - 6.2, 1e-9);
  EXPECT_TRUE(p["covered"]);
}

TEST(Tally, WilsonIntervals) {
  const Json w = wilson(8, 10);  // Newcombe (1998), method 3
  EXPECT_NEAR(w["low"].get<double>(), 0.4902, 1e-4);
  EXPECT_NEAR(w["high"].get<double>(), 0.9433, 1e-4);
  EXPECT_NEAR(wilson(0, 20)["high"].get<double>(), 0.1611, 1e-4);
  EXPECT_TRUE(wilson(0, 0)["rate"].is_null());
}

}  // namespace
}  // namespace dcnn::conceal
