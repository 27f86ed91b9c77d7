// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn::effects::gravity_load {
namespace {

auto law(Options& parameters) {
  const double amp = parameter(parameters, "amp_n"), rest = parameter(parameters, "rest_rad");
  return [=](double q) { return -amp * elementary::sin(q - rest); };
}

}  // namespace

// The rest is the angle at which the load hangs.
const EffectKind effect{
    .name = "gravity_load",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "weight of a load off a turning axis",
    .on_machine = "weight of a load off the axis",
    .equation = "-amp sin(q - rest) n",
    .example = R"({"amp_n": 0.4, "rest_rad": 0.3})",
    .axis = AxisRule::kAngle,
    .subject = EffectKind::Subject::kTurning,
    .is_carried = true,
    .common = true,
    .apply = pushed<law>,
    .stream = pushing<law>,
    .fits = {{.amplitudes = 2,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"amp_n", a.norm()}, {"rest_rad", elementary::atan2(a(1), a(0))}};
                  }}},
    .hidden_by = no_force_on_a_motion,
    .words =
        [](const FoundNumbers& n) {
          return "a load off its axis, whose weight makes up to " + n("amp");
        },
};

}  // namespace dcnn::effects::gravity_load
