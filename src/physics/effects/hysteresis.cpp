#include <cmath>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn::effects::hysteresis {
namespace {

/// Solves dy/du = 1 - rate·y exactly from y over u.
double relax(double y, double u, double rate) {
  if (std::abs(rate) < 1e-9) return y + u;
  return y + (1.0 / rate - y) * -elementary::expm1(-rate * u);
}

/// The way u in which y < 0 comes to 0 under dy/du = 1 - rate·y.
double way_to_zero(double y, double rate) {
  return std::abs(rate) < 1e-9 ? -y : elementary::log1p(-rate * y) / rate;
}

/// Bouc-Wen (Wen 1976, n = 1) along a turn dq = sign·u·width. With y = sign·z the law is
/// dy/du = 1 - (1-asym) y - asym abs(y): rate 1 above zero, 1 - 2 asym below; each part is exact.
double turn(double z, double dq, double width, double asym) {
  double y = std::copysign(1.0, dq) * z, u = std::abs(dq) / width;
  if (y < 0.0) {
    const double below = 1.0 - 2.0 * asym, crossing = way_to_zero(y, below);
    if (u < crossing) return std::copysign(1.0, dq) * relax(y, u, below);
    u -= crossing;
    y = 0.0;
  }
  return std::copysign(1.0, dq) * relax(y, u, 1.0);
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double force = parameter(parameters, "force_n");
  const double width = parameter(parameters, "width_rad", kTiny);
  const double asym = parameter(parameters, "asym", 0.0, 1.0);
  const AngleAxis at = angle_axis(spec.axis);
  const auto angle = motion.euler.col(at.angle);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(motion.samples());
  double z = 0.0;
  for (Index k = 1; k < motion.samples(); ++k) {
    z = turn(z, angle(k) - angle(k - 1), width, asym);
    pull(k) = -force * z;
  }
  push_along(at.axis, motion, pull, wrench);
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  const double force = parameter(parameters, "force_n");
  const double width = parameter(parameters, "width_rad", kTiny);
  const double asym = parameter(parameters, "asym", 0.0, 1.0);
  return [=, at = AngleNow(spec.axis), z = 0.0, before = 0.0](InstantWrench& wrench,
                                                              const Instant& now) mutable {
    const double angle = now.euler[at.angle];
    z = now.first ? 0.0 : turn(z, angle - before, width, asym);
    before = angle;
    wrench.force -= force * z * at.line.n_S(now);
  };
}

}  // namespace

const EffectKind effect{
    .name = "hysteresis",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "cable with Bouc-Wen hysteresis in an angle q",
    .equation = "dz = (dq/w)(1 - (1-asym) sign(dq) z - asym abs(z)); -force z n",
    .example = R"({"force_n": 0.3, "width_rad": 0.2, "asym": 0.4})",
    .axis = AxisRule::kAngle,
    .needs_time = TimeNeed::kMotion,
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 1,
              .shapes = {{"width", 5e-3, 3.0, {0.05, 0.15, 0.4}}, {"asym", 0.0, 1.0, {0.5}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"force_n", a(0)}, {"width_rad", s(0)}, {"asym", s(1)}};
                  }}},
};

}  // namespace dcnn::effects::hysteresis
