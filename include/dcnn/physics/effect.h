// SPDX-License-Identifier: Apache-2.0
// The catalogue of what can be missing in, or wrong with, the model of a rigid tool.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/core/options.h"
#include "dcnn/physics/motion.h"
#include "dcnn/physics/tool_model.h"

namespace dcnn {

class FoundNumbers;

/// Forces and torques read in S as they pass down the chain of effects.
struct Wrench {
  Eigen::MatrixXd force;   ///< (T,3) N
  Eigen::MatrixXd torque;  ///< (T,3) N·m, or (0,3)
  /// (T,3) N, what is carried before any effect of Stage::kForce; no rows where nothing asks for
  /// it.
  Eigen::MatrixXd load = {};
  /// (T,3) N, what effects add to it that a machine's drive carries as well; no rows where nothing
  /// asks for it.
  Eigen::MatrixXd carried = {};
};

/// What effects see of the motion at one sample, frames as in Motion.
struct Instant {
  bool first = true;  ///< a stretch of time begins: internal states start in equilibrium
  double dt = 0.0;    ///< s, since the sample before
  Eigen::Matrix3d R_BS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d euler = Eigen::Vector3d::Zero();  ///< alpha, beta, gamma of E, continuous
  Eigen::Vector3d v_B = Eigen::Vector3d::Zero(), a_B = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_S = Eigen::Vector3d::Zero(), dw_S = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();
};

/// One row of a Wrench.
struct InstantWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
  Eigen::Vector3d load = Eigen::Vector3d::Zero();     ///< as Wrench::load
  Eigen::Vector3d carried = Eigen::Vector3d::Zero();  ///< as Wrench::carried
  bool of_axis = false;                               ///< as Motion::of_axis
};

/// An effect that runs sample by sample; it owns its state, and calling it allocates nothing.
using EffectStream = std::function<void(InstantWrench&, const Instant&)>;

/// Where in the chain an effect acts: stages run in this order.
enum class Stage {
  kTool,   ///< changes the ToolModel (mass, com, gravity_tilt, inertial_terms)
  kForce,  ///< force on the tool
  kResonance,
  kSensor,    ///< misalignment, gain, crosstalk
  kDynamics,  ///< lowpass, delay
  kOffset,    ///< drifts, bias, hum
  kNoise,     ///< where the simulator adds sensor noise
  kSaturation,
  kQuantisation,
};

/// Which `axis` an effect takes.
enum class AxisRule {
  kNone,    ///< null
  kLine,    ///< tool_z, base_x|y|z, w_sensor_x|y|z
  kSensor,  ///< sensor_x|y|z
  kAngle,   ///< <alpha|beta|gamma>:<sensor_x|y|z, tool_z or base_x|y|z>
};

/// What `interval_s` [a,b] means to an effect.
enum class IntervalRule {
  kNever,     ///< must be absent
  kOptional,  ///< acts in a <= t <= b only; always where absent
  kRequired,  ///< acts in a <= t <= b only
  kOnset,     ///< acts from t >= a; b is where the last recording ends and changes nothing
};

/// One effect as it stands in `hidden` or in a corrected model.json.
struct EffectSpec {
  std::string effect;
  std::string axis;  ///< empty for none
  std::optional<std::pair<double, double>> interval_s;
  Json parameters;
  std::string recording;  ///< acts in this file only; empty for all
  Json law = nullptr;     ///< of a discovered one (dcnn/physics/law.h), else null
};

/// A parameter the force is not linear in: where the diagnosis looks for it.
struct ShapeParameter {
  const char* name;
  double low, high;  ///< bounds; searched on a logarithmic scale where low > 0
  /// Where a search begins; empty where seeds come from the residual.
  std::vector<double> seeds = {};
  /// Bounds and seeds are in rad or m and s; along an axis of a machine of another size they grow
  /// with these powers of its units of length and time.
  int length = 0, time = 0;
  /// What the fastest motion along the axis bounds. kTurning: a speed within which friction turns,
  /// at most half of it, beyond which it is no dry friction but grows with speed. kFalling: a speed
  /// over which friction falls, as far as it. kBending: a speed about which drag grows slower, from
  /// half of it, below which it is dry friction, to five times it, beyond which nothing bends.
  enum class Speed { kAny, kTurning, kFalling, kBending };
  Speed speed = Speed::kAny;
  /// What the likelihood looks like over it. kWide: one maximum over much of the range. kNarrow: as
  /// that of an order or a mode, within some per cent of a seed. kLine: as that of a frequency,
  /// within a part of a turn over all recordings. kComb: a maximum for each turn of the motion.
  enum class Peak { kWide, kNarrow, kLine, kComb };
  Peak peak = Peak::kWide;
};

