// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "conceal/draws.h"
#include "conceal/laws.h"
#include "core/elementary.h"

namespace dcnn::conceal {

using Parameters = std::map<std::string, double>;

bool has(const std::string& list, const std::string& id) {
  return (" " + list + " ").find(" " + id + " ") != std::string::npos;
}

double logarithmic(Rng& rng, double low, double high) {
  return low * elementary::pow(high / low, rng.uniform());
}

namespace {

void vector(Parameters& p, Rng& rng, const std::string& before, const std::string& after,
            double size) {
  for (char a : {'x', 'y', 'z'}) p[before + a + after] = size * rng.normal();
}

/// Strengths are guesses that of_amplitude() scales; shapes are drawn. `swift`: speeds along the
/// axis are so many times those of a translation (angular velocities).
bool draw_friction(const std::string& id, double swift, Rng& rng, Parameters& p) {
  if (has("coulomb_friction stribeck_friction", id)) {
    p = {{"fc_n", 0.3}, {"v0_mps", swift * logarithmic(rng, 0.002, 0.02)}};
  }
  if (id == "stribeck_friction") {
    p["fs_n"] = 0.3 * rng.uniform(1.6, 3.0);
    p["vs_mps"] = swift * logarithmic(rng, 0.02, 0.06);
  }
  if (id == "load_friction") {
    p = {{"mu", 0.05}, {"v0_mps", swift * logarithmic(rng, 0.002, 0.02)}};
  }
  if (id == "gear_friction") {
    p = {{"fc_n", 0.3},
         {"a", rng.uniform(0.2, 0.7)},
         {"order", std::floor(rng.uniform(5.0, 24.0))},
         {"phase_rad", rng.uniform(-3.0, 3.0)},
         {"v0_mps", logarithmic(rng, 0.002, 0.02)}};
  }
  if (id == "asymmetric_friction") p["delta_c_nspm"] = 0.5 / swift;
  if (id == "viscous_friction") p["c_nspm"] = 1.0 / swift;
  if (id == "quadratic_drag") p["c2_ns2pm2"] = 3.0 / (swift * swift);
  if (has("lugre_friction drifting_lugre", id)) {
    const double fc = 0.3, presliding = swift * logarithmic(rng, 0.0005, 0.005);
    p = {{"fc_n", fc},
         {"sigma0_npm", fc / presliding},
         {"sigma1_nspm", rng.uniform(0.1, 1.0) / swift}};
  }
  return !p.empty();
}

/// The tool points down: its roll moves about pi.
double middle_of(const std::string& axis) {
  return axis.rfind("gamma", 0) == 0 ? std::numbers::pi : 0.0;
}

bool draw_tool_force(const std::string& id, const std::string& axis, Rng& rng, Parameters& p) {
  if (id == "hysteresis") {
    p = {{"force_n", 0.2},
         {"width_rad", logarithmic(rng, 0.05, 0.3)},
         {"asym", rng.uniform(0.2, 0.8)}};
  }
  if (id == "cable_spring")
    p = {{"k_nprad", 0.2}, {"rest_rad", middle_of(axis) + rng.uniform(-0.3, 0.3)}};
  if (id == "quadratic_spring")
    p = {{"k2_nprad2", 0.2}, {"rest_rad", middle_of(axis) + rng.uniform(-0.3, 0.3)}};
  if (id == "cogging") {
    p = {{"amp_n", 0.1},
         {"order", std::floor(rng.uniform(5.0, 24.0))},
         {"phase_rad", rng.uniform(-3.0, 3.0)}};
  }
  if (id == "loose_load") p = {{"slug_kg", 0.03}, {"gap_m", rng.uniform(0.003, 0.012)}};
  if (has("contact event_train", id)) vector(p, rng, "force_", "_n", 1.0);
  if (has("flexible_resonance two_modes", id)) {
    p = {{"freq_hz", logarithmic(rng, 4.0, 15.0)},
         {"zeta", logarithmic(rng, 0.01, 0.1)},
         {"fraction", 0.5}};
  }
  return !p.empty();
}

bool draw_parameter(const std::string& id, Rng& rng, Parameters& p) {
  if (id == "mass") p["delta_mass_kg"] = rng.uniform() < 0.5 ? -0.02 : 0.02;
  if (id == "com") vector(p, rng, "delta_com_", "_m", 0.01);
  if (id == "gravity_tilt") {
    p = {{"tilt_x_rad", 0.01 * rng.normal()}, {"tilt_y_rad", 0.01 * rng.normal()}};
  }
  return !p.empty();
}

void draw_thermal(Rng& rng, Parameters& p) {
  if (rng.uniform() < 0.5) {
    vector(p, rng, "k_", "_npk", 0.05);
    p["t_ref_degc"] = rng.uniform(20.0, 24.0);
  } else {
    vector(p, rng, "a_", "_n", 1.0);
    p["tau_s"] = logarithmic(rng, 10.0, 40.0);
  }
}

bool draw_sensor(const std::string& id, Rng& rng, Parameters& p) {
  if (id == "bias") vector(p, rng, "delta_bias_", "_n", 1.0);
  if (id == "misalignment") vector(p, rng, "rot_", "_rad", 0.01);
  if (id == "gain") vector(p, rng, "gain_", "", 0.01);
  if (id == "crosstalk") {
    for (const char* k : {"c_xy", "c_xz", "c_yx", "c_yz", "c_zx", "c_zy"}) {
      p[k] = 0.01 * rng.normal();
    }
  }
  if (id == "time_delay") p["delay_s"] = 0.01;
  if (id == "lowpass") p["tau_s"] = 0.01;
  if (id == "creep") p = {{"a", 0.02}, {"tau_s", logarithmic(rng, 1.0, 15.0)}};
  if (id == "thermal_drift") draw_thermal(rng, p);
  if (id == "linear_drift") vector(p, rng, "rate_", "_nps", 0.01);
  if (id == "step_bias") vector(p, rng, "step_", "_n", 1.0);
  if (id == "saturation") p["limit_n"] = 5.0;
  if (id == "quantisation") p["step_n"] = 0.1;
  if (id == "hum") {
    vector(p, rng, "sin_", "_n", 1.0);
    vector(p, rng, "cos_", "_n", 1.0);
    p["freq_hz"] = logarithmic(rng, 3.0, 120.0);
  }
  return !p.empty();
}

}  // namespace

std::string draw_axis(const std::string& id, Rng& rng) {
  const std::string angle = one_of<std::string>(rng, {"alpha", "beta", "gamma"});
  const std::string sensor = one_of<std::string>(rng, {"sensor_x", "sensor_y", "sensor_z"});
  if (has("cable_spring hysteresis cogging cubic_spring quadratic_spring gear_friction "
          "gravity_square",
          id)) {
    return angle + ":" + sensor;
  }
  if (has("loose_load flexible_resonance saturation two_modes", id)) return sensor;
  if (id.find("friction") == std::string::npos && id != "quadratic_drag" &&
      id != "velocity_position" && id != "drifting_lugre") {
    return "";
  }
  if (rng.uniform() < 0.2) return "w_" + sensor;
  return one_of<std::string>(rng, {"tool_z", "base_x", "base_y", "base_z"});
}

Parameters draw_parameters(const std::string& id, const std::string& axis, Rng& rng) {
  Parameters p;
  if (id == "inertial_terms") return p;
  if (is_drawn_law(id)) return draw_law(rng);
  const double swift = axis.rfind("w_", 0) == 0 ? 8.0 : 1.0;
  if (!draw_friction(id, swift, rng, p) && !draw_tool_force(id, axis, rng, p) &&
      !draw_parameter(id, rng, p) && !draw_sensor(id, rng, p)) {
    p["size"] = 0.3;
  }
  return p;
}

void draw_drive(Hidden& h, Rng& rng) {
  constexpr double kUsual = 21.0;  // degC
  const double share = rng.uniform(0.03, 0.08) * (rng.uniform() < 0.5 ? -1.0 : 1.0);
  double& strength = h.parameters.at(strength_of(h));
  h.parameters["slope"] = share * strength;
  strength *= 1.0 - share * kUsual;
}

}  // namespace dcnn::conceal
