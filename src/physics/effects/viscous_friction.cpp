// SPDX-License-Identifier: Apache-2.0
#include "physics/friction.h"

namespace dcnn::effects::viscous_friction {
namespace {

auto law(Options& parameters) {
  const double c = parameter(parameters, "c_nspm", 0.0);
  return [=](double v) { return c * v; };
}

}  // namespace

const EffectKind effect{
    .name = "viscous_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "linear friction",
    .on_machine = "viscous friction",
    .equation = "-c v n",
    .example = R"({"c_nspm": 2.0})",
    .axis = AxisRule::kLine,
    .common = true,
    .friction = EffectKind::Friction::kOther,
    .base_signal = "velocity",
    .strength = "c_nspm",
    .apply = resisted<law>,
    .stream = resisting<law>,
    .fits = {{.amplitudes = 1,
              .non_negative = true,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"c_nspm", a(0)}};
                  }}},
    .hidden_by =
        [](const Showing& of) {
          return of.reads_motion ? "what is read is a motion, of which a delay looks like it"
                                 : nullptr;
        },
    .words = [](const FoundNumbers& n) { return "viscous friction of " + n("c"); },
};

}  // namespace dcnn::effects::viscous_friction
