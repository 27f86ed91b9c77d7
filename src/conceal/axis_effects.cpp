// SPDX-License-Identifier: Apache-2.0
// The catalogue of an axis: what each effect is, its shapes drawn, its strength set.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "conceal/axis_world.h"
#include "dcnn/conceal/axis.h"
#include "dcnn/core/error.h"

namespace dcnn::conceal {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kRound2 = 2.0 * std::numbers::pi;

/// An effect of the catalogue; `strengths` are the numbers that make it stronger and leave its
/// shape, `most` what the first of them may become (of times: in periods of the motion).
struct AxisEffect {
  const char* id;
  const char* kind;
  const char* strengths;
  double most = kUnbounded;
};
const std::vector<AxisEffect>& axis_effect_list() {
  static const std::vector<AxisEffect> list{
      {"coulomb_friction", "friction", "fc_n"},
      {"viscous_friction", "friction", "c_nspm"},
      {"stribeck_friction", "friction", "fc_n fs_n"},
      {"quadratic_drag", "friction", "c2_ns2pm2"},
      {"asymmetric_friction", "friction", "delta_c_nspm"},
      {"lugre_friction", "friction", "fc_n sigma0_npm sigma1_nspm"},
      {"load_friction", "friction", "mu", 0.8},
      {"gear_friction", "friction", "fc_n"},
      {"hysteresis", "friction", "force_n"},
      {"inertia", "scale", "delta_inertia_kg"},
      {"gain", "scale", "gain_x", 0.6},
      {"cable_spring", "spring", "k_nprad"},
      {"quadratic_spring", "spring", "k2_nprad2"},
      {"cubic_spring", "spring", "k3_nprad3"},
      {"cogging", "ripple", "amp_n"},
      {"gravity_load", "ripple", "amp_n"},
      {"flexible_resonance", "mode", "fraction", 0.9},
      {"creep", "lag", "a", 0.8},
      {"lowpass", "lag", "tau_s", 0.05},
      {"time_delay", "lag", "delay_s", 0.05},
      {"bias", "offset", "delta_bias_x_n"},
      {"thermal_drift", "offset", "a_x_n"},
      {"linear_drift", "offset", "rate_x_nps"},
      {"step_bias", "offset", "step_x_n"},
      {"hum", "offset", "sin_x_n cos_x_n"},
      {"saturation", "digits", ""},
      {"quantisation", "digits", "step_n"}};
  return list;
}
const AxisEffect* find_axis_effect(const std::string& id) {
  for (const AxisEffect& effect : axis_effect_list()) {
    if (id == effect.id) return &effect;
  }
  return nullptr;
}

double side_of(Rng& rng) { return rng.uniform() < 0.5 ? -1.0 : 1.0; }

/// Order of a ripple [rad per unit of position]: one that turns has 1 to 200 periods a turn, a
/// slide a pitch; at least two periods in the range, and no faster than `hz` at the usual speed.
double draw_order(const AxisBody& b, double hz, Rng& rng) {
  const double least = kRound2 / b.wide, most = std::max(1.5 * least, kRound2 * hz / b.fast);
  if (b.turn <= 0.0) return logarithmic(rng, least, std::min(most, 60.0 * least));
  const double whole = kRound2 / b.turn;
  const double low = std::max(1.0, std::ceil(least / whole)),
               high = std::clamp(std::floor(most / whole), low, 200.0);
  return whole * std::round(logarithmic(rng, low, high));
}

void draw_axis_friction(const AxisBody& b, Rng& rng, Hidden& h) {
  auto& p = h.parameters;
  const double width = b.fast * logarithmic(rng, 0.005, 0.05);
  if (has("coulomb_friction stribeck_friction gear_friction", h.effect)) {
    p = {{"fc_n", b.effort}, {"v0_mps", width}};
  }
  if (h.effect == "stribeck_friction") {
    p["fs_n"] = b.effort * rng.uniform(1.4, 2.5);
    p["vs_mps"] = b.fast * logarithmic(rng, 0.08, 0.3);
  }
  if (h.effect == "load_friction") p = {{"mu", 0.1}, {"v0_mps", width}};
  if (h.effect == "gear_friction") {
    p["a"] = rng.uniform(0.3, 0.8);
    p["order"] = draw_order(b, 8.0 * b.hz, rng);
    p["phase_rad"] = rng.uniform(-3.0, 3.0);
  }
  if (h.effect == "viscous_friction") p["c_nspm"] = b.effort / b.fast;
  if (h.effect == "quadratic_drag") p["c2_ns2pm2"] = b.effort / (b.fast * b.fast);
  if (h.effect == "asymmetric_friction") p["delta_c_nspm"] = side_of(rng) * b.effort / b.fast;
  if (h.effect == "lugre_friction") {
    const double slip = b.wide * logarithmic(rng, 0.004, 0.04);
    p = {{"fc_n", b.effort},
         {"sigma0_npm", b.effort / slip},
         {"sigma1_nspm", rng.uniform(0.05, 0.3) * b.effort / b.fast}};
  }
  if (h.effect == "hysteresis") {
    p = {{"force_n", b.effort},
         {"width_rad", b.wide * logarithmic(rng, 0.05, 0.4)},
         {"asym", rng.uniform(0.2, 0.8)}};
  }
}

void draw_axis_place(const AxisBody& b, Rng& rng, Hidden& h) {
  auto& p = h.parameters;
  const double x = std::abs(b.middle) + b.wide;  // largest position
  if (h.effect == "cable_spring") {
    p = {{"k_nprad", b.effort / b.wide}, {"rest_rad", b.middle + b.wide * rng.uniform(-0.5, 0.5)}};
  }
  if (h.effect == "quadratic_spring") {
    p = {{"k2_nprad2", side_of(rng) * b.effort / (x * x)}, {"rest_rad", 0.0}};
  }
  if (h.effect == "cubic_spring") p["k3_nprad3"] = b.effort / (x * x * x);
  if (h.effect == "cogging") {
    p = {{"amp_n", b.effort},
         {"order", draw_order(b, 12.0 * b.hz, rng)},
         {"phase_rad", rng.uniform(-3.0, 3.0)}};
  }
  if (h.effect == "gravity_load") {
    p = {{"amp_n", b.effort}, {"rest_rad", rng.uniform(-3.0, 3.0)}};
  }
}

void draw_axis_sensor(const AxisBody& b, Rng& rng, Hidden& h) {
  auto& p = h.parameters;
  if (h.effect == "inertia") {
    const double usual = b.effort / (b.fast * kRound2 * b.hz);
    p["delta_inertia_kg"] = b.inertia > 0.0 ? side_of(rng) * usual : usual;
  }
  if (h.effect == "gain") p["gain_x"] = side_of(rng) * 0.05;
  if (h.effect == "flexible_resonance") {
    p = {{"freq_hz", b.hz * logarithmic(rng, 3.0, 10.0)},
         {"zeta", logarithmic(rng, 0.02, 0.1)},
         {"fraction", 0.3}};
  }
  if (h.effect == "creep") p = {{"a", 0.1}, {"tau_s", logarithmic(rng, 1.0, 10.0)}};
  if (h.effect == "lowpass") p["tau_s"] = 0.01 / b.hz;
  if (h.effect == "time_delay") p["delay_s"] = (rng.uniform() < 0.25 ? -0.01 : 0.01) / b.hz;
  if (h.effect == "bias") p["delta_bias_x_n"] = side_of(rng) * b.effort;
  if (h.effect == "thermal_drift") {
    p = {{"a_x_n", side_of(rng) * b.effort}, {"tau_s", logarithmic(rng, 5.0, 40.0)}};
  }
  if (h.effect == "linear_drift") p["rate_x_nps"] = side_of(rng) * 0.01 * b.effort;
  if (h.effect == "step_bias") p["step_x_n"] = side_of(rng) * b.effort;
  if (h.effect == "hum") {
    p = {{"freq_hz", b.hz * logarithmic(rng, 4.0, 15.0)},
         {"sin_x_n", b.effort * rng.normal()},
         {"cos_x_n", b.effort * rng.normal()}};
  }
  if (h.effect == "saturation") p["limit_n"] = b.effort;
  if (h.effect == "quantisation") p["step_n"] = 0.1 * b.effort;
}

}  // namespace

