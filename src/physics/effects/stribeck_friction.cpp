// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "physics/friction.h"

namespace dcnn::effects::stribeck_friction {
namespace {

auto law(Options& parameters) {
  const double fc = parameter(parameters, "fc_n", 0.0), fs = parameter(parameters, "fs_n", 0.0);
  const double vs = parameter(parameters, "vs_mps", kTiny);
  const double v0 = parameter(parameters, "v0_mps", kTiny);
  return [=](double v) {
    return (fc + (fs - fc) * elementary::exp(-(v / vs) * (v / vs))) * elementary::tanh(v / v0);
  };
}

}  // namespace

const EffectKind effect{
    .name = "stribeck_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "friction falls with speed",
    .on_machine = "Stribeck friction",
    .equation = "-(fc + (fs-fc) exp(-(v/vs)^2)) tanh(v/v0) n",
    .example = R"({"fc_n": 0.3, "fs_n": 0.6, "vs_mps": 0.03, "v0_mps": 0.005})",
    .axis = AxisRule::kLine,
    .friction = EffectKind::Friction::kDry,
    .apply = resisted<law>,
    .stream = resisting<law>,
    .fits =
        {{.amplitudes = 2,
          .non_negative = true,
          // v0/vs: friction must have set in before it can fall.
          .shapes = {{"vs", 1e-3, 1.0, {0.01, 0.03, 0.1}, 1, -1, ShapeParameter::Speed::kFalling},
                     {"onset", 0.01, 1.0, {0.1, 0.4}}},
          .parameters =
              [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                return Json{
                    {"fc_n", a(0)}, {"fs_n", a(1)}, {"vs_mps", s(0)}, {"v0_mps", s(0) * s(1)}};
              },
          .rising = true}},
    .is_itself =
        [](const Eigen::VectorXd& a, bool on_machine) {
          const double ratio = a(1) / std::max(1e-300, a(0));
          return ratio > 1.0 && (!on_machine || ratio < kMostAtRest);
        },
    .words =
        [](const FoundNumbers& n) {
          return "friction that falls from " + n("fs") + " to " + n("fc") + " with speed";
        },
};

}  // namespace dcnn::effects::stribeck_friction
