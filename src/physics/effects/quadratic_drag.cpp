// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "physics/friction.h"

namespace dcnn::effects::quadratic_drag {
namespace {

auto law(Options& parameters) {
  const double c2 = parameter(parameters, "c2_ns2pm2", 0.0);
  return [=](double v) { return c2 * v * std::abs(v); };
}

}  // namespace

const EffectKind effect{
    .name = "quadratic_drag",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "drag with the square of speed",
    .on_machine = "quadratic drag",
    .equation = "-c2 v abs(v) n",
    .example = R"({"c2_ns2pm2": 5.0})",
    .axis = AxisRule::kLine,
    .friction = EffectKind::Friction::kOther,
    .strength = "c2_ns2pm2",
    .apply = resisted<law>,
    .stream = resisting<law>,
    .fits = {{.amplitudes = 1,
              .non_negative = true,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"c2_ns2pm2", a(0)}};
                  }}},
    .words = [](const FoundNumbers& n) { return "drag of " + n("c2"); },
};

}  // namespace dcnn::effects::quadratic_drag
