// SPDX-License-Identifier: Apache-2.0
#include "experiment/report_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "dcnn/core/number.h"
#include "dcnn/physics/effect.h"
#include "dcnn/physics/effect_words.h"
#include "experiment/markup.h"

namespace dcnn {
namespace {

/// Parameters by their stem: the published name without axis and unit.
const std::map<std::string, std::string>& stem_words() {
  static const std::map<std::string, std::string> kWords{
      {"delta_mass", "mass too much or too little"},
      {"delta_com", "centre of mass off by"},
      {"mass", "mass that moves"},
      {"delta_bias", "offset"},
      {"delta_inertia", "inertia off by"},
      {"tilt", "tilt of the base about"},
      {"fc", "friction force"},
      {"fs", "friction force at standstill"},
      {"v0", "speed scale of its change of sign"},
      {"v1", "speed at which half of the viscous coefficient is lost"},
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
      {"sin", "sine part"},
      {"cos", "cosine part"},
      {"lever", "point where it acts, from the sensor's origin along"},
      {"inertia", "inertia"},
      {"driven_by", "logged signal that its strength follows"},
      {"slope", "growth of its strength with that signal"},
      {"lag", "by how long it comes after that signal"}};
  return kWords;
}

/// Names that mean something else in these laws: "effect.parameter".
const std::map<std::string, std::string>& special_words() {
  static const std::map<std::string, std::string> kWords{
      {"creep.a", "share that settles late"},
      {"gear_friction.a", "variation with the position"},
      {"hysteresis.beta", "shape beta"},
      {"hysteresis.gamma", "shape gamma"},
      {"hysteresis.m", "sharpness"},
      {"step_bias.step", "size of the step"},
      {"quantisation.step", "step of the reading"},
      {"saturation.limit", "limit of the reading"},
      {"thermal_drift.k", "drift per degree"},
      {"crosstalk.c_xy", "share of fy in fx"},
      {"crosstalk.c_xz", "share of fz in fx"},
      {"crosstalk.c_yx", "share of fx in fy"},
      {"crosstalk.c_yz", "share of fz in fy"},
      {"crosstalk.c_zx", "share of fx in fz"},
      {"crosstalk.c_zy", "share of fy in fz"}};
  return kWords;
}

/// Of an axis, which turns or slides: its parameters have no unit in their name.
const std::map<std::string, std::string>& axis_stem_words() {
  static const std::map<std::string, std::string> kWords{
      {"fc", "friction"},
      {"fs", "friction at standstill"},
      {"width", "path over which it reverses"},
      {"rest", "position at rest"},
      {"order", "phase per unit of position, rad"}};
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

/// Factor and name of the unit in which a number of this size is read best.
std::pair<double, std::string> readable(double size, const std::string& unit) {
  if (unit == kShare) return {100.0, "%"};
  for (const SmallerUnit& smaller : kSmallerUnits) {
    if (unit == smaller.unit && std::abs(size) < smaller.below) return {1e3, smaller.name};
  }
  return {1.0, unit_text(unit)};
}

/// Without an exponent where it can be; "–" for what is not finite.
std::string three_digits(double value) {
  return std::isfinite(value) ? brief(value) : significant(value, 3);
}

/// A number of a discovered law, by its stem: "scale_2" belongs to the second of its variables.
std::string words_of_law(const std::string& stem, const std::string& unit) {
  static const std::map<std::string, std::string> kWords{
      {"amplitude", "amplitude"},
      {"scale", "scale"},
      {"centre", "centre"},
      {"power", "exponent"},
      {"gain", "slope"},
      {"memory", "size of the state"},
      {"damping", "damping ratio of the state"},
      {"recovery", "time in which the state recovers"},
      {"spread", "longest time over the shortest"},
      {"falling", "time constant as it falls"},
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
  if (name == "memory" && unit == "s") return "time constant" + of;
  const auto found = kWords.find(name);
  return found == kWords.end() ? "" : found->second + of;
}

std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

/// The axis letters at the end of a stem: "delta_com_x" is {"delta_com", "x"}, "delta_bias_tx"
/// {"delta_bias", "torque about x"}.
std::pair<std::string, std::string> without_letters(const std::string& stem) {
  const auto cut = stem.rfind('_');
  if (cut == stem.npos || cut == 0) return {stem, ""};
  const std::string letters = stem.substr(cut + 1);
  if (letters == "tx" || letters == "ty" || letters == "tz") {
    return {stem.substr(0, cut), std::string("torque about ") + letters.back()};
  }
  const bool axis = letters.size() <= 2 && letters.find_first_not_of("xyz") == letters.npos;
  return axis && !letters.empty() ? std::pair{stem.substr(0, cut), letters}
                                  : std::pair{stem, std::string()};
}

}  // namespace

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

std::string words_of_parameter(const std::string& effect, const std::string& name) {
  if (const auto dot = name.find('.'); dot != name.npos) {  // one law among several of a line
    const std::string law = name.substr(0, dot);
    return words_of_parameter(law, name.substr(dot + 1)) + " of " + words_of_effect(law);
  }
  const auto look_up = [&](const std::string& text) -> std::string {
    for (const auto& [stem, letters] : {std::pair{text, std::string()}, without_letters(text)}) {
      const std::string end = letters.empty() ? "" : ", " + letters;
      const auto special = special_words().find(effect + "." + stem);
      if (special != special_words().end()) return special->second + end;
      const auto of_axis = axis_stem_words().find(stem);
      if (stem == name && of_axis != axis_stem_words().end()) return of_axis->second;
      const auto found = stem_words().find(stem);
      if (found != stem_words().end()) return found->second + end;
    }
    return "";
  };
  for (const std::string& stem : {name, stem_of_parameter(name)}) {
    if (effect == "discovered") {
      const std::string known = words_of_law(stem, unit_of_parameter(name));
      if (!known.empty()) return known;
    } else if (const std::string known = look_up(stem); !known.empty()) {
      return known;
    }
  }
  return spaced(name);
}

std::string unit_in_words(const std::string& effect, const std::string& name,
                          const std::string& unit) {
  static const std::set<std::string> kOfShares{"gain", "crosstalk", "creep"};
  const bool share = kOfShares.contains(effect) || name == "fraction" ||
                     (effect == "gear_friction" && name == "a");
  return unit.empty() && share ? kShare : unit;
}

std::string with_unit(double value, const std::string& unit) {
  const auto [factor, name] = readable(value, unit);
  return three_digits(factor * value) + (name.empty() || name == "1" ? "" : " " + name);
}

std::string with_interval(double value, double low, double high, const std::string& unit) {
  const auto scaled = readable(std::max({std::abs(value), std::abs(low), std::abs(high)}), unit);
  const double factor = scaled.first;
  const std::string name = scaled.second;
  const auto told = [&](const auto& digits) {
    const std::string from = digits(factor * low), to = digits(factor * high);
    return from == to ? std::string()
                      : digits(factor * value) + (name.empty() || name == "1" ? "" : " " + name) +
                            " (" + from + " to " + to + ")";
  };
  // As many digits as tell its ends apart.
  std::string text = told(three_digits);
  for (int more = 4; text.empty() && more <= 6; ++more) {
    text = told([&](double x) { return significant(x, more); });
  }
  return text.empty() ? with_unit(value, unit) : text;
}

}  // namespace dcnn
