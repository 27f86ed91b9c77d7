// SPDX-License-Identifier: Apache-2.0
// What an axis' drive needs more for each force of the catalogue, and what its sensor makes of it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/axis_world.h"
#include "conceal/laws.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The drive's effort of a law of one sample: position, velocity, acceleration and rigid effort.
double force_now(const Hidden& h, double q, double v, double a, double rigid) {
  const Parameters& p = h.parameters;
  const std::string& id = h.effect;
  if (id == "cable_spring") return p.at("k_nprad") * (q - p.at("rest_rad"));
  if (id == "quadratic_spring") {
    const double x = q - p.at("rest_rad");
    return p.at("k2_nprad2") * x * x;
  }
  if (id == "cubic_spring") return p.at("k3_nprad3") * q * q * q;
  if (id == "inertia") return p.at("delta_inertia_kg") * a;
  if (id == "cogging") {
    return p.at("amp_n") * elementary::sin(p.at("order") * q + p.at("phase_rad"));
  }
  if (id == "gravity_load") return p.at("amp_n") * elementary::sin(q - p.at("rest_rad"));
  if (id == "load_friction") {
    return p.at("mu") * std::abs(rigid) * elementary::tanh(v / p.at("v0_mps"));
  }
  if (id == "gear_friction") {
    const double swell = p.at("a") * elementary::sin(p.at("order") * q + p.at("phase_rad"));
    return p.at("fc_n") * (1.0 + swell) * elementary::tanh(v / p.at("v0_mps"));
  }
  return friction(h, v);
}

bool is_force(const std::string& id) {
  return has(
      "coulomb_friction viscous_friction stribeck_friction quadratic_drag asymmetric_friction "
      "load_friction gear_friction inertia cable_spring quadratic_spring cubic_spring cogging "
      "gravity_load",
      id);
}

/// Numbers of a sensor of three axes of which the first is read; the others are zero.
Parameters padded(const Parameters& p) {
  Parameters all = p;
  for (const auto& [name, value] : p) {
    const auto x = name.find("_x_");
    if (x == std::string::npos) continue;
    for (const char* other : {"_y_", "_z_"}) {
      std::string same = name;
      all[same.replace(x, 3, other)] = 0.0;
    }
  }
  return all;
}

/// change_reading() of a scalar signal.
void change(const AxisPath& path, const Hidden& h, VectorXd& effort) {
  Path clock;
  clock.start = path.start, clock.step = path.step;
  Hidden sensor = h;
  sensor.axis = "sensor_x";
  sensor.parameters = padded(h.parameters);
  MatrixXd F = MatrixXd::Zero(effort.size(), 3);
  F.col(0) = effort;
  change_reading(clock, sensor, F);
  effort = F.col(0);
}

}  // namespace

void add_axis_force(const AxisPath& path, const Hidden& h, const VectorXd& rigid,
                    VectorXd& effort) {
  if (h.effect == "lugre_friction") effort += lugre(h, path.v, path.step);
  if (h.effect == "hysteresis") effort += bouc_wen(h, path.q);
  if (!is_force(h.effect)) return;
  for (Index i = 0; i < effort.size(); ++i)
    effort(i) += force_now(h, path.q(i), path.v(i), path.a(i), rigid(i));
}

VectorXd rigid_effort(const AxisBody& b, const AxisPath& path) {
  const double w = b.turn > 0.0 ? 2.0 * std::numbers::pi / b.turn : 0.0;
  VectorXd effort = b.inertia * path.a + b.viscous * path.v + b.stiffness * path.q;
  for (Index i = 0; i < effort.size(); ++i) {
    effort(i) += b.weight;
    if (b.gravity != 0.0) effort(i) += b.gravity * elementary::sin(w * path.q(i) + b.phase);
  }
  return effort;
}

VectorXd axis_effort(const AxisBody& body, const AxisPath& path,
                     const std::vector<Hidden>& hidden) {
  const VectorXd rigid = rigid_effort(body, path);
  VectorXd effort = rigid;
  for (const Hidden& h : hidden) {
    if (h.effect == "gain") effort *= 1.0 + h.parameters.at("gain_x");
  }
  for (const Hidden& h : hidden) add_axis_force(path, h, rigid, effort);
  for (const Hidden& h : hidden) {
    if (is_axis_law(h.effect)) add_axis_law(body, path, h, rigid, effort);
  }
  for (const char* id : {"flexible_resonance", "creep", "lowpass", "time_delay", "bias",
                         "thermal_drift", "linear_drift", "step_bias", "hum"}) {
    for (const Hidden& h : hidden) {
      if (h.effect == id) change(path, h, effort);
    }
  }
  return effort;
}

VectorXd lagged(const AxisPath& path, const VectorXd& signal, double tau) {
  VectorXd out = signal;
  if (tau <= 0.0) return out;
  Hidden lag;
  lag.effect = "lowpass";
  lag.parameters = {{"tau_s", tau}};
  change(path, lag, out);
  return out;
}

}  // namespace dcnn::conceal
