// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/effect.h"

#include <algorithm>

#include "core/lists.h"
#include "dcnn/physics/law.h"
#include "physics/driven.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

const std::vector<std::string> kMovingAxes{"tool_z", "base_x", "base_y", "base_z"};
const std::vector<std::string> kSensorAxes{"sensor_x", "sensor_y", "sensor_z"};

const EffectKind& kind_of(const EffectSpec& spec) {
  const EffectKind* kind = find_effect(spec.effect);
  require(kind, Exit::kData, "effect '", spec.effect, "' is unknown");
  return *kind;
}

std::string read_axis(Options& entry, const EffectKind& kind) {
  const Json given = entry.raw("axis");
  if (kind.axis == AxisRule::kNone) {
    if (!given.is_null()) entry.reject("axis", "must be null for ", kind.name);
    return "";
  }
  const auto admitted = admitted_axes(kind.axis);
  const std::string axis = given.is_string() ? given.get<std::string>() : "";
  if (std::find(admitted.begin(), admitted.end(), axis) == admitted.end()) {
    entry.reject("axis", "of ", kind.name, " must be one of ", joined(admitted), ", not ",
                 given.dump());
  }
  return axis;
}

std::optional<std::pair<double, double>> read_interval(Options& entry, const EffectKind& kind) {
  if (entry.raw("interval_s").is_null()) {
    if (kind.interval == IntervalRule::kRequired || kind.interval == IntervalRule::kOnset) {
      entry.reject("interval_s", "is missing; ", kind.name, " needs [begin, end] in seconds");
    }
    return std::nullopt;
  }
  if (kind.interval == IntervalRule::kNever) {
    entry.reject("interval_s", "must be null: ", kind.name, " acts always");
  }
  const auto ends = entry.get<std::vector<double>>("interval_s");
  if (ends.size() != 2 || !(ends[0] <= ends[1])) {
    entry.reject("interval_s", "must be [begin, end] in seconds with begin <= end");
  }
  return std::pair{ends[0], ends[1]};
}

Eigen::Vector3d read_lever(const EffectKind& kind, Options& parameters) {
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();
  for (Index i = 0; i < 3 && has_lever(kind); ++i) {
    const std::string name = std::string("lever_") + "xyz"[i] + "_m";
    lever(i) = parameters.number(name, 0.0, -kInfinity, kInfinity);
  }
  return lever;
}

/// Lets the law itself read its parameters, on a recording of no length.
void check_parameters(const EffectKind& kind, const EffectSpec& spec, Options parameters) {
  ToolModel model;
  read_lever(kind, parameters);
  read_drive(kind, parameters);
  if (kind.change) {
    kind.change(model, parameters);
  } else {
    Motion motion;
    motion.euler = motion.v_B = motion.a_B = motion.w_S = motion.dw_S = Eigen::MatrixXd(0, 3);
    Wrench wrench{motion.euler, motion.euler, motion.euler};
    kind.apply(wrench, motion, spec, model, parameters);
  }
  parameters.finish();
}

void check_law(Options& law) { law::parse_structure(law); }

EffectSpec parse_effect(Options entry) {
  EffectSpec spec;
  spec.effect = entry.get<std::string>("effect");
  const EffectKind* kind = find_effect(spec.effect);
  if (!kind) {
    std::vector<std::string> names;
    for (const auto* known : effect_kinds()) names.push_back(known->name);
    const auto near = nearest_word(spec.effect, names);
    entry.reject(
        "effect", "'", spec.effect, "' is unknown",
        near.empty() ? "; vocabulary: " + joined(names) : "; did you mean '" + near + "'?");
  }
  spec.axis = read_axis(entry, *kind);
  spec.interval_s = read_interval(entry, *kind);
  spec.recording = entry.get<std::string>("recording", "");
  if (kind->change && !spec.recording.empty()) {
    entry.reject("recording", "must be absent: ", kind->name, " changes the tool itself");
  }
  if (kind->example_law) {
    Options law = entry.child("law");
    check_law(law);
    spec.law = entry.raw("law");
  }
  check_parameters(*kind, spec, entry.child("parameters"));
  spec.parameters = entry.raw("parameters");
  if (spec.parameters.is_null()) spec.parameters = Json::object();
  entry.finish();
  return spec;
}

/// Rows outside the interval stay as `before`.
void keep_outside(const EffectSpec& spec, const EffectKind& kind, const Motion& motion,
                  const Wrench& before, Wrench& wrench) {
  const auto [begin, end] = *spec.interval_s;
  for (Index k = 0; k < motion.samples(); ++k) {
    const bool over = kind.interval != IntervalRule::kOnset && motion.t(k) > end;
    if (motion.t(k) >= begin && !over) continue;
    wrench.force.row(k) = before.force.row(k);
    if (wrench.torque.rows() > 0) wrench.torque.row(k) = before.torque.row(k);
  }
}

}  // namespace

std::vector<const EffectKind*> effect_kinds() {
  return {
#define EFFECT(id) &effects::id::effect,
#include "physics/effects.def"
#undef EFFECT
  };
}

const EffectKind* find_effect(const std::string& name) {
  for (const auto* kind : effect_kinds()) {
    if (kind->name == name) return kind;
  }
  return nullptr;
}

