// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/simulator.h"

#include <algorithm>
#include <cmath>

#include "dcnn/core/options.h"
#include "physics/driven.h"
#include "physics/effect_law.h"
#include "physics/rigid.h"
#include "physics/simulator_json.h"

namespace dcnn {
namespace {

using Eigen::RowVector3d;

/// AR(1) of stationary standard deviation `deviation`, starting anew in each segment.
void add_noise(Eigen::MatrixXd& signals, const Motion& motion, double deviation, double ar,
               Rng& rng) {
  if (signals.rows() == 0) return;
  const double fresh = std::sqrt(1.0 - ar * ar);
  for (const Segment& segment : motion.segments) {
    RowVector3d state;
    for (Index k = segment.begin; k < segment.end; ++k) {
      for (Index i = 0; i < 3; ++i) {
        const double draw = rng.normal();
        state(i) = k == segment.begin ? draw : ar * state(i) + fresh * draw;
      }
      signals.row(k) += deviation * state;
    }
  }
}

}  // namespace

Simulator parse_simulator(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  Simulator simulator;
  simulator.model = read_tool_model(options);
  simulator.effects = parse_effects(options.raw("effects"), where, exit);
  if (options.has("derivative"))
    simulator.derivative = parse_derivative(options.child("derivative"));
  if (options.has("online_derivative")) {
    const DerivativeSpec online = parse_derivative(options.child("online_derivative"));
    require(online.kind == DerivativeSpec::Kind::kCausalSavitzkyGolay, exit, where,
            ": 'online_derivative' must be causal: \"kind\": \"sg_causal\"");
    simulator.online_derivative = online;
  }
  options.finish();
  return simulator;
}

Simulator read_simulator(const std::filesystem::path& path) {
  return parse_simulator(read_json(path, Exit::kData), path.string(), Exit::kData);
}

Json to_json(const Simulator& simulator) {
  Json json = to_json(simulator.model);
  if (!simulator.effects.empty()) json["effects"] = to_json(simulator.effects);
  if (simulator.derivative) json["derivative"] = to_json(*simulator.derivative);
  if (simulator.online_derivative) {
    json["online_derivative"] = to_json(*simulator.online_derivative);
  }
  return json;
}

Wrench rigid_wrench(const ToolModel& model, const Motion& motion) {
  const Eigen::MatrixXd felt = felt_acceleration(model, motion);
  Wrench wrench{Eigen::MatrixXd(motion.samples(), 3), Eigen::MatrixXd(0, 3)};
  if (model.inertia) wrench.torque.resize(motion.samples(), 3);
  for (Index k = 0; k < motion.samples(); ++k) {
    const InstantWrench rigid = rigid_at(model, felt.row(k), motion.w_S.row(k), motion.dw_S.row(k));
    wrench.force.row(k) = (rigid.force + model.bias).transpose();
    if (model.inertia) wrench.torque.row(k) = (rigid.torque + model.bias_torque).transpose();
  }
  return wrench;
}

namespace {

/// The effects of one stage in the order of the catalogue.
template <class Act>
void each_of(const std::vector<EffectSpec>& effects, Stage stage, const Act& act) {
  for (const EffectKind* kind : effect_kinds()) {
    if (kind->stage != stage) continue;
    for (const auto& effect : effects) {
      if (effect.effect == kind->name) act(effect);
    }
  }
}

}  // namespace

ToolModel changed_tool(const ToolModel& model, const std::vector<EffectSpec>& effects) {
  ToolModel changed = model;
  each_of(effects, Stage::kTool, [&](const EffectSpec& effect) { change_model(effect, changed); });
  return changed;
}

void pass_on(const std::vector<EffectSpec>& effects, Stage first, const Motion& motion,
             const ToolModel& model, Wrench& wrench, const SensorNoise* noise, Rng* rng) {
  const bool of_load = std::any_of(effects.begin(), effects.end(), [](const EffectSpec& effect) {
    const EffectKind* kind = find_effect(effect.effect);
    return kind && kind->of_load;
  });
  if ((of_load || motion.of_axis) && first == Stage::kForce) wrench.load = wrench.force;
  if (of_load && motion.of_axis) wrench.carried.setZero(wrench.force.rows(), 3);
  for (int s = static_cast<int>(first); s <= static_cast<int>(Stage::kQuantisation); ++s) {
    const auto stage = static_cast<Stage>(s);
    if (stage == Stage::kOffset) {
      add(wrench, {model.bias, model.bias_torque}, Eigen::VectorXd::Ones(motion.samples()));
    }
    if (stage == Stage::kNoise && noise) {
      add_noise(wrench.force, motion, noise->force, noise->ar, *rng);
      add_noise(wrench.torque, motion, noise->torque, noise->ar, *rng);
    }
    each_of(effects, stage,
            [&](const EffectSpec& effect) { apply_effect(effect, motion, model, wrench); });
  }
}

Wrench simulate(const Simulator& simulator, const Motion& motion, const SensorNoise* noise,
                Rng* rng) {
  const ToolModel model = changed_tool(simulator.model, simulator.effects);
  ToolModel without_bias = model;  // the sensor's offset acts after its gain and its filters
  without_bias.bias.setZero();
  without_bias.bias_torque.setZero();
  Wrench wrench = rigid_wrench(without_bias, motion);
  pass_on(simulator.effects, Stage::kForce, motion, model, wrench, noise, rng);
  return wrench;
}

void set_wrench(const Wrench& wrench, const std::string& suffix, Recording& recording) {
  for (Index i = 0; i < 3; ++i) {
    recording.set(std::string("f") + "xyz"[i] + suffix, wrench.force.col(i));
  }
  for (Index i = 0; i < 3 && wrench.torque.rows() > 0; ++i) {
    recording.set(std::string("t") + "xyz"[i] + suffix, wrench.torque.col(i));
  }
}

Motion motion_of(const Recording& recording, const Simulator& simulator,
                 const DerivativeSpec& derivative) {
  Motion motion = motion_of(recording, simulator.model, simulator.derivative.value_or(derivative));
  read_signals(recording, signals_of(simulator.effects), motion);
  return motion;
}

Recording predict_motion(const Simulator& simulator, const Recording& motion,
                         const DerivativeSpec& derivative) {
  const Wrench wrench = simulate(simulator, motion_of(motion, simulator, derivative));
  Recording out = motion;
  set_wrench(wrench, "", out);
  return out;
}

}  // namespace dcnn
