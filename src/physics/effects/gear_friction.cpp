// SPDX-License-Identifier: Apache-2.0
#include "core/elementary.h"
#include "physics/friction.h"

namespace dcnn::effects::gear_friction {
namespace {

auto law(Options& parameters) {
  const double fc = parameter(parameters, "fc_n"), v0 = parameter(parameters, "v0_mps", kTiny);
  const double a = parameter(parameters, "a"), order = parameter(parameters, "order");
  const double phase = parameter(parameters, "phase_rad");
  return [=](double v, double q) {
    return fc * (1.0 + a * elementary::sin(order * q + phase)) * elementary::tanh(v / v0);
  };
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const AngleAxis at = angle_axis(spec.axis);
  const auto angle = motion.euler.col(at.angle);
  resist(wrench, at.axis, motion, velocity_of(at.axis, motion),
         [&, law_of_v = law(parameters)](double v, Index k) { return law_of_v(v, angle(k)); });
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  return [at = AngleNow(spec.axis), law_of_v = law(parameters)](InstantWrench& wrench,
                                                                const Instant& now) {
    const double force = law_of_v(at.line.velocity(now), now.euler[at.angle]);
    wrench.force -= force * at.line.n_S(now);
  };
}

/// fc, and the sine and cosine of its variation: the force is linear in them.
Json published(const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
  const double fc = a(0) == 0.0 ? 1e-12 : a(0);
  return {{"fc_n", fc},
          {"a", a.tail(2).norm() / fc},
          {"order", s(0)},
          {"phase_rad", elementary::atan2(a(2), a(1))},
          {"v0_mps", s(1)}};
}

}  // namespace

const EffectKind effect{
    .name = "gear_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "dry friction that varies with the position q, as that of gears",
    .on_machine = "dry friction that varies with the position",
    .equation = "-fc (1 + a sin(order q + phase)) tanh(v/v0) n",
    .example = R"({"fc_n": 0.4, "a": 0.3, "order": 8.0, "phase_rad": 0.5, "v0_mps": 0.01})",
    .axis = AxisRule::kAngle,
    .subject = EffectKind::Subject::kMachines,
    .special = true,
    .friction = EffectKind::Friction::kDry,
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 3,
              .shapes =
                  {{.name = "order",
                    .low = 0.5,
                    .high = 200.0,
                    .length = -1,
                    .peak = ShapeParameter::Peak::kNarrow},
                   {"v0", 3e-4, 0.3, {0.003, 0.012, 0.05}, 1, -1, ShapeParameter::Speed::kTurning}},
              .parameters = published}},
    .is_itself =
        [](const Eigen::VectorXd& a, bool) {  // it resists in every position
          return a(0) > 0.0 && a.tail(2).norm() < a(0);
        },
    .words =
        [](const FoundNumbers& n) {
          return "dry friction of " + n("fc") + " that varies by " + n.plain("a", 100.0) +
                 " % with order " + n.plain("order") + " of the position";
        },
};

}  // namespace dcnn::effects::gear_friction
