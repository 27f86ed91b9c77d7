// SPDX-License-Identifier: Apache-2.0
#include "dcnn/teleop/teleop.h"

#include <gtest/gtest.h>

#include "data/testing.h"

namespace dcnn {
namespace {

using testing::contains;
using testing::error_of;

TeleopConfig defaults() { return parse_teleop(Json::object(), "default"); }

struct Outcome {
  TeleopTrace trace;
  Json row;
};

Outcome run(const TeleopConfig& config, Variant::Kind kind,
            std::unique_ptr<Compensator> compensator = nullptr) {
  Variant variant{"v", kind, std::move(compensator)};
  Outcome result;
  result.trace = run_teleop(config, variant, config.tool.model.R_ES(), 1);
  result.row = summarise(result.trace, config, "v");
  return result;
}

void expect_within_ten_percent(const Json& value, double reference) {
  EXPECT_NEAR(value.get<double>(), reference, 0.1 * reference);
}

/// From an independent integration.
TEST(Teleop, IdealRowAgreesWithTheIndependentIntegration) {
  const Json row = run(defaults(), Variant::Kind::kIdeal).row;
  EXPECT_NEAR(row["contact_interval_s"][0].get<double>(), 69.8, 0.2);
  EXPECT_NEAR(row["contact_interval_s"][1].get<double>(), 75.0, 0.2);
  expect_within_ten_percent(row["force_max_n"], 5.0);
  expect_within_ten_percent(row["free_error_rms_m"], 0.48e-3);
  expect_within_ten_percent(row["free_error_max_m"], 0.94e-3);
  expect_within_ten_percent(row["contact_error_rms_m"], 1.54e-3);
  expect_within_ten_percent(row["contact_error_max_m"], 1.79e-3);
  EXPECT_LT(row["handle_force_free_rms_n"].get<double>(), 0.02);
  EXPECT_TRUE(row["stable"].get<bool>());
}

TEST(Teleop, RowWithoutFeedbackAgreesWithTheIndependentIntegration) {
  const Json row = run(defaults(), Variant::Kind::kNone).row;
  expect_within_ten_percent(row["force_max_n"], 11.3);
  expect_within_ten_percent(row["free_error_rms_m"], 0.48e-3);
  expect_within_ten_percent(row["free_error_max_m"], 0.83e-3);
  expect_within_ten_percent(row["contact_error_rms_m"], 3.43e-3);
  expect_within_ten_percent(row["contact_error_max_m"], 3.90e-3);
  EXPECT_EQ(row["handle_force_free_rms_n"].get<double>(), 0.0);
}

TEST(Teleop, RawForceLetsTheToolsWeightMoveTheHand) {
  const Json row = run(defaults(), Variant::Kind::kMeasured).row;
  EXPECT_GT(row["handle_force_free_rms_n"].get<double>(), 2.0);
  EXPECT_GT(row["master_drift_m"].get<double>(), 0.008);
}

/// The causal estimator in the loop against the exact acceleration of the plant.
TEST(Teleop, TheRightSimulatorTakesTheToolOff) {
  const TeleopConfig config = defaults();
  const Json row = run(config, Variant::Kind::kMeasured, compensate_with(config.tool, "tool")).row;
  expect_within_ten_percent(row["force_max_n"], 5.0);
  EXPECT_LT(row["handle_force_free_rms_n"].get<double>(), 0.1);
  EXPECT_LT(row["master_drift_m"].get<double>(), 0.5e-3);
}

TEST(Teleop, ASimulatorThatNeedsTheFutureIsRefused) {
  TeleopConfig config = defaults();
  config.tool.effects = parse_effects(Json::parse(R"([{"effect": "loose_load", "axis": "sensor_x",
                       "parameters": {"slug_kg": 0.05, "gap_m": 0.004}}])"),
                                      "e", Exit::kData);
  const auto message = error_of([&] { compensate_with(config.tool, "model.json"); }, Exit::kData);
  EXPECT_TRUE(contains(message, "loose_load")) << message;
}

