// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "physics/friction.h"

namespace dcnn::effects::asymmetric_friction {
namespace {

auto law(Options& parameters) {
  const double c = parameter(parameters, "delta_c_nspm");
  return [=](double v) { return c * std::abs(v); };
}

}  // namespace

// A difference in the dry part is no effect of its own: while the axis moves it is an offset.
const EffectKind effect{
    .name = "asymmetric_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "friction that grows more with speed in one direction, half the difference",
    .on_machine = "friction that differs between the directions",
    .equation = "-delta_c abs(v) n",
    .example = R"({"delta_c_nspm": 0.5})",
    .axis = AxisRule::kLine,
    .subject = EffectKind::Subject::kMachines,
    .special = true,
    .friction = EffectKind::Friction::kOther,
    .apply = resisted<law>,
    .stream = resisting<law>,
    .fits = {{.amplitudes = 1,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"delta_c_nspm", a(0)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return "friction that differs between the directions, by " + n.size("delta_c") +
                 " either way";
        },
};

}  // namespace dcnn::effects::asymmetric_friction