/// How an effect is found from data: the force is linear in its amplitudes where the shapes are
/// held.
struct EffectFit {
  int amplitudes = 0;         ///< where forces are measured
  int with_torque = 0;        ///< where torques are measured beside them; 0: as many
  bool non_negative = false;  ///< an amplitude below zero refutes the effect (dissipation)
  /// An amplitude beyond it refutes the effect (physical bound).
  double most_strength = std::numeric_limits<double>::infinity();
  std::vector<ShapeParameter> shapes = {};
  /// The published parameters that belong to amplitudes and shapes.
  Json (*parameters)(const Eigen::VectorXd& amplitudes, const Eigen::VectorXd& shapes) = nullptr;
  /// The nearest amplitude that does not refute the effect.
  double bounded(double amplitude) const {
    return std::clamp(amplitude, non_negative ? 0.0 : -most_strength, most_strength);
  }
  enum class Use { kEverywhere, kTools, kMachines, kDriven };
  /// What the diagnosis tries this form on; kDriven: where a logged signal drives the law, alone.
  Use use = Use::kEverywhere;
  /// One number in the place of several of the effect (prior::kSpecial).
  bool special = false;
  /// Tried where gravity points mostly along this base axis (0 to 2); -1: wherever it points.
  int gravity_along = -1;
  /// The second amplitude is no less than the first: below it is another law.
  bool rising = false;
  /// On a tool the second amplitude is at most so many times the first: beyond it is another law.
  double most_ratio = std::numeric_limits<double>::infinity();
};

/// What an effect must know of time: nothing, when a row was taken, or the motion between rows.
enum class TimeNeed { kNone, kClock, kMotion };

/// When an effect shows in what is read.
enum class Shown { kNever, kInMotion, kAlways };

/// What decides whether recordings can show an effect, beyond the signals that it needs.
struct Showing {
  bool on_machine = false;    ///< of one axis of another machine, else of a tool
  bool own_tool = true;       ///< the simulator's tool is known: its mass and its centre of mass
  bool has_inertia = true;    ///< what is simulated has inertia
  bool is_full = true;        ///< the simulator has all inertial terms
  bool several_axes = false;  ///< of one machine, on one clock
  bool reads_motion = false;  ///< what is read is a position or a rate
  bool fitted_base = false;   ///< coefficients of the base simulator are fitted
  bool own_offsets = false;   ///< each recording has an offset of its own
};