std::vector<std::string> admitted_axes(AxisRule rule) {
  if (rule == AxisRule::kNone) return {};
  if (rule == AxisRule::kSensor) return kSensorAxes;
  std::vector<std::string> axes;
  if (rule == AxisRule::kLine) {
    axes = kMovingAxes;
    for (const auto& axis : kSensorAxes) axes.push_back("w_" + axis);
    return axes;
  }
  for (const std::string angle : {"alpha:", "beta:", "gamma:"}) {
    for (const auto& axis : kSensorAxes) axes.push_back(angle + axis);
    for (const auto& axis : kMovingAxes) axes.push_back(angle + axis);
  }
  return axes;
}

std::vector<EffectSpec> parse_effects(const Json& list, const std::string& where, Exit exit) {
  std::vector<EffectSpec> effects;
  if (list.is_null()) return effects;
  require(list.is_array(), exit, where, ": effects must be a list, not ", list.dump());
  for (std::size_t k = 0; k < list.size(); ++k) {
    effects.push_back(
        parse_effect(Options(list[k], where + ": effect " + std::to_string(k), exit)));
  }
  return effects;
}

Json to_json(const std::vector<EffectSpec>& effects) {
  Json list = Json::array();
  for (const auto& spec : effects) {
    Json entry{{"effect", spec.effect}, {"axis", nullptr}, {"interval_s", nullptr}};
    if (!spec.axis.empty()) entry["axis"] = spec.axis;
    if (spec.interval_s) entry["interval_s"] = {spec.interval_s->first, spec.interval_s->second};
    if (!spec.recording.empty()) entry["recording"] = spec.recording;
    if (!spec.law.is_null()) entry["law"] = spec.law;
    entry["parameters"] = spec.parameters;
    list.push_back(entry);
  }
  return list;
}

bool has_lever(const EffectKind& kind) {
  const bool along_a_line = kind.axis == AxisRule::kLine || kind.axis == AxisRule::kAngle;
  return kind.stage == Stage::kForce &&
         (along_a_line || kind.at_a_point || kind.example_law != nullptr);
}

EffectStream stream_of(const EffectSpec& effect, const std::string& where, Exit exit) {
  const EffectKind& kind = kind_of(effect);
  // No signal of the log is there while the force is predicted.
  if (!kind.stream || effect.parameters.contains("driven_by")) return nullptr;
  Options parameters(effect.parameters, where, exit);
  const Eigen::Vector3d lever = read_lever(kind, parameters);
  EffectStream push = kind.stream(effect, parameters);
  if (kind.is_carried) {
    push = [act = std::move(push)](InstantWrench& wrench, const Instant& now) {
      const Eigen::Vector3d before = wrench.force;
      act(wrench, now);
      wrench.carried += wrench.force - before;
    };
  }
  if (lever.isZero(0.0)) return push;
  return [lever, push = std::move(push)](InstantWrench& wrench, const Instant& now) {
    const Eigen::Vector3d before = wrench.force;
    push(wrench, now);
    wrench.torque += lever.cross(wrench.force - before);
  };
}

std::string unit_of_parameter(const std::string& name) {
  static const std::vector<std::pair<std::string, std::string>> kUnits{
      {"_kg", "kg"},          {"_kgm2", "kg*m^2"}, {"_rad", "rad"},
      {"_nm", "N*m"},         {"_n", "N"},         {"_mps", "m/s"},
      {"_radps", "rad/s"},    {"_mps2", "m/s^2"},  {"_m2ps2", "m^2/s^2"},
      {"_radps2", "rad/s^2"}, {"_nspm", "N*s/m"},  {"_ns2pm2", "N*s^2/m^2"},
      {"_npm", "N/m"},        {"_nprad", "N/rad"}, {"_nprad2", "N/rad^2"},
      {"_nprad3", "N/rad^3"}, {"_hz", "Hz"},       {"_s", "s"},
      {"_nps", "N/s"},        {"_nmps", "N*m/s"},  {"_npk", "N/K"},
      {"_nmpk", "N*m/K"},     {"_degc", "degC"},   {"_m", "m"}};
  for (const auto& [end, unit] : kUnits) {
    if (name.ends_with(end)) return unit;
  }
  return "";
}

std::string stem_of_parameter(const std::string& name) {
  return unit_of_parameter(name).empty() ? name : name.substr(0, name.rfind('_'));
}

void change_model(const EffectSpec& effect, ToolModel& model) {
  Options parameters(effect.parameters, effect.effect, Exit::kData);
  kind_of(effect).change(model, parameters);
}

void apply_effect(const EffectSpec& effect, const Motion& motion, const ToolModel& model,
                  Wrench& wrench) {
  const EffectKind& kind = kind_of(effect);
  if (kind.needs_time == TimeNeed::kMotion && motion.is_static()) return;
  if (kind.needs_time == TimeNeed::kClock && !motion.has_clock) return;
  if (!effect.recording.empty() && effect.recording != motion.recording) return;
  Options parameters(effect.parameters, effect.effect, Exit::kData);
  if (kind.of_load && wrench.load.rows() == 0) wrench.load = wrench.force;
  const Eigen::Vector3d lever = read_lever(kind, parameters);
  const bool turns = wrench.torque.rows() > 0 && !lever.isZero(0.0);
  const bool loads = kind.is_carried && wrench.carried.rows() > 0;
  const Wrench before = effect.interval_s || turns || loads ? wrench : Wrench{};
  if (const auto drive = read_drive(kind, parameters)) {
    apply_driven(*drive, effect, motion, model, wrench);
  } else {
    kind.apply(wrench, motion, effect, model, parameters);
  }
  if (turns) add_moment(lever, before.force, wrench);
  if (effect.interval_s) keep_outside(effect, kind, motion, before, wrench);
  if (loads) wrench.carried += wrench.force - before.force;
}

}  // namespace dcnn