const std::vector<std::string>& axis_catalogue() {
  static const std::vector<std::string> ids = [] {
    std::vector<std::string> names;
    for (const AxisEffect& effect : axis_effect_list()) names.emplace_back(effect.id);
    return names;
  }();
  return ids;
}

std::string axis_class(const std::string& effect) {
  if (const AxisEffect* listed = find_axis_effect(effect)) return listed->kind;
  return is_axis_law(effect) ? class_of_axis_law(effect) : "";
}

Hidden draw_axis_effect(const std::string& id, const AxisBody& body, Rng& rng) {
  Hidden h;
  h.effect = id;
  if (is_axis_law(id)) {
    h.parameters = draw_axis_law(id, body, rng);
    return h;
  }
  require(find_axis_effect(id) != nullptr, Exit::kUsage, "no effect of an axis is called ", id);
  draw_axis_friction(body, rng, h);
  draw_axis_place(body, rng, h);
  draw_axis_sensor(body, rng, h);
  return h;
}

Hidden stronger(Hidden h, const AxisBody& body, double factor) {
  if (is_axis_law(h.effect)) {
    h.parameters["size"] *= factor;
    return h;
  }
  const AxisEffect& kind = *find_axis_effect(h.effect);
  const std::string strengths = kind.strengths;
  const std::string first = strengths.substr(0, strengths.find(' '));
  if (first.empty()) return h;
  const bool time = has("lowpass time_delay", h.effect);
  double most = time ? kind.most / body.hz : kind.most;
  const double now = h.parameters.at(first);
  if (h.effect == "inertia" && now < 0.0) most = 0.7 * body.inertia;  // something must remain
  factor = std::min(factor, most / std::abs(now));
  for (auto& [name, value] : h.parameters) {
    if (has(strengths, name)) value *= factor;
  }
  return h;
}

}  // namespace dcnn::conceal
