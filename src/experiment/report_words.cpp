#include "experiment/report_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "dcnn/physics/effect.h"
#include "experiment/markup.h"

namespace dcnn {
namespace {

/// Parameters by their stem: the published name without axis and unit.
const std::map<std::string, std::string>& stem_words() {
  static const std::map<std::string, std::string> kWords{
      {"delta_mass", "mass too much or too little"},
      {"delta_com", "centre of mass off by"},
      {"delta_bias", "offset"},
      {"delta_inertia", "inertia off by"},
      {"tilt", "tilt of the base about"},
      {"fc", "friction force"},
      {"fs", "friction force at standstill"},
      {"v0", "speed scale of its change of sign"},
      {"vs", "speed above which friction falls"},
      {"c", "viscous coefficient"},
      {"c2", "drag coefficient"},
      {"sigma0", "stiffness before sliding"},
      {"sigma1", "damping before sliding"},
      {"mu", "friction coefficient"},
      {"force", "force"},
      {"width", "angle over which it reverses"},
      {"asym", "asymmetry"},
      {"k", "stiffness"},
      {"k2", "quadratic stiffness"},
      {"rest", "angle at rest"},
      {"delta_c", "difference of the viscous coefficients by direction"},
      {"k3", "cubic stiffness"},
      {"amp", "amplitude"},
      {"order", "periods per turn"},
      {"phase", "phase"},
      {"slug", "moving mass"},
      {"gap", "travel between the stops"},
      {"freq", "frequency"},
      {"zeta", "damping ratio"},
      {"fraction", "share of the force that rings"},
      {"rot", "turn about"},
      {"gain", "scale error"},
      {"delay", "delay"},
      {"tau", "time constant"},
      {"a", "drift"},
      {"t_ref", "reference temperature"},
      {"rate", "growth"},
      {"step", "size of the step"},
      {"limit", "limit"},
      {"sin", "sine part"},
      {"cos", "cosine part"},
      {"inertia", "inertia"}};
  return kWords;
}

constexpr const char* kShare = "share";

/// A unit too large for what is measured in it, and a thousandth of it.
struct SmallerUnit {
  const char *unit, *name;
  double below;  ///< from which size on the smaller one reads better
};
constexpr std::array kSmallerUnits{
    SmallerUnit{"kg", "g", 1.0},     SmallerUnit{"m", "mm", 1.0},
    SmallerUnit{"s", "ms", 0.5},     SmallerUnit{"rad", "mrad", 0.3},
    SmallerUnit{"N", "mN", 0.1},     SmallerUnit{"N*m", "mN·m", 0.1},
    SmallerUnit{"N/s", "mN/s", 0.1}, SmallerUnit{"N*m/s", "mN·m/s", 0.1},
    SmallerUnit{"m/s", "mm/s", 0.1}};

/// "N·s/m" for "N*s/m", "N·s²/m²" for "N*s^2/m^2".
std::string typeset(const std::string& unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const std::string two = unit.substr(i, 2);
    if (two == "^2" || two == "^3") {
      text += two == "^2" ? "²" : "³";
      ++i;
    } else {
      text += unit[i] == '*' ? "·" : std::string(1, unit[i]);
    }
  }
  return text == "degC" ? "°C" : text;
}

/// Factor and name of the unit in which a number of this size is read best.
std::pair<double, std::string> readable(double size, const std::string& unit) {
  if (unit == kShare) return {100.0, "%"};
  for (const SmallerUnit& smaller : kSmallerUnits) {
    if (unit == smaller.unit && std::abs(size) < smaller.below) return {1e3, smaller.name};
  }
  return {1.0, typeset(unit)};
}

/// A number of a discovered law, by its stem: "scale_2" belongs to the second of its variables.
std::string words_of_law(const std::string& stem) {
  static const std::map<std::string, std::string> kWords{{"amplitude", "amplitude"},
                                                         {"scale", "scale"},
                                                         {"centre", "centre"},
                                                         {"power", "exponent"},
                                                         {"gain", "slope"},
                                                         {"memory", "time constant"},
                                                         {"vector_scale", "scale of the direction"},
                                                         {"vector_lag", "delay of the direction"},
                                                         {"lag", "delay"}};
  static constexpr std::array kOrdinals{"first", "second", "third"};
  std::string name = stem;
  std::string of;
  if (name.size() > 2 && name[name.size() - 2] == '_' && name.back() >= '1' && name.back() <= '3') {
    of = std::string(" of the ") + kOrdinals[static_cast<std::size_t>(name.back() - '1')] +
         " variable";
    name.resize(name.size() - 2);
  }
  const auto found = kWords.find(name);
  return found == kWords.end() ? "" : found->second + of;
}

std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

/// The axis letters at the end of a stem: "delta_com_x" is {"delta_com", "x"}.
std::pair<std::string, std::string> without_letters(const std::string& stem) {
  const auto cut = stem.rfind('_');
  if (cut == stem.npos || cut == 0) return {stem, ""};
  const std::string letters = stem.substr(cut + 1);
  const bool axis = letters.size() <= 2 && letters.find_first_not_of("xyz") == letters.npos;
  return axis && !letters.empty() ? std::pair{stem.substr(0, cut), letters}
                                  : std::pair{stem, std::string()};
}

}  // namespace

