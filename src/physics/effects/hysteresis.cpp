// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn::effects::hysteresis {
namespace {

constexpr double kLargest = 1e12;  // of z: with beta + gamma < 0 it grows without end

/// Solves dy/du = 1 - rate·y exactly from y over u.
double relax(double y, double u, double rate) {
  constexpr double kFinite = 600.0;  // of an exponent
  if (std::abs(rate) < 1e-9) return y + u;
  return y + (1.0 / rate - y) * -elementary::expm1(std::min(kFinite, -rate * u));
}

/// The way u in which y < 0 comes to 0 under dy/du = 1 - rate·y; never where that is negative.
double way_to_zero(double y, double rate) {
  if (rate * y >= 1.0) return kInfinity;
  return std::abs(rate) < 1e-9 ? -y : elementary::log1p(-rate * y) / rate;
}

/// Bouc-Wen (Wen 1976) along a turn dq = sign·u·width: with y = sign·z it is
/// dy/du = 1 - rate·abs(y)^(m-1)·y, where rate is beta + gamma above zero and beta - gamma below.
struct Shape {
  double width = 1.0, above = 1.0, below = 1.0, m = 1.0;
};

Shape read_shape(Options& parameters) {
  Shape shape;
  shape.width = parameter(parameters, "width_rad", kTiny);
  if (parameters.has("beta") || parameters.has("gamma") || parameters.has("m")) {
    const double beta = parameter(parameters, "beta"), gamma = parameter(parameters, "gamma");
    shape.above = beta + gamma;
    shape.below = beta - gamma;
    shape.m = parameters.number("m", 1.0, 1.0, 10.0);
  } else {
    shape.below = 1.0 - 2.0 * parameter(parameters, "asym", 0.0, 1.0);
  }
  return shape;
}

/// m = 1: exact, above zero and below it.
double turn_linear(double y, double u, const Shape& shape) {
  if (y < 0.0) {
    const double crossing = way_to_zero(y, shape.below);
    if (u < crossing) return relax(y, u, shape.below);
    u -= crossing;
    y = 0.0;
  }
  return relax(y, u, shape.above);
}

/// Else steps that are exact for the rate in their middle.
double turn_bent(double y, double u, const Shape& shape) {
  constexpr double kStep = 0.02;
  constexpr double kMostSteps = 2000.0;
  const auto rate = [&](double at) {
    return (at < 0.0 ? shape.below : shape.above) * elementary::pow(std::abs(at), shape.m - 1.0);
  };
  const int steps = static_cast<int>(std::clamp(std::ceil(u / kStep), 1.0, kMostSteps));
  const double h = u / steps;
  for (int i = 0; i < steps; ++i) {
    const double middle = relax(y, 0.5 * h, rate(y));
    y = std::clamp(relax(y, h, rate(middle)), -kLargest, kLargest);
  }
  return y;
}

double turn(double z, double dq, const Shape& shape) {
  const double sign = std::copysign(1.0, dq), u = std::abs(dq) / shape.width;
  const double y = shape.m == 1.0 ? turn_linear(sign * z, u, shape) : turn_bent(sign * z, u, shape);
  return sign * std::clamp(y, -kLargest, kLargest);
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double force = parameter(parameters, "force_n");
  const Shape shape = read_shape(parameters);
  const AngleAxis at = angle_axis(spec.axis);
  const auto angle = motion.euler.col(at.angle);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(motion.samples());
  double z = 0.0;
  for (Index k = 1; k < motion.samples(); ++k) {
    z = turn(z, angle(k) - angle(k - 1), shape);
    pull(k) = -force * z;
  }
  push_along(at.axis, motion, pull, wrench);
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  const double force = parameter(parameters, "force_n");
  const Shape shape = read_shape(parameters);
  return [=, at = AngleNow(spec.axis), z = 0.0, before = 0.0](InstantWrench& wrench,
                                                              const Instant& now) mutable {
    const double angle = now.euler[at.angle];
    z = now.first ? 0.0 : turn(z, angle - before, shape);
    before = angle;
    wrench.force -= force * z * at.line.n_S(now);
  };
}

/// Of a machine by the force at which Bouc-Wen's law settles, 1/(beta + gamma)^(1/m) of its scale,
/// which is none where its 95 % interval does not say that the law settles: then by its stiffness
/// after a turn.
std::string words(const FoundNumbers& n) {
  if (!n.on_machine()) return "a cable with hysteresis of " + n.size("force");
  if (!n.has("beta")) return "hysteresis of " + n.size("force");
  const double beta = n.value("beta"), rate = beta + n.value("gamma");
  if (rate > 0.0 && !n.holds("gamma", -beta)) {
    return "hysteresis of " + n.size("force", elementary::pow(rate, -1.0 / n.value("m")));
  }
  return "hysteresis that grows by " + n.size("force", 1.0 / n.value("width"), n.unit("width")) +
         " after a turn back";
}

}  // namespace

const EffectKind effect{
    .name = "hysteresis",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "cable with Bouc-Wen hysteresis over one coordinate",
    .on_machine = "Bouc-Wen hysteresis over the position",
    .equation =
        "dz = (dq/w)(1 - beta sign(dq) abs(z)^(m-1) z - gamma abs(z)^m); -force z n; "
        "beta = 1 - asym, gamma = asym, m = 1 where asym is given",
    .example = R"({"force_n": 0.3, "width_rad": 0.2, "asym": 0.4})",
    .axis = AxisRule::kAngle,
    .needs_time = TimeNeed::kMotion,
    .begins_anywhere = true,
    .course = EffectKind::Course::kLoop,
    .strength = "force_n",
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 1,
              .shapes = {{"width", 5e-3, 3.0, {0.05, 0.15, 0.4}, 1}, {"asym", 0.0, 1.0, {0.5}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"force_n", a(0)}, {"width_rad", s(0)}, {"asym", s(1)}};
                  }},
             // The other sign of gamma: a curve that steepens after a turn back. A change of all
             // of force, width, beta and gamma leaves the law as it is; beta is 1.
             {.amplitudes = 1,
              .shapes = {{"width", 5e-3, 3.0, {0.05, 0.15, 0.4}, 1},
                         {"gamma", -4.0, 0.0, {-0.6, -1.4}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"force_n", a(0)},
                                {"width_rad", s(0)},
                                {"beta", 1.0},
                                {"gamma", s(1)},
                                {"m", 1.0}};
                  },
              .use = EffectFit::Use::kMachines}},
    // On an axis the position says which way a force resists.
    .is_itself = [](const Eigen::VectorXd& a,
                    bool on_machine) { return !on_machine || a(0) > 0.0; },
    .words = words,
};

}  // namespace dcnn::effects::hysteresis
