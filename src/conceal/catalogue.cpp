// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "conceal/draws.h"

namespace dcnn::conceal {

const std::vector<std::string>& listed_effects() {
  static const std::vector<std::string> ids{"mass",
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
                                            "hum"};
  return ids;
}

const std::vector<std::string>& unlisted_effects() {
  static const std::vector<std::string> ids{
      "pose_modulated_friction", "velocity_position", "gravity_square", "two_modes",
      "square_load_friction",    "cubic_spring",      "event_train",    "drifting_lugre"};
  return ids;
}

const std::vector<std::string>& hardware_effects() {
  static const std::vector<std::string> ids{"load_friction", "creep", "driven_viscous_friction",
                                            "driven_coulomb_friction", "driven_cable_spring"};
  return ids;
}

std::string undriven(const std::string& id) {
  static const std::string kDriven = "driven_";
  return id.starts_with(kDriven) ? id.substr(kDriven.size()) : id;
}

const std::vector<std::string>& axis_effects() {
  static const std::vector<std::string> ids{"gear_friction", "quadratic_spring",
                                            "asymmetric_friction", "gravity_load"};
  return ids;
}

bool is_listed(const std::string& effect) {
  const auto holds = [&](const std::vector<std::string>& ids) {
    return std::find(ids.begin(), ids.end(), effect) != ids.end();
  };
  return holds(listed_effects()) || holds(hardware_effects()) || holds(axis_effects());
}

const std::vector<Neighbours>& neighbours() {
  static const std::vector<Neighbours> pairs{{"time_delay", "lowpass", false},
                                             {"mass", "bias", false},
                                             {"bias", "gravity_tilt", false},
                                             {"com", "gravity_tilt", false},
                                             {"misalignment", "gravity_tilt", false},
                                             {"coulomb_friction", "viscous_friction", true},
                                             {"viscous_friction", "quadratic_drag", true},
                                             {"cable_spring", "hysteresis", true},
                                             {"linear_drift", "thermal_drift", false},
                                             {"bias", "step_bias", false},
                                             {"gain", "com", false},
                                             {"contact", "step_bias", false}};
  return pairs;
}

bool confounded(const std::string& a, const std::string& b) {
  static const std::vector<std::set<std::string>> families{
      {"coulomb_friction", "stribeck_friction", "lugre_friction", "hysteresis", "load_friction",
       "gear_friction"},
      {"mass", "gain"},                            // a gain of all axes is a mass
      {"misalignment", "crosstalk"},               // a small turn is antisymmetric leakage
      {"gain", "crosstalk"},                       // one matrix, named in two halves
      {"creep", "mass", "gain", "thermal_drift"},  // of a load that hardly changes
      {"quantisation", "saturation"}};             // both are read off the raw values
  return std::any_of(families.begin(), families.end(), [&](const auto& f) {
    return f.count(undriven(a)) != 0 && f.count(undriven(b)) != 0;
  });
}

}  // namespace dcnn::conceal