/// One law of the catalogue (effects.def), applied in place by simulation and corrected model
/// alike.
struct EffectKind {
  const char* name = nullptr;
  Stage stage = Stage::kForce;
  const char* kind = nullptr;        ///< parameter, structural, sensor or external
  const char* meaning = nullptr;     ///< in words
  const char* on_machine = nullptr;  ///< in words, on an axis of a machine; null: its meaning
  const char* equation = nullptr;    ///< as published
  /// The parameter names with the values used by examples and tests, JSON.
  const char* example = "{}";
  /// Of an effect whose form stands beside its parameters under the key `law`: one, JSON.
  const char* example_law = nullptr;
  AxisRule axis = AxisRule::kNone;
  IntervalRule interval = IntervalRule::kOptional;
  TimeNeed needs_time =
      TimeNeed::kNone;  ///< what it needs to act, else it leaves the wrench as it is
  /// What the diagnosis looks for it on: tools, axes of other machines, or both. kTurning: axes
  /// that turn by rad and whose gravity no description of an arm holds.
  enum class Subject { kAny, kTools, kMachines, kTurning };
  Subject subject = Subject::kAny;
  Shown force = Shown::kAlways, torque = Shown::kAlways;  ///< in the forces, in the torques
  bool of_load = false;                                   ///< needs Wrench::load
  bool is_carried = false;  ///< an axis' drive transmits it: adds to Wrench::carried
  /// A relative of a commoner law, which it must outdo by the price of a number (prior::kSpecial).
  bool special = false;
  /// Nearly every machine has it (prior::kCommon).
  bool common = false;
  /// Its state at the first sample of a recording is one that nobody knows: fitted beside it.
  bool begins_anywhere = false;
  /// Its force acts at a point of the tool, as along a line (has_lever()).
  bool at_a_point = false;
  /// A constant: no error of a law or of the motion comes with it, however large it is.
  bool is_constant = false;
  /// Friction: kDry resists at any speed, so that one law of it acts along a line.
  enum class Friction { kNone, kDry, kOther };
  Friction friction = Friction::kNone;
  /// Over the position of its axis a straight line, a loop or a wave: less than a turn of a wave
  /// beside one of the others is a spring that bends.
  enum class Course { kOther, kStraight, kLoop, kWave };
  Course course = Course::kOther;
  /// Acts once for each value of its first shape that recordings tell from the others, else once
  /// along an axis.
  bool at_many = false;
  /// A number of the simulator that may be wrong by itself: of a tool's, of another machine's.
  enum class Own { kNone, kTools, kMachines };
  Own own = Own::kNone;
  /// The signal of a machine's base simulator (System) that is this law, null where there is none.
  const char* base_signal = nullptr;
  /// The parameter by which the reading is late [s], null where there is none.
  const char* lateness = nullptr;
  /// The parameter that the force is proportional to, the others held: it may follow a logged
  /// signal (parameters driven_by, slope, lag_s); null where there is none.
  const char* strength = nullptr;
  /// Changes the model before anything is computed (Stage::kTool), else null.
  void (*change)(ToolModel&, Options& parameters) = nullptr;
  /// Changes the wrench (other stages), else null. Internal states start in equilibrium with the
  /// first sample of the recording.
  void (*apply)(Wrench&, const Motion&, const EffectSpec&, const ToolModel&,
                Options& parameters) = nullptr;
  /// The same sample by sample; null where the future, the recording's clock or a foreign force is
  /// needed.
  EffectStream (*stream)(const EffectSpec&, Options& parameters) = nullptr;
  /// Whether one that streams does so with these parameters; null: always.
  bool (*online)(const EffectSpec&) = nullptr;
  /// The ways in which its parameters are fitted (thermal_drift has two); empty for what the
  /// diagnosis does not look for.
  std::vector<EffectFit> fits = {};
  /// Whether these amplitudes are the effect's; else another one is meant. Null: always.
  bool (*is_itself)(const Eigen::VectorXd& amplitudes, bool on_machine) = nullptr;
  /// Why recordings cannot show it, in words, or null; null: they can.
  const char* (*hidden_by)(const Showing&) = nullptr;
  /// "dry friction of 0.4 N": what was found, in words, without where it acts; null: its meaning.
  std::string (*words)(const FoundNumbers&) = nullptr;
};

/// The catalogue in the order of effects.def; effects of one stage act in this order.
std::vector<const EffectKind*> effect_kinds();
/// The kind of this name, or null.
const EffectKind* find_effect(const std::string& name);
/// The axes that a rule admits, empty for kNone.
std::vector<std::string> admitted_axes(AxisRule rule);

/// Keys of each entry: effect, axis, interval_s, recording, parameters. An unknown effect, a wrong
/// axis or interval, and a missing, unknown or impossible parameter are Errors(exit).
std::vector<EffectSpec> parse_effects(const Json& list, const std::string& where, Exit exit);
Json to_json(const std::vector<EffectSpec>& effects);

/// Whether the force of an effect may act away from the origin of S: one along a line, or a law,
/// with the optional parameters lever_x_m, lever_y_m, lever_z_m (in S), 0 where they are absent. It
/// then adds the torque lever x force.
bool has_lever(const EffectKind& kind);

/// The effect sample by sample; null where EffectKind::stream is. Errors(exit) name `where`.
EffectStream stream_of(const EffectSpec& effect, const std::string& where, Exit exit);

/// The unit of a published parameter, from the end of its name ("fc_n": N), empty for none.
std::string unit_of_parameter(const std::string& name);
/// The same name without it ("fc").
std::string stem_of_parameter(const std::string& name);

/// Applies one effect of Stage::kTool, or any other one to a wrench, respecting its interval.
void change_model(const EffectSpec& effect, ToolModel& model);
void apply_effect(const EffectSpec& effect, const Motion& motion, const ToolModel& model,
                  Wrench& wrench);

}  // namespace dcnn
