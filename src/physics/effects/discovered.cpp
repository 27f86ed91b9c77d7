// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "dcnn/physics/law.h"
#include "physics/effect_law.h"

namespace dcnn::effects::discovered {
namespace {

law::Law law_of(const EffectSpec& spec, Options& parameters) {
  Options structure(spec.law, "law", Exit::kData);
  return law::parse_law(law::parse_structure(structure), parameters);
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const law::Law of = law_of(spec, parameters);
  const Index rows = motion.samples();
  require(motion.v_B.rows() == rows, Exit::kData, motion.recording,
          ": a discovered law needs columns x,y,z or vx,vy,vz");
  require(!law::needs_position(of.structure) || motion.p_B.rows() == rows, Exit::kData,
          motion.recording, ": the discovered law needs columns x,y,z");
  for (const std::string& signal : of.structure.signals) {
    const bool logged =
        std::any_of(motion.signals.begin(), motion.signals.end(),
                    [&](const LoggedSignal& column) { return column.name == signal; });
    require(logged || rows == 0, Exit::kData, motion.recording, ": column '", signal,
            "', which a discovered law follows, is missing; log it");
  }
  Eigen::MatrixXd& on = of.structure.on_torque ? wrench.torque : wrench.force;
  law::LawRun run(of);
  for (Index k = 0; k < rows; ++k) {
    const law::Sample now = law::sample_of(motion, k, wrench.force.row(k), of.structure.signals);
    const auto force = run.step(now, k > 0 ? step(motion, k) : motion.dt, k == 0);
    if (on.rows() > 0) on.row(k) += force.transpose();
  }
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  const law::Law of = law_of(spec, parameters);
  return [run = law::LawRun(of), torque = of.structure.on_torque](InstantWrench& wrench,
                                                                  const Instant& now) mutable {
    const auto force = run.step(
        {now.R_BS, now.euler, now.p_B, now.v_B, now.a_B, now.w_S, now.dw_S, wrench.force, 0.0},
        now.dt, now.first);
    (torque ? wrench.torque : wrench.force) += force;
  };
}

bool online(const EffectSpec& spec) {
  Options structure(spec.law, "law", Exit::kData);
  const law::Structure of = law::parse_structure(structure);
  return !law::needs_clock(of) && of.signals.empty();
}

}  // namespace

const EffectKind effect{
    .name = "discovered",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "a law found in recordings that no other effect explains",
    .on_machine = "law without a name",
    .equation = "amplitude f1(q1) f2(q2) … n",
    .example = R"({"amplitude_n": -0.4, "scale_1_mps": 0.1, "power_1": 1.5, "memory_2_s": 0.3,
                   "centre_2_rad": 0.1, "scale_2_rad": 0.7, "gain_2": 0.5})",
    .example_law = R"({"axis": "tool_z", "factors": [
                       {"shape": "power", "of": "v_tool_z"},
                       {"shape": "wavy", "of": "beta", "memory": "lag", "centred": true}]})",
    .needs_time = TimeNeed::kMotion,
    .apply = apply,
    .stream = stream,
    .online = online,
};

}  // namespace dcnn::effects::discovered