std::string words_of_effect(const std::string& id) {
  const EffectKind* kind = find_effect(id);
  return kind && kind->meaning ? kind->meaning : spaced(id);
}

std::string words_of_axis(const std::string& axis) {
  if (axis == "tool_z") return "along the tool";
  const auto colon = axis.find(':');
  if (colon != axis.npos) {
    return words_of_axis(axis.substr(colon + 1)) + ", by the angle " + axis.substr(0, colon);
  }
  for (const auto& [start, words] :
       {std::pair{"base_", "along the base's "}, std::pair{"sensor_", "along the sensor's "},
        std::pair{"w_sensor_", "against turning about the sensor's "}}) {
    const std::string begin = start;
    if (axis.starts_with(begin) && axis.size() == begin.size() + 1) {
      return words + axis.substr(begin.size()) + " axis";
    }
  }
  return axis;
}

std::string words_of_signal(const std::string& signal) {
  if (signal == "v_z") return "velocity along the tool";
  if (signal == "t") return "time";
  for (const auto& [start, words] : {std::pair{"v_base_", "velocity along the base's "},
                                     std::pair{"w_", "angular velocity about the sensor's "}}) {
    const std::string begin = start;
    if (signal.starts_with(begin) && signal.size() == begin.size() + 1) {
      return words + signal.substr(begin.size()) + " axis";
    }
  }
  if (signal == "alpha" || signal == "beta" || signal == "gamma") return "angle " + signal;
  return signal;
}

std::string words_of_part(const std::string& part) {
  static const std::map<std::string, std::string> kWords{{"parameter", "own numbers"},
                                                         {"state", "rates, angles"},
                                                         {"memory", "history"},
                                                         {"clock", "time"},
                                                         {"event", "external forces"}};
  const auto known = kWords.find(part);
  return known == kWords.end() ? part : known->second;
}

std::string words_of_parameter(const std::string& name) {
  if (name.size() == 4 && name.starts_with("c_")) {
    std::string text = "share of f";
    text += name[3];
    text += " in f";
    text += name[2];
    return text;
  }
  const auto& words = stem_words();
  const auto look_up = [&](const std::string& text) -> std::string {
    const auto [stem, letters] = without_letters(text);
    const auto found = words.find(stem);
    if (found == words.end()) return "";
    return letters.empty() ? found->second : found->second + ", " + letters;
  };
  if (const std::string whole = look_up(name); !whole.empty()) return whole;
  const auto cut = name.rfind('_');
  if (cut != name.npos && !unit_of_parameter(name).empty()) {
    const std::string stem = name.substr(0, cut);
    if (const std::string known = look_up(stem); !known.empty()) return known;
    if (const std::string known = words_of_law(stem); !known.empty()) return known;
  }
  const std::string known = words_of_law(name);
  return known.empty() ? spaced(name) : known;
}

std::string unit_in_words(const std::string& name, const std::string& unit) {
  const bool share = name.starts_with("gain_") || (name.size() == 4 && name.starts_with("c_")) ||
                     name == "fraction";
  return unit.empty() && share ? kShare : unit;
}

std::string with_unit(double value, const std::string& unit) {
  const auto [factor, name] = readable(value, unit);
  return significant(factor * value, 3) + (name.empty() || name == "1" ? "" : " " + name);
}

std::string unit_text(const std::string& unit) { return typeset(unit); }

std::string with_interval(double value, double low, double high, const std::string& unit) {
  const auto [factor, name] =
      readable(std::max({std::abs(value), std::abs(low), std::abs(high)}), unit);
  return significant(factor * value, 3) + (name.empty() || name == "1" ? "" : " " + name) + " (" +
         significant(factor * low, 3) + " to " + significant(factor * high, 3) + ")";
}

}  // namespace dcnn
