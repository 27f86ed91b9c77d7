#include <cmath>

#include "physics/effect_law.h"

namespace dcnn {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double amp = parameter(parameters, "amp_n"), order = parameter(parameters, "order");
  const double phase = parameter(parameters, "phase_rad");
  const AngleLine line = angle_line_of(spec.axis, motion);
  wrench.force +=
      (amp * (order * line.angle.array() + phase).sin()).matrix().asDiagonal() * line.n_S;
}

}  // namespace

const EffectKind cogging_effect{
    .name = "cogging",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "force periodic in an angle q",
    .equation = "amp sin(order q + phase) n",
    .example = R"({"amp_n": 0.1, "order": 12.0, "phase_rad": 0.5})",
    .axis = AxisRule::kAngle,
    .apply = apply,
    .fits = {{.amplitudes = 2,
              .shapes = {{"order", 0.5, 200.0, {}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"amp_n", std::hypot(a(0), a(1))},
                                {"order", s(0)},
                                {"phase_rad", std::atan2(a(1), a(0))}};
                  }}},
};

}  // namespace dcnn
