// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "physics/friction.h"

namespace dcnn::effects::lugre_friction {
namespace {

/// Mean deflection z of the bristles (Canudas de Wit et al. 1995) after a way of one direction:
/// dz/dt = v - abs(v) z/reach with reach = fc/sigma0 is dz = (sign - z/reach) ds, exponential in
/// the way s [m or rad], whatever the speed. `reach` has the sign of the direction.
double deflect(double z, double way, double reach) {
  return reach + (z - reach) * elementary::exp(-way / std::abs(reach));
}

/// One step of h seconds with the velocity running linearly from v0 to v1: exact, in two parts
/// where the direction changes.
double advance(double z, double v0, double v1, double h, double reach) {
  const double from = std::abs(v0), to = std::abs(v1);
  if (v0 * v1 >= 0.0) {
    return deflect(z, 0.5 * (from + to) * h, std::copysign(reach, v0 == 0.0 ? v1 : v0));
  }
  const double part = 0.5 * h / (from + to);
  z = deflect(z, from * from * part, std::copysign(reach, v0));
  return deflect(z, to * to * part, std::copysign(reach, v1));
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double fc = parameter(parameters, "fc_n", 0.0);
  const double sigma0 = parameter(parameters, "sigma0_npm", kTiny);
  const double sigma1 = parameter(parameters, "sigma1_nspm", 0.0);
  if (fc == 0.0) return;  // bristles without strength never deflect
  const double reach = fc / sigma0;
  const Eigen::VectorXd velocity = velocity_of(spec.axis, motion);
  double z = 0.0;
  resist(wrench, spec.axis, motion, velocity, [&](double v, Index k) {
    if (k > 0) z = advance(z, velocity(k - 1), v, step(motion, k), reach);
    return sigma0 * z + sigma1 * (v - std::abs(v) * z / reach);
  });
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  const double fc = parameter(parameters, "fc_n", 0.0);
  const double sigma0 = parameter(parameters, "sigma0_npm", kTiny);
  const double sigma1 = parameter(parameters, "sigma1_nspm", 0.0);
  if (fc == 0.0) return [](InstantWrench&, const Instant&) {};
  return [=, reach = fc / sigma0, line = LineNow(spec.axis), z = 0.0, before = 0.0](
             InstantWrench& wrench, const Instant& now) mutable {
    const double v = line.velocity(now);
    z = now.first ? 0.0 : advance(z, before, v, now.dt, reach);
    before = v;
    wrench.force -= (sigma0 * z + sigma1 * (v - std::abs(v) * z / reach)) * line.n_S(now);
  };
}

}  // namespace

const EffectKind effect{
    .name = "lugre_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "friction with elastic presliding",
    .on_machine = "presliding friction",
    .equation = "dz/dt = v - abs(v) z sigma0/fc; -(sigma0 z + sigma1 dz/dt) n",
    .example = R"({"fc_n": 0.4, "sigma0_npm": 2000.0, "sigma1_nspm": 2.0})",
    .axis = AxisRule::kLine,
    .needs_time = TimeNeed::kMotion,
    .friction = EffectKind::Friction::kDry,
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 1,
              .non_negative = true,
              // fc/sigma0, the reach of the bristles, and sigma1/sigma0: the force is linear in fc.
              .shapes = {{"reach", 2e-5, 0.1, {3e-4, 1e-3, 4e-3}, 1},
                         {"damping", 1e-5, 0.3, {1e-3}, 0, 1}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"fc_n", a(0)},
                                {"sigma0_npm", std::max(a(0), 1e-12) / s(0)},
                                {"sigma1_nspm", a(0) / s(0) * s(1)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return n.is_told("sigma0")
                     ? "friction of " + n("fc") + " that first gives way elastically"
                     : "dry friction of " + n("fc");
        },
};

}  // namespace dcnn::effects::lugre_friction
