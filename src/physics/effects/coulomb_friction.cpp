// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/elementary.h"
#include "physics/friction.h"

namespace dcnn::effects::coulomb_friction {
namespace {

auto law(Options& parameters) {
  const double fc = parameter(parameters, "fc_n", 0.0);
  const double v0 = parameter(parameters, "v0_mps", kTiny);
  return [=](double v) { return fc * elementary::tanh(v / v0); };
}

}  // namespace

const EffectKind effect{
    .name = "coulomb_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "dry friction",
    .equation = "-fc tanh(v/v0) n",
    .example = R"({"fc_n": 0.4, "v0_mps": 0.01})",
    .axis = AxisRule::kLine,
    .common = true,
    .friction = EffectKind::Friction::kDry,
    .strength = "fc_n",
    .apply = resisted<law>,
    .stream = resisting<law>,
    .fits = {{.amplitudes = 1,
              .non_negative = true,
              .shapes =
                  {{"v0", 3e-4, 0.3, {0.003, 0.012, 0.05}, 1, -1, ShapeParameter::Speed::kTurning}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"fc_n", a(0)}, {"v0_mps", s(0)}};
                  }}},
    .words = [](const FoundNumbers& n) { return "dry friction of " + n("fc"); },
};

}  // namespace dcnn::effects::coulomb_friction
