// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/elementary.h"
#include "physics/friction.h"

namespace dcnn::effects::lugre_friction {
namespace {

constexpr double kLeastFall = 0.01;  // less is none: a tolerance

/// Mean deflection z of the bristles (Canudas de Wit et al. 1995) after a way of one direction:
/// dz/dt = v - abs(v) z/reach with reach = g/sigma0 is dz = (sign - z/reach) ds, exponential in
/// the way s [m or rad] where g is constant. `reach` has the sign of the direction.
double deflect(double z, double way, double reach) {
  return reach + (z - reach) * elementary::exp(-way / std::abs(reach));
}

struct Bristles {
  double sigma0, sigma1;
  double reach;       ///< fc/sigma0
  double rise = 0.0;  ///< fs/fc - 1: g(v) = fc (1 + rise exp(-(v/vs)^2)), Stribeck's curve
  double vs = 1.0;

  double reach_at(double speed) const {
    return reach * (1.0 + rise * elementary::exp(-(speed / vs) * (speed / vs)));
  }
  /// One step of h seconds with the velocity running linearly from v0 to v1, g that of its mean
  /// size: exact where g is constant, in two parts where the direction changes.
  double advance(double z, double v0, double v1, double h) const {
    const double from = std::abs(v0), to = std::abs(v1);
    const double far = rise == 0.0 ? reach : reach_at(0.5 * (from + to));
    if (v0 * v1 >= 0.0) {
      return deflect(z, 0.5 * (from + to) * h, std::copysign(far, v0 == 0.0 ? v1 : v0));
    }
    const double part = 0.5 * h / (from + to);
    z = deflect(z, from * from * part, std::copysign(far, v0));
    return deflect(z, to * to * part, std::copysign(far, v1));
  }
  double force(double z, double v) const {
    const double far = rise == 0.0 ? reach : reach_at(v);
    return sigma0 * z + sigma1 * (v - std::abs(v) * z / far);
  }
};

/// Nothing where bristles without strength never deflect.
std::optional<Bristles> bristles_of(Options& parameters) {
  const double fc = parameter(parameters, "fc_n", 0.0);
  const double sigma0 = parameter(parameters, "sigma0_npm", kTiny);
  Bristles bristles{sigma0, parameter(parameters, "sigma1_nspm", 0.0), fc / sigma0};
  if (parameters.has("fs_n") || parameters.has("vs_mps")) {
    const double fs = parameter(parameters, "fs_n", fc);
    bristles.vs = parameter(parameters, "vs_mps", kTiny);
    bristles.rise = fc > 0.0 ? fs / fc - 1.0 : 0.0;
  }
  if (fc == 0.0) return std::nullopt;
  return bristles;
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const auto bristles = bristles_of(parameters);
  if (!bristles) return;
  const Eigen::VectorXd velocity = velocity_of(spec.axis, motion);
  double z = 0.0;
  resist(wrench, spec.axis, motion, velocity, [&](double v, Index k) {
    if (k > 0) z = bristles->advance(z, velocity(k - 1), v, step(motion, k));
    return bristles->force(z, v);
  });
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  const auto bristles = bristles_of(parameters);
  if (!bristles) return [](InstantWrench&, const Instant&) {};
  return [of = *bristles, line = LineNow(spec.axis), z = 0.0, before = 0.0](
             InstantWrench& wrench, const Instant& now) mutable {
    const double v = line.velocity(now);
    z = now.first ? 0.0 : of.advance(z, before, v, now.dt);
    before = v;
    wrench.force -= of.force(z, v) * line.n_S(now);
  };
}

}  // namespace

const EffectKind effect{
    .name = "lugre_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "friction with elastic presliding",
    .on_machine = "presliding friction",
    .equation =
        "dz/dt = v - abs(v) z sigma0/g; -(sigma0 z + sigma1 dz/dt) n; g = fc, or fc + "
        "(fs-fc) exp(-(v/vs)^2) where fs and vs are given",
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
                  }},
             {.amplitudes = 1,
              .non_negative = true,
              // The same, the speed over which it falls, and fs/fc.
              .shapes = {{"reach", 2e-5, 0.1, {3e-4, 1e-3, 4e-3}, 1},
                         {"damping", 1e-5, 0.3, {1e-3}, 0, 1},
                         {"vs", 1e-3, 1.0, {0.03, 0.1}, 1, -1, ShapeParameter::Speed::kFalling},
                         {"ratio", 1.0 + kLeastFall, kMostAtRest, {1.5}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"fc_n", a(0)},
                                {"fs_n", a(0) * s(3)},
                                {"vs_mps", s(2)},
                                {"sigma0_npm", std::max(a(0), 1e-12) / s(0)},
                                {"sigma1_nspm", a(0) / s(0) * s(1)}};
                  },
              .use = EffectFit::Use::kMachines,
              .special = true}},
    .words =
        [](const FoundNumbers& n) {
          const std::string of =
              n.has("fs") ? "friction that falls from " + n("fs") + " to " + n("fc") + " with speed"
                          : "dry friction of " + n("fc");
          if (!n.is_told("sigma0")) return of;
          return n.has("fs") ? of + " and first gives way elastically"
                             : "friction of " + n("fc") + " that first gives way elastically";
        },
};

}  // namespace dcnn::effects::lugre_friction
