// SPDX-License-Identifier: Apache-2.0
// How a corrected machine is written down: published names, units and signs of an axis.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/physics/axis_machine.h"
#include "physics/axis_law.h"

namespace dcnn {

using Eigen::VectorXd;

namespace {

struct Suffix {
  const char *end, *per;  // the unit in SI of a tool, and what it is for an axis
};

/// Units of an axis: U of what is measured, P of its position.
std::string axis_unit(const std::string& suffix, const Axis& axis) {
  static const std::vector<Suffix> kUnits{
      {"n", "U"},          {"mps", "P/s"},   {"nspm", "U*s/P"},   {"ns2pm2", "U*s^2/P^2"},
      {"npm", "U/P"},      {"nprad", "U/P"}, {"nprad3", "U/P^3"}, {"rad", "P"},
      {"nprad2", "U/P^2"}, {"hz", "Hz"},     {"s", "s"},          {"nps", "U/s"},
      {"npk", "U/K"},      {"degc", "degC"}, {"kg", "U*s^2/P"}};
  const std::string position = axis.position_unit.empty() ? "1" : axis.position_unit;
  for (const Suffix& entry : kUnits) {
    if (suffix != entry.end) continue;
    std::string unit;
    for (const char c : std::string(entry.per)) {
      unit += c == 'U' ? axis.unit : c == 'P' ? position : std::string(1, c);
    }
    return unit;
  }
  return "";
}

}  // namespace

std::optional<AxisParameter> axis_parameter(const EffectKind& kind, const std::string& name,
                                            const Axis& axis, double sense) {
  AxisParameter result{name, "", 1.0, 0.0};
  const auto cut = name.rfind('_');
  std::string suffix = cut == std::string::npos ? "" : name.substr(cut + 1);
  if (!unit_of_parameter(name).empty()) {
    result.unit = axis_unit(suffix, axis);
    result.stem = name.substr(0, cut);
  } else {
    suffix.clear();
  }
  const auto component = result.stem.rfind('_');
  if (component != std::string::npos && component + 2 == result.stem.size()) {
    const char letter = result.stem.back();
    if (letter == 'y' || letter == 'z') return std::nullopt;
    if (letter == 'x') result.stem.resize(component);
  }
  const std::string id = kind.name;
  if (result.stem == "phase") {
    result.unit = "rad";
    result.shift = id == "cogging" && sense > 0.0 ? std::numbers::pi : 0.0;
  }
  // What adds to the reading has the sign of the reading; what resists the motion the reaction's.
  const bool adds = kind.stage == Stage::kOffset || id == "contact";
  if (adds && (suffix.starts_with('n') || name == "slope")) result.sign = -sense;
  return result;
}

namespace {

/// Published parameters of one effect.
Json outer_parameters(const EffectSpec& effect, const Axis& axis, double sense) {
  const EffectKind& kind = *find_effect(effect.effect);
  Json parameters = Json::object();
  for (const auto& [name, value] : effect.parameters.items()) {
    if (value.is_string()) {  // the signal that drives the law
      parameters[name] = value;
      continue;
    }
    const auto outer = axis_parameter(kind, name, axis, sense);
    if (outer) parameters[outer->stem] = outer->sign * value.get<double>() + outer->shift;
  }
  return parameters;
}

/// The parameters of the law from the published ones; components that an axis does not have are 0.
Json inner_parameters(const EffectKind& kind, Json outer, const Axis& axis, double sense,
                      const std::string& where, Exit exit) {
  Json drive = Json::object();  // a logged signal's part has the same names on any machine
  for (const auto& [published, own] : {std::pair{"driven_by", "driven_by"},
                                       std::pair{"slope", "slope"}, std::pair{"lag", "lag_s"}}) {
    if (!outer.contains("driven_by") && drive.empty()) break;
    if (outer.contains(published)) drive[own] = outer[published];
    outer.erase(published);
  }
  for (const EffectFit& form : kind.fits) {
    const Json names = form.parameters(VectorXd::Ones(form.amplitudes),
                                       VectorXd::Ones(static_cast<Index>(form.shapes.size())));
    Json inner = Json::object();
    std::size_t used = 0;
    for (const auto& [name, unused] : names.items()) {
      const auto parameter = axis_parameter(kind, name, axis, sense);
      inner[name] = 0.0;
      if (!parameter) continue;
      const auto found = outer.find(parameter->stem);
      if (!found || !found->is_number()) break;
      inner[name] = parameter->sign * (found->get<double>() - parameter->shift);
      ++used;
    }
    if (used != outer.size() || inner.size() != names.size()) continue;
    inner.update(drive);
    if (drive.contains("slope") && drive["slope"].is_number()) {
      inner["slope"] =
          axis_parameter(kind, "slope", axis, sense)->sign * drive["slope"].get<double>();
    }
    return inner;
  }
  fail(exit, where, ": effect '", kind.name, "' does not take the parameters ", outer.dump());
}

std::string inner_axis(const EffectKind& kind) {
  switch (kind.axis) {
    case AxisRule::kLine:
      return "base_x";
    case AxisRule::kAngle:
      return "alpha:base_x";
    case AxisRule::kSensor:
      return "sensor_x";
    default:
      return "";
  }
}

Json effects_json(const CorrectedAxis& corrected, const Axis& axis) {
  Json list = Json::array();
  for (const EffectSpec& effect : corrected.effects) {
    if (!effect.law.is_null()) {
      list.push_back(outer_law(effect, axis, corrected.sense));
      continue;
    }
    Json entry{{"effect", effect.effect}, {"interval_s", nullptr}};
    if (effect.interval_s) {
      entry["interval_s"] = {effect.interval_s->first, effect.interval_s->second};
    }
    if (!effect.recording.empty()) entry["recording"] = effect.recording;
    entry["parameters"] = outer_parameters(effect, axis, corrected.sense);
    list.push_back(entry);
  }
  return list;
}

std::vector<EffectSpec> effects_from(const Json& list, const Axis& axis, double sense,
                                     const std::string& where, Exit exit) {
  Json inner = Json::array();
  require(list.is_array(), exit, where, ": effects must be a list");
  for (const Json& entry : list) {
    const auto name = entry.is_object() ? entry.value("effect", "") : "";
    const EffectKind* kind = find_effect(name);
    require(kind && entry.contains("parameters") && entry["parameters"].is_object(), exit, where,
            ": effect '", name, "' is unknown or has no parameters");
    if (name == "discovered") {
      inner.push_back(inner_law(entry, axis, sense, where, exit));
      continue;
    }
    Json translated = entry;
    const std::string axis_name = inner_axis(*kind);
    translated["axis"] = axis_name.empty() ? Json() : Json(axis_name);
    translated["parameters"] =
        inner_parameters(*kind, entry["parameters"], axis, sense, where, exit);
    inner.push_back(translated);
  }
  return parse_effects(inner, where, exit);
}

/// The links as they are described.
void set_described(const System& system, std::size_t k, CorrectedAxis& corrected) {
  if (system.arm.is_null() || system.axes[k].has_base || !system.axes[k].simulated.empty()) return;
  const auto bodies = chain_of(system).bodies();
  if (!bodies) return;
  corrected.coefficients = *bodies;
  for (Index i = 0; i < bodies->size(); ++i) corrected.columns.push_back(i);
}

CorrectedAxis parse_corrected(const Json& json, const System& system, std::size_t k,
                              const std::string& where, Exit exit) {
  Options options(json, where, exit);
  CorrectedAxis corrected;
  options.get<std::string>("axis", system.axes[k].name);
  const Json base = options.raw("base");
  const auto names = base_names(system, k);
  std::vector<double> values;
  if (base.is_null()) set_described(system, k, corrected);
  if (base.is_object()) {
    for (const auto& [name, value] : base.items()) {
      const auto found = std::find(names.begin(), names.end(), name);
      require(found != names.end() && value.is_number(), exit, where, ": base '", name,
              "' is not a column of the axis' simulator");
      corrected.columns.push_back(found - names.begin());
      values.push_back(value.get<double>());
    }
  }
  if (!base.is_null()) {
    corrected.coefficients = VectorXd::Map(values.data(), static_cast<Index>(values.size()));
  }
  if (options.has("derivative"))
    corrected.derivative = parse_derivative(options.child("derivative"));
  corrected.sense = options.choice("measured", "drive", {"drive", "reaction"}) == "drive" ? 1 : -1;
  const Json effects = options.raw("effects");
  corrected.effects = effects_from(effects.is_null() ? Json::array() : effects, system.axes[k],
                                   corrected.sense, where, exit);
  options.finish();
  return corrected;
}

}  // namespace

Json to_json(const AxisMachine& machine) {
  Json axes = Json::array();
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    const CorrectedAxis& corrected = machine.axes[k];
    const auto names = base_names(machine.system, k);
    Json base = Json::object();
    for (std::size_t i = 0; i < corrected.columns.size(); ++i) {
      base[names[static_cast<std::size_t>(corrected.columns[i])]] =
          corrected.coefficients(static_cast<Index>(i));
    }
    axes.push_back({{"axis", machine.system.axes[k].name},
                    {"measured", corrected.sense > 0.0 ? "drive" : "reaction"},
                    {"base", base},
                    {"effects", effects_json(corrected, machine.system.axes[k])},
                    {"derivative", to_json(corrected.derivative)}});
  }
  Json json{{"system", machine.system.json}, {"axes", axes}};
  if (machine.payload) json["payload"] = body_json(*machine.payload);
  return json;
}