TeleopConfig stiff_and_late(bool passivity) {
  return parse_teleop({{"wall", {{"stiffness", 4000}}},
                       {"link", {{"delay_s", 0.02}, {"passivity", passivity}}},
                       {"feedback", {{"scale", 1.0}}}},
                      "stiff");
}

/// 40 ms round trip: the plain loop bounces off the wall again and again, the guarded one stays.
TEST(Teleop, PassivityKeepsAContactThatThePlainLoopLoses) {
  const Json plain = run(stiff_and_late(false), Variant::Kind::kIdeal).row;
  const Json guarded = run(stiff_and_late(true), Variant::Kind::kIdeal).row;
  EXPECT_FALSE(plain["stable"].get<bool>()) << plain;
  EXPECT_TRUE(guarded["stable"].get<bool>()) << guarded;
  EXPECT_LT(plain["energy_min_j"].get<double>(), 0.0);
  EXPECT_GT(guarded["energy_dissipated_j"].get<double>(), 0.0);
  EXPECT_LT(guarded["force_max_n"].get<double>(), plain["force_max_n"].get<double>());
}

TEST(Teleop, TheGuardLeavesAStableContactAlone) {
  const TeleopConfig plain = defaults();
  TeleopConfig guarded = plain;
  guarded.passivity = true;
  const Json a = run(plain, Variant::Kind::kIdeal).row, b = run(guarded, Variant::Kind::kIdeal).row;
  EXPECT_NEAR(a["force_max_n"].get<double>(), b["force_max_n"].get<double>(), 0.3);
}

TEST(Teleop, JitterAndLossAreDrawnFromTheSeed) {
  TeleopConfig config = defaults();
  config.duration_s = 10.0;
  const Outcome clean = run(config, Variant::Kind::kIdeal);
  config.packet_loss = 0.2;
  config.delay_jitter_ticks = 5;
  const Outcome a = run(config, Variant::Kind::kIdeal), b = run(config, Variant::Kind::kIdeal);
  EXPECT_EQ(a.trace.slave, b.trace.slave);
  EXPECT_NE(a.trace.slave, clean.trace.slave);
  EXPECT_LT((a.trace.slave - clean.trace.slave).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(Teleop, ADeadZoneSwallowsWhatIsBelowIt) {
  TeleopConfig config = defaults();
  config.duration_s = 5.0;
  config.force_dead_zone = 50.0;
  EXPECT_EQ(run(config, Variant::Kind::kMeasured).trace.felt.norm(), 0.0);
}

TEST(Teleop, TheHandStandsStillSidewaysDuringTheContact) {
  EXPECT_EQ(intended_motion(66.5, 0.045).head<2>(), intended_motion(77.5, 0.045).head<2>());
  EXPECT_NEAR(intended_motion(72.0, 0.045).z(), -0.045, 1e-12);
  EXPECT_NEAR(intended_motion(2.5, 0.045).z(), 0.02, 1e-12);
}

TEST(Teleop, AConfigurationWithAMistakeNamesIt) {
  const auto unknown = error_of(
      [] {
        parse_teleop({{"link", {{"delay", 1}}}}, "c.json");
      },
      Exit::kUsage);
  EXPECT_TRUE(contains(unknown, "link.delay")) << unknown;
  error_of([] { parse_teleop({{"link", {{"loss", 1.5}}}}, "c.json"); }, Exit::kUsage);
  error_of(
      [] {
        parse_teleop({{"frames", {{"base_tip", {{1, 2}, {3, 4}}}}}}, "c.json");
      },
      Exit::kUsage);
}

TEST(Teleop, TheShippedConfigurationIsTheDefault) {
  const auto path = std::filesystem::path(DCNN_SOURCE_DIR) / "configs/teleop.json";
  const TeleopConfig shipped = parse_teleop(read_json(path, Exit::kUsage), path.string());
  const TeleopConfig plain = defaults();
  EXPECT_EQ(to_json(shipped.tool), to_json(plain.tool));
  EXPECT_EQ(shipped.delay_ticks, plain.delay_ticks);
  EXPECT_EQ(shipped.wall_stiffness, plain.wall_stiffness);
}

}  // namespace
}  // namespace dcnn
