// SPDX-License-Identifier: Apache-2.0
// Sizes of axes as machines have them, and which effects can be told of them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/axis_draw.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;

bool holds_any(const std::vector<std::string>& effects, const std::string& list) {
  return std::any_of(effects.begin(), effects.end(), [&](const auto& e) { return has(list, e); });
}

double mean_square(const std::vector<AxisPath>& paths, Eigen::VectorXd AxisPath::*signal) {
  double square = 0.0, rows = 0.0;
  for (const AxisPath& path : paths) {
    square += (path.*signal).squaredNorm();
    rows += static_cast<double>((path.*signal).size());
  }
  return square / rows;
}

}  // namespace

AxisBody draw_axis_body(const std::vector<std::string>& effects, Rng& rng) {
  constexpr double kRadians = 2.0 * std::numbers::pi;
  AxisBody b;
  const bool hangs = holds_any(effects, "gravity_load");  // on an axis that turns, in rad
  b.kind = hangs ? one_of<std::string>(rng, {"joint", "motor"})
                 : one_of<std::string>(rng, {"joint", "motor", "motor", "linear", "oscillator"});
  b.hz = logarithmic(rng, 0.1, 2.0);
  if (b.kind == "joint") {
    b.unit = "N*m", b.position_unit = "rad", b.turn = kRadians;
    b.reach = logarithmic(rng, hangs ? 0.8 : 0.1, 2.5), b.effort = logarithmic(rng, 0.05, 300.0);
  } else if (b.kind == "motor") {
    const bool turns = rng.uniform() < 0.3 && !hangs;
    b.unit = "A", b.position_unit = turns ? "turn" : "rad", b.turn = turns ? 1.0 : kRadians;
    b.reach = b.turn * logarithmic(rng, 0.2, 25.0), b.effort = logarithmic(rng, 0.01, 30.0);
  } else if (b.kind == "linear") {
    b.unit = "N", b.position_unit = "m";
    b.reach = logarithmic(rng, 0.005, 1.0), b.effort = logarithmic(rng, 1.0, 1000.0);
  } else {
    b.unit = "V", b.position_unit = "mm";
    b.reach = logarithmic(rng, 0.5, 5.0), b.effort = logarithmic(rng, 1e-3, 5.0);
    b.hz = logarithmic(rng, 0.8, 12.0);
  }
  // A spring of the square or the cube of the position bends where zero lies within the motion.
  const bool about_zero = holds_any(effects, "quadratic_spring cubic_spring");
  b.centre = b.reach * rng.uniform(-0.5, 0.5) * (about_zero ? 0.3 : 1.0);
  return b;
}

void set_rigid(AxisBody& b, const std::string& form, const std::string& left_out,
               const std::vector<AxisPath>& fitted, Rng& rng) {
  std::vector<double> speeds;
  double low = 1e300, high = -1e300;
  for (const AxisPath& path : fitted) {
    for (Index i = 0; i < path.v.size(); i += path.per_row) speeds.push_back(std::abs(path.v(i)));
    low = std::min(low, path.q.minCoeff()), high = std::max(high, path.q.maxCoeff());
  }
  const auto at = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(speeds.size()));
  std::nth_element(speeds.begin(), speeds.begin() + at, speeds.end());
  b.fast = speeds[static_cast<std::size_t>(at)];
  b.wide = 0.5 * (high - low), b.middle = 0.5 * (high + low);
  const double viscous = rng.uniform() < 0.5 ? rng.uniform(0.2, 0.8) : 0.0;
  const double chance = b.kind == "joint" ? 0.6 : (b.kind == "motor" ? 0.15 : 0.0);
  const double drawn = rng.uniform() < chance ? rng.uniform(0.3, 2.0) : 0.0;
  const double gravity = has(left_out, "gravity") ? 0.0 : drawn;
  const double stiff = b.kind == "oscillator" ? rng.uniform(0.3, 2.0) : 0.0;
  b.phase = rng.uniform(-3.0, 3.0);
  if (form == "constant") {
    b.weight = b.effort * (rng.uniform() < 0.5 ? -1.0 : 1.0);
    return;
  }
  const double v = has(left_out, "viscous") ? 0.0 : viscous;
  const double k = has(left_out, "stiffness") ? 0.0 : stiff;
  const double each = b.effort / std::sqrt(1.0 + v * v + gravity * gravity + k * k);
  b.inertia = each / std::sqrt(mean_square(fitted, &AxisPath::a));
  b.viscous = v * each / std::sqrt(mean_square(fitted, &AxisPath::v));
  b.gravity = gravity * each * std::numbers::sqrt2;
  b.stiffness = k * each / std::sqrt(mean_square(fitted, &AxisPath::q));
}

bool can_be_told(const std::string& effect, const std::string& form, const std::string& motion,
                 double resting) {
  // What a linear simulator fits itself, and what changes nothing of a constant.
  if (form == "base" && has("inertia gain", effect)) return false;
  const bool of_sum = has("scale lag mode digits", axis_class(effect)) && effect != "inertia";
  if (form == "constant" &&
      (of_sum || has("load_friction bias root_load_friction load_ripple", effect))) {
    return false;
  }
  // A range passed once shows no spring and no loop.
  if (motion == "one_way" &&
      (axis_class(effect) == "spring" || has("hysteresis asymmetric_friction detent", effect))) {
    return false;
  }
  if (has("wavy_dwell axis_ageing", effect)) {
    return has("trapezoids reaches one_way", motion) && resting >= 0.2;
  }
  return true;
}

}  // namespace dcnn::conceal
