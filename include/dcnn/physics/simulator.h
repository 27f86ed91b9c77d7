// SPDX-License-Identifier: Apache-2.0
// The rigid tool on a wrist sensor and the effects that act on it: motion in, force out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/core/random.h"
#include "dcnn/data/derivative.h"
#include "dcnn/data/recording.h"
#include "dcnn/physics/effect.h"
#include "dcnn/physics/motion.h"
#include "dcnn/physics/tool_model.h"

namespace dcnn {

/// A simulator: the rigid tool and its effects (none in sim.json, those found in model.json).
struct Simulator {
  ToolModel model;
  std::vector<EffectSpec> effects;
  /// How it was fitted to poses; else the caller's choice.
  std::optional<DerivativeSpec> derivative = std::nullopt;
  /// Causal: how it errs least sample by sample; else causal_derivative().
  std::optional<DerivativeSpec> online_derivative = std::nullopt;
};

/// sim.json with an optional list `effects`, an optional `derivative` and `online_derivative`.
Simulator parse_simulator(const Json& json, const std::string& where, Exit exit);
Simulator read_simulator(const std::filesystem::path& path);  ///< Error(kData)
Json to_json(const Simulator& simulator);

/// Force and torque of the rigid tool alone: F = m R^T (g - a_com) + bias, torque
/// about the origin of S: c x m R^T (g - a_o) - I dw - w x (I w) + bias, where an inertia is given.
/// Error(kData) where the motion lacks the acceleration that the model needs.
Wrench rigid_wrench(const ToolModel& model, const Motion& motion);

/// Sensor noise: AR(1) with these stationary standard deviations, independent per axis and segment.
struct SensorNoise {
  double force = 0.0, torque = 0.0;  ///< N, N·m
  double ar = 0.0;                   ///< coefficient in (-1, 1); 0 is white
};

/// All that happens to a wrench from `first` on, stages in order, in place; the bias enters at
/// Stage::kOffset, and noise at Stage::kNoise where `noise` is given (then `rng` must be too).
/// Effects of stages before `first` are left out.
void pass_on(const std::vector<EffectSpec>& effects, Stage first, const Motion& motion,
             const ToolModel& model, Wrench& wrench, const SensorNoise* noise = nullptr,
             Rng* rng = nullptr);

/// The tool as the effects of Stage::kTool change it.
ToolModel changed_tool(const ToolModel& model, const std::vector<EffectSpec>& effects);

/// The whole chain: the rigid wrench of the changed tool, then all other stages.
Wrench simulate(const Simulator& simulator, const Motion& motion,
                const SensorNoise* noise = nullptr, Rng* rng = nullptr);

/// Sets columns fx…fz, and tx…tz where there are torques, each with `suffix`.
void set_wrench(const Wrench& wrench, const std::string& suffix, Recording& recording);

/// The motion with the logged signals that the simulator's effects follow, by the simulator's own
/// derivative where it names one.
Motion motion_of(const Recording& recording, const Simulator& simulator,
                 const DerivativeSpec& derivative);

/// The recording with fx,fy,fz (and tx,ty,tz where the model has an inertia) replaced or added by
/// what the simulator predicts for its motion, by its own derivative where it names one.
Recording predict_motion(const Simulator& simulator, const Recording& motion,
                         const DerivativeSpec& derivative);

}  // namespace dcnn
