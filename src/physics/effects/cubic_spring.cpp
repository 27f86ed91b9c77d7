// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::cubic_spring {
namespace {

auto law(Options& parameters) {
  const double k3 = parameter(parameters, "k3_nprad3");
  return [=](double q) { return -k3 * q * q * q; };
}

}  // namespace

const EffectKind effect{
    .name = "cubic_spring",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "spring that stiffens (or softens) with the cube of a position q",
    .on_machine = "cubic spring",
    .equation = "-k3 q^3 n",
    .example = R"({"k3_nprad3": 0.4})",
    .axis = AxisRule::kAngle,
    .subject = EffectKind::Subject::kMachines,
    .is_carried = true,
    .strength = "k3_nprad3",
    .apply = pushed<law>,
    .stream = pushing<law>,
    .fits = {{.amplitudes = 1,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"k3_nprad3", a(0)}};
                  }}},
    .hidden_by = no_force_on_a_motion,
    .words =
        [](const FoundNumbers& n) {
          return "a spring that stiffens with the cube of the position, " + n("k3");
        },
};

}  // namespace dcnn::effects::cubic_spring
