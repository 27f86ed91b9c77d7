// SPDX-License-Identifier: Apache-2.0
// What every effect of the catalogue owes: the tests loop over effect_kinds(), not over a copy of
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "physics/support.h"

namespace dcnn {
namespace {

class EveryEffect : public testing::TestWithParam<const EffectKind*> {
 protected:
  const EffectKind& kind() const { return *GetParam(); }
};

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, testing::ValuesIn(effect_kinds()),
                         [](const auto& instance) { return std::string(instance.param->name); });

Simulator with(const EffectSpec& effect) {
  Simulator simulator{example_tool(), {effect}};
  if (effect.effect == "inertial_terms") simulator.model.inertial = ToolModel::Inertial::kNone;
  return simulator;
}

TEST_P(EveryEffect, ItsExampleChangesTheForceAndStaysFinite) {
  const Motion motion = example_motion();
  const Simulator simulator = with(example_effect(kind()));
  const Wrench wrench = simulate(simulator, motion);
  EXPECT_TRUE(wrench.force.allFinite());
  EXPECT_TRUE(wrench.torque.allFinite());
  const Wrench without = simulate({simulator.model, {}}, motion);
  const bool torque = kind().force == Shown::kNever;
  EXPECT_GT((torque ? wrench.torque - without.torque : wrench.force - without.force)
                .cwiseAbs()
                .maxCoeff(),
            1e-4);
}

TEST_P(EveryEffect, RunsSampleBySampleAsOverTheWholeRecording) {
  if (!kind().stream) GTEST_SKIP() << "is not known online";
  const Motion motion = example_motion(900);
  const ToolModel model = example_tool();
  const EffectSpec effect = example_effect(kind());
  Wrench wanted = rigid_wrench(model, motion);
  Wrench given = wanted;
  apply_effect(effect, motion, model, wanted);
  Options parameters(effect.parameters, "test", Exit::kUsage);
  const EffectStream act = kind().stream(effect, parameters);
  for (Index start : {Index{0}, Index{0}}) {  // twice: a new stretch forgets the old one
    for (Index k = start; k < motion.samples(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Instant now{k == start,          motion.dt,          motion.R_BS[i],
                        motion.euler.row(k), motion.v_B.row(k),  motion.a_B.row(k),
                        motion.w_S.row(k),   motion.dw_S.row(k), motion.p_B.row(k)};
      InstantWrench wrench{given.force.row(k), given.torque.row(k), given.force.row(k)};
      act(wrench, now);
      ASSERT_LT((wrench.force - wanted.force.row(k).transpose()).norm(), 1e-9) << k;
      ASSERT_LT((wrench.torque - wanted.torque.row(k).transpose()).norm(), 1e-9) << k;
    }
  }
}

TEST_P(EveryEffect, IsWholeInItsDescription) {
  EXPECT_NE(kind().change == nullptr, kind().apply == nullptr);
  EXPECT_EQ(kind().change != nullptr, kind().stage == Stage::kTool);
  EXPECT_EQ(
      std::set<std::string>({"parameter", "structural", "sensor", "external"}).count(kind().kind),
      1U);
  EXPECT_FALSE(std::string(kind().equation).empty());
  EXPECT_FALSE(std::string(kind().meaning).empty());
}

// The parameters that scale each effect; the others are shapes (widths, times, frequencies).
const std::set<std::string> kShapes{
    "v0_mps",  "vs_mps",      "sigma0_npm", "sigma1_nspm",  "width_rad",   "asym",       "rest_rad",
    "order",   "phase_rad",   "gap_m",      "freq_hz",      "zeta",        "t_ref_degc", "limit_n",
    "power_1", "scale_1_mps", "memory_2_s", "centre_2_rad", "scale_2_rad", "gain_2"};

TEST_P(EveryEffect, StrengthZeroIsTheIdentity) {
  const std::string name = kind().name;
  if (name == "inertial_terms") GTEST_SKIP() << "has no strength";
  Json parameters = Json::parse(kind().example);
  const bool settles = name == "thermal_drift" || name == "creep";
  for (auto& [key, value] : parameters.items()) {
    if (!kShapes.count(key) && !(settles && key == "tau_s")) value = 0.0;
    if (key == "limit_n") value = 1e9;
  }
  EffectSpec effect = example_effect(kind());
  effect.parameters = parameters;
  const Motion motion = example_motion(300);
  const Wrench with_it = simulate(with(effect), motion),
               without = simulate({example_tool(), {}}, motion);
  EXPECT_LT((with_it.force - without.force).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((with_it.torque - without.torque).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(EveryEffect, DoesNothingOutsideItsInterval) {
  if (kind().interval == IntervalRule::kNever) GTEST_SKIP() << "takes no interval";
  const Motion motion = example_motion();
  EffectSpec effect = example_effect(kind());
  effect.interval_s = {1.0, 2.0};
  const Wrench before = simulate({example_tool(), {}}, motion);
  const Wrench after = applied(effect, motion, before);
  EXPECT_EQ(after.force.topRows(500), before.force.topRows(500));
  if (kind().interval == IntervalRule::kOnset) return;
  EXPECT_EQ(after.force.bottomRows(999), before.force.bottomRows(999));
}

TEST_P(EveryEffect, ActsOnARecordingOfOneSampleAndOnAStaticList) {
  const EffectSpec effect = example_effect(kind());
  EXPECT_TRUE(simulate(with(effect), example_motion(1)).force.allFinite());
  Motion poses = still_motion(5);
  poses.dt = 0.0;
  poses.has_clock = false;
  const Simulator simulator = with(effect);
  const Wrench wrench = simulate(simulator, poses);
  EXPECT_TRUE(wrench.force.allFinite());
  if (kind().needs_time != TimeNeed::kNone) {
    EXPECT_EQ(wrench.force, simulate({simulator.model, {}}, poses).force);
  }
}

TEST_P(EveryEffect, AGapInTimeLeavesItFinite) {
  Motion motion = example_motion(600);
  motion.t.tail(300).array() += 50.0;
  motion.segments = {{0, 300}, {300, 600}};
  EXPECT_TRUE(simulate(with(example_effect(kind())), motion).force.allFinite());
}

/// The error that a changed entry is refused with; the empty string when it is accepted.
std::string refusal(const Json& entry) {
  try {
    parse_effects(Json::array({entry}), "model.json", Exit::kModel);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kModel);
    return error.what();
  }
  return "";
}

TEST_P(EveryEffect, RefusesMissingUnknownAndMistypedParameters) {
  const Json entry = to_json({example_effect(kind())})[0];
  EXPECT_EQ(refusal(entry), "");
  Json changed = entry;
  changed["parameters"]["strenght"] = 1.0;
  EXPECT_NE(refusal(changed).find("strenght"), std::string::npos);
  for (const auto& [key, value] : entry["parameters"].items()) {
    changed = entry;
    changed["parameters"].erase(key);
    EXPECT_NE(refusal(changed).find(key), std::string::npos);
    changed["parameters"][key] = "much";
    EXPECT_NE(refusal(changed).find(key), std::string::npos);
  }
}

TEST_P(EveryEffect, RefusesAWrongAxisAndAWrongInterval) {
  Json entry = to_json({example_effect(kind())})[0];
  const bool needs_interval =
      kind().interval == IntervalRule::kRequired || kind().interval == IntervalRule::kOnset;
  Json changed = entry;
  changed["axis"] = "sideways";
  EXPECT_NE(refusal(changed).find("axis"), std::string::npos);
  changed = entry;
  changed["interval_s"] = {2.0, 1.0};
  EXPECT_NE(refusal(changed).find("interval_s"), std::string::npos);
  changed["interval_s"] = nullptr;
  EXPECT_EQ(refusal(changed).empty(), !needs_interval);
}

TEST(Catalogue, HoldsEveryPublishedName) {
  const std::vector<std::string> published{"mass",
                                           "com",
                                           "gravity_tilt",
                                           "inertial_terms",
                                           "coulomb_friction",
                                           "viscous_friction",
                                           "stribeck_friction",
                                           "quadratic_drag",
                                           "lugre_friction",
                                           "hysteresis",
                                           "cable_spring",
                                           "cogging",
                                           "loose_load",
                                           "flexible_resonance",
                                           "contact",
                                           "bias",
                                           "misalignment",
                                           "gain",
                                           "crosstalk",
                                           "time_delay",
                                           "lowpass",
                                           "thermal_drift",
                                           "linear_drift",
                                           "step_bias",
                                           "saturation",
                                           "quantisation",
                                           "hum",
                                           "load_friction",
                                           "creep"};
  std::set<std::string> names;
  for (const auto* kind : effect_kinds())
    EXPECT_TRUE(names.insert(kind->name).second) << kind->name;
  for (const auto& name : published) EXPECT_EQ(names.count(name), 1U) << name;
  const auto kinds = effect_kinds();
  const auto more = std::count_if(kinds.begin(), kinds.end(), [](const EffectKind* kind) {
    return kind->subject >= EffectKind::Subject::kMachines;
  });
  // and cable_field, of the embedded data, weightless_mass, inertia_tensor and discovered
  EXPECT_EQ(names.size(), published.size() + 4 + static_cast<std::size_t>(more));
}

TEST(Catalogue, IsListedInTheOrderInWhichItActs) {
  Stage last = Stage::kTool;
  for (const auto* kind : effect_kinds()) {
    EXPECT_GE(kind->stage, last) << kind->name;
    last = kind->stage;
  }
}

// Stages in their order: resonance, then misalignment, gain, crosstalk, then lowpass and delay.
TEST(Catalogue, TheOrderOfWritingDoesNotMatter) {
  const Motion motion = example_motion(400);
  std::vector<EffectSpec> effects;
  for (const auto* kind : effect_kinds()) effects.push_back(example_effect(*kind));
  const Wrench forwards = simulate({example_tool(), effects}, motion);
  std::reverse(effects.begin(), effects.end());
  const Wrench backwards = simulate({example_tool(), effects}, motion);
  EXPECT_EQ(forwards.force, backwards.force);
  EXPECT_EQ(forwards.torque, backwards.torque);
}

}  // namespace
}  // namespace dcnn
