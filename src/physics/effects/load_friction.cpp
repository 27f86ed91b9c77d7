// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/elementary.h"
#include "physics/friction.h"

namespace dcnn::effects::load_friction {
namespace {

auto law(Options& parameters) {
  const double mu = parameter(parameters, "mu", 0.0);
  const double v0 = parameter(parameters, "v0_mps", kTiny);
  return [=](double v, double load) { return mu * load * elementary::tanh(v / v0); };
}

/// What presses on the guide: the part of the load across n.
double across(const Eigen::Vector3d& load, const Eigen::Vector3d& n) {
  return (load - load.dot(n) * n).norm();
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const auto law_of_v = law(parameters);
  Eigen::VectorXd load(motion.samples());
  if (motion.of_axis) {  // gears and belts: what they transmit
    load = wrench.load.col(0);
    if (wrench.carried.rows() > 0) load += wrench.carried.col(0);
    load = load.cwiseAbs();
  } else {
    const Eigen::MatrixXd n_S = direction_of(spec.axis, motion);
    for (Index k = 0; k < load.size(); ++k) load(k) = across(wrench.load.row(k), n_S.row(k));
  }
  resist(wrench, spec.axis, motion, velocity_of(spec.axis, motion),
         [&](double v, Index k) { return law_of_v(v, load(k)); });
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  return [line = LineNow(spec.axis), law_of_v = law(parameters)](InstantWrench& wrench,
                                                                 const Instant& now) {
    const Eigen::Vector3d n = line.n_S(now);
    const double load =
        wrench.of_axis ? std::abs(wrench.load[0] + wrench.carried[0]) : across(wrench.load, n);
    wrench.force -= law_of_v(line.velocity(now), load) * n;
  };
}

}  // namespace

const EffectKind effect{
    .name = "load_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning =
        "dry friction that grows with the load: across the path of a tool, transmitted by "
        "the drive of an axis",
    .on_machine = "dry friction that grows with the transmitted load",
    .equation = "-mu abs(F_load) tanh(v/v0) n",
    .example = R"({"mu": 0.1, "v0_mps": 0.01})",
    .axis = AxisRule::kLine,
    .of_load = true,
    .special = true,
    .friction = EffectKind::Friction::kOther,
    .strength = "mu",
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 1,
              .non_negative = true,
              .most_strength = 1.0,  // that resists all that is transmitted: nothing would move
              .shapes =
                  {{"v0", 3e-4, 0.3, {0.003, 0.012, 0.05}, 1, -1, ShapeParameter::Speed::kTurning}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"mu", a(0)}, {"v0_mps", s(0)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return "friction of " + n.plain("mu", 100.0) + " % of " +
                 (n.on_machine() ? "what is transmitted" : "the load across the path");
        },
};

}  // namespace dcnn::effects::load_friction
