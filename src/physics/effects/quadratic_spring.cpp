// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::quadratic_spring {
namespace {

auto law(Options& parameters) {
  const double k2 = parameter(parameters, "k2_nprad2"), rest = parameter(parameters, "rest_rad");
  return [=](double q) { return -k2 * (q - rest) * (q - rest); };
}

}  // namespace

// A rest elsewhere adds a line and a constant, which a spring and an offset beside it say.
const EffectKind effect{
    .name = "quadratic_spring",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "spring that pulls one way with the square of a position q",
    .on_machine = "quadratic spring",
    .equation = "-k2 (q - rest)^2 n",
    .example = R"({"k2_nprad2": 0.5, "rest_rad": 0.1})",
    .axis = AxisRule::kAngle,
    .subject = EffectKind::Subject::kMachines,
    .is_carried = true,
    .strength = "k2_nprad2",
    .apply = pushed<law>,
    .stream = pushing<law>,
    .fits = {{.amplitudes = 1,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"k2_nprad2", a(0)}, {"rest_rad", 0.0}};
                  }}},
    .hidden_by = no_force_on_a_motion,
    .words =
        [](const FoundNumbers& n) {
          return "a spring that bends with the square of the position, " + n("k2");
        },
};

}  // namespace dcnn::effects::quadratic_spring
