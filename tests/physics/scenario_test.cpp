// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/scenario.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/support.h"

namespace dcnn {
namespace {

Json small_config() {
  Json config = repository_json("configs/sim/sample.json");
  for (auto& recording : config["recordings"]) recording["samples"] = 600;
  return config;
}

Eigen::MatrixXd forces(const Recording& recording) { return recording.block({"fx", "fy", "fz"}); }

TEST(EmbeddedConfig, HasTheSizesAndLevelsOfTheSpecification) {
  const Scenario scenario =
      simulate_config(repository_json("configs/sim/embedded.json"), "embedded.json");
  ASSERT_EQ(scenario.recordings.size(), 2U);
  EXPECT_EQ(scenario.recordings[0].noisy.samples(), 41729);
  EXPECT_EQ(scenario.recordings[1].noisy.samples(), 32045);
  const ToolModel tool = parse_tool_model(scenario.simulator, "sim.json", Exit::kData);
  EXPECT_NEAR(tool.mass * tool.gravity.norm(), 7.36, 0.01);
  const Recording& clean = scenario.recordings[0].clean;
  const Eigen::MatrixXd p = clean.block({"x", "y", "z"});
  const Index n = p.rows() - 2;
  const Eigen::MatrixXd a =
      (p.topRows(n) - 2.0 * p.middleRows(1, n) + p.bottomRows(n)) / (0.002 * 0.002);
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(a.col(i).cwiseAbs().maxCoeff(), 1.0, 0.15);
  const Eigen::MatrixXd noise = forces(scenario.recordings[0].noisy) - forces(clean);
  EXPECT_NEAR(std::sqrt(noise.squaredNorm() / static_cast<double>(noise.size())), 0.04, 1e-3);
  EXPECT_FALSE(scenario.recordings[0].noisy.has("tx"));
}

// F = C·[m R_SB (g - a_com) + f_cable] + b0 + b1·t, with the rigid share as ground truth beside it.
TEST(EmbeddedConfig, CleanForceIsTheFormulaOfTheSpecification) {
  Json config = repository_json("configs/sim/embedded.json");
  const Scenario scenario = simulate_config(config, "embedded.json");
  const Recording& clean = scenario.recordings[1].clean;
  const Json& c = config["hidden"][1]["parameters"];
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
  C(0, 1) = c["c_xy"], C(0, 2) = c["c_xz"], C(1, 0) = c["c_yx"];
  C(1, 2) = c["c_yz"], C(2, 0) = c["c_zx"], C(2, 1) = c["c_zy"];
  const Eigen::MatrixXd tool = clean.block({"fx_tool", "fy_tool", "fz_tool"});
  const Eigen::MatrixXd angles = clean.block({"alpha", "beta", "gamma"});
  for (Index k = 0; k < clean.samples(); k += 1000) {
    const double alpha = angles(k, 0), beta = angles(k, 1), gamma = angles(k, 2);
    const Eigen::Vector3d cable = 0.2 * Eigen::Vector3d(std::sin(alpha + 0.4), std::cos(2.0 * beta),
                                                        std::sin(gamma) * std::cos(alpha));
    const Eigen::Vector3d wanted = C * (tool.row(k).transpose() + cable) +
                                   Eigen::Vector3d(0.6, -0.4, 1.1) +
                                   Eigen::Vector3d::Constant(1e-3 * clean.column("t")(k));
    EXPECT_LT((forces(clean).row(k).transpose() - wanted).norm(), 1e-9) << k;
  }
}

TEST(Scenario, LogsAnglesAsARobotDoes) {
  const Scenario scenario = simulate_config(small_config(), "sample.json");
  const Eigen::MatrixXd angles = scenario.recordings[0].noisy.block({"alpha", "beta", "gamma"});
  EXPECT_LE(angles.cwiseAbs().maxCoeff(), std::numbers::pi);
  EXPECT_LE(angles.col(1).cwiseAbs().maxCoeff(), std::numbers::pi / 2.0);
  EXPECT_GT(angles.col(2).maxCoeff() - angles.col(2).minCoeff(), 6.0);  // points down: jumps at pi
}

TEST(Scenario, SameSeedSameBytesAndEverySeedItsOwn) {
  const Scenario one = simulate_config(small_config(), "c"),
                 same = simulate_config(small_config(), "c");
  EXPECT_EQ(one.recordings[0].noisy.table.values, same.recordings[0].noisy.table.values);
  EXPECT_EQ(one.truth, same.truth);
  const Scenario other = simulate_config(small_config(), "c", 8);
  EXPECT_NE(one.recordings[0].noisy.table.values, other.recordings[0].noisy.table.values);
  EXPECT_EQ(other.truth["seed"], 8);
  EXPECT_NE(forces(one.recordings[0].clean), forces(one.recordings[1].clean));
}

TEST(Scenario, ARecordingDoesNotDependOnThoseBehindIt) {
  Json config = small_config();
  const auto both = simulate_config(config, "c");
  config["recordings"].erase(1);
  EXPECT_EQ(simulate_config(config, "c").recordings[0].noisy.table.values,
            both.recordings[0].noisy.table.values);
}

TEST(Scenario, HiddenEffectsAreInTheForceAndInTheTruthOnly) {
  Json config = small_config();
  const Scenario with = simulate_config(config, "c");
  EXPECT_FALSE(with.simulator.contains("effects"));
  EXPECT_EQ(with.truth["effects"], config["hidden"]);
  config["hidden"] = Json::array();
  const Scenario without = simulate_config(config, "c");
  const Eigen::MatrixXd difference =
      forces(with.recordings[0].clean) - forces(without.recordings[0].clean);
  EXPECT_NEAR(difference.cwiseAbs().maxCoeff(), 0.4, 1e-3);
  EXPECT_EQ(difference.leftCols(2).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Scenario, TheCorrectedSimulatorPredictsTheCleanRecording) {
  const Scenario scenario = simulate_config(small_config(), "c");
  Json model = scenario.simulator;
  model["effects"] = scenario.truth["effects"];
  const Recording& clean = scenario.recordings[0].clean;  // holds the exact rates
  const Recording predicted =
      predict_motion(parse_simulator(model, "model.json", Exit::kData), clean, {});
  EXPECT_LT((forces(predicted) - forces(clean)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((predicted.column("ty") - clean.column("ty")).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Scenario, PredictionFromTheLoggedPoseIsNearTheCleanForce) {
  Json config = small_config();
  DerivativeSpec short_window;  // without pose noise there is nothing to smooth
  short_window.window_s = 0.03;
  config["pose_noise"] = {{"m", 0.0}, {"rad", 0.0}};
  for (const std::string orientation : {"euler", "quaternion"}) {
    config["orientation"] = orientation;
    const Scenario scenario = simulate_config(config, "c");
    Recording log = scenario.recordings[0].noisy;
    EXPECT_EQ(log.has("qw"), orientation == "quaternion");
    Json model = scenario.simulator;
    model["effects"] = scenario.truth["effects"];
    const Recording predicted =
        predict_motion(parse_simulator(model, "m", Exit::kData), log, short_window);
    const Eigen::MatrixXd error = forces(predicted) - forces(scenario.recordings[0].clean);
    EXPECT_LT(std::sqrt(error.middleRows(50, 500).squaredNorm() / 1500.0), 0.003) << orientation;
  }
}

// A spring in an angle that wraps: the reader's branch is the simulator's.
TEST(Scenario, AnglesThatWrapMeanTheSameToSimulatorAndReader) {
  Json config = small_config();
  config["hidden"] =
      Json::parse(R"([{"effect": "cable_spring", "axis": "gamma:sensor_y", "interval_s": null,
                                      "parameters": {"k_nprad": 1.0, "rest_rad": 3.0}}])");
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Scenario scenario = simulate_config(config, "c", seed);
    for (const auto& recording : scenario.recordings) {
      const Eigen::MatrixXd tool = recording.clean.block({"fx_tool", "fy_tool", "fz_tool"});
      const Eigen::VectorXd spring = forces(recording.clean).col(1) - tool.col(1);
      const Eigen::VectorXd wanted =
          -(continuous_euler(recording.noisy).col(2).array() - 3.0) - 0.08;
      EXPECT_LT((spring - wanted).cwiseAbs().maxCoeff(), 1e-3) << seed;
    }
  }
}

TEST(StaticConfig, IsAListOfPosesAtRest) {
  const Scenario scenario =
      simulate_config(repository_json("configs/sim/static.json"), "static.json");
  const Recording& list = scenario.recordings[0].noisy;
  EXPECT_EQ(list.samples(), 24);
  EXPECT_FALSE(list.has("t"));
  EXPECT_EQ(list.dt, 0.0);
  const Eigen::MatrixXd weight =
      scenario.recordings[0].clean.block({"fx_tool", "fy_tool", "fz_tool"});
  EXPECT_LT((weight.rowwise().norm().array() - 0.75 * 9.81).abs().maxCoeff(), 1e-9);
  const Recording predicted =
      predict_motion(parse_simulator(scenario.simulator, "s", Exit::kData), list, {});
  EXPECT_LT((forces(predicted) - forces(list)).cwiseAbs().maxCoeff(), 0.25);
}

/// The message that a changed configuration is refused with.
std::string refusal_of_scenario(const std::string& pointer, const Json& value) {
  Json config = small_config();
  at_pointer(config, pointer) = value;
  try {
    simulate_config(config, "c.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage) << error.what();
    EXPECT_EQ(std::string(error.what()).rfind("c.json", 0), 0U) << error.what();
    return error.what();
  }
  return "accepted";
}

TEST(Scenario, RefusesAWrongConfigurationAsUsage) {
  EXPECT_NE(refusal_of_scenario("/sead", 1).find("did you mean 'seed'"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/seed", -1).find("seed"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/seed", 1.5).find("seed"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/simulator/tool/mass_kg", -1).find("mass_kg"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/hidden/0/effect", "friction").find("effect"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/hidden/0/axis", "tool_x").find("tool_z"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/hidden/0/parameters/fc_n", -1).find("fc_n"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/recordings/0/name", "../a").find("name"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/recordings/0/name", "test").find("overwrite"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/recordings/0/samples", 0).find("samples"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/recordings/0/trajectory/kind", "spiral").find("multisine"),
            std::string::npos);
  EXPECT_NE(refusal_of_scenario("/recordings", Json::array()).find("recordings"),
            std::string::npos);
  EXPECT_NE(refusal_of_scenario("/force_noise/ar", 1.0).find("ar"), std::string::npos);
  EXPECT_NE(refusal_of_scenario("/orientation", "matrix").find("orientation"), std::string::npos);
}

}  // namespace
}  // namespace dcnn