System system_in(const Json& json, const std::string& where) {
  if (!is_axis_machine(json)) return parse_system(json, where);
  return parse_axis_machine(json, where, Exit::kData).system;
}

AxisMachine with_more(AxisMachine machine, const AxisMachine& found) {
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    CorrectedAxis& axis = machine.axes[k];
    const std::vector<EffectSpec>& more = found.axes[k].effects;
    axis.effects.insert(axis.effects.end(), more.begin(), more.end());
  }
  if (found.payload) {
    machine.payload = machine.payload.value_or(BodyVector::Zero()) + *found.payload;
  }
  return machine;
}

bool is_axis_machine(const Json& json) { return json.is_object() && json.contains("system"); }

AxisMachine machine_of(const System& system) {
  AxisMachine machine{system, {}};
  for (std::size_t k = 0; k < system.axes.size(); ++k) {
    machine.axes.emplace_back();
    set_described(system, k, machine.axes.back());
    require(
        !machine.axes.back().columns.empty(), Exit::kData, "system: axis '", system.axes[k].name,
        "': nothing simulates it; describe the bodies of all links in 'arm', or give a model.json");
  }
  return machine;
}

AxisMachine parse_axis_machine(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  AxisMachine machine;
  machine.system = parse_system(options.raw("system"), where + ": system");
  const Json axes = options.raw("axes");
  require(axes.is_array() && axes.size() == machine.system.axes.size(), exit, where,
          ": 'axes' must hold one entry for each axis of the system");
  for (std::size_t k = 0; k < axes.size(); ++k) {
    machine.axes.push_back(parse_corrected(axes[k], machine.system, k,
                                           where + ": axes[" + std::to_string(k) + "]", exit));
  }
  const Json payload = options.raw("payload");
  if (!payload.is_null()) {
    require(!machine.system.arm.is_null(), exit, where,
            ": key 'payload' needs the arm; give 'arm' in the system description");
    machine.payload = parse_body(payload, where + ": payload", exit);
  }
  options.finish();
  return machine;
}

}  // namespace dcnn
