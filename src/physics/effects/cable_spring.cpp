// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "physics/effect_law.h"

namespace dcnn::effects::cable_spring {
namespace {

auto law(Options& parameters) {
  const double k = parameter(parameters, "k_nprad"), rest = parameter(parameters, "rest_rad");
  return [=](double q) { return -k * (q - rest); };
}

}  // namespace

const EffectKind effect{
    .name = "cable_spring",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "cable or hose as a spring over one coordinate",
    .on_machine = "spring over the position",
    .equation = "-k (q - rest) n",
    .example = R"({"k_nprad": 0.5, "rest_rad": 0.1})",
    .axis = AxisRule::kAngle,
    .is_carried = true,
    .course = EffectKind::Course::kStraight,
    .base_signal = "position",
    .strength = "k_nprad",
    .apply = pushed<law>,
    .stream = pushing<law>,
    .fits = {{.amplitudes = 2,
              // k and k·rest: the force is linear in both.
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"k_nprad", a(0)}, {"rest_rad", a(0) == 0.0 ? 0.0 : a(1) / a(0)}};
                  },
              // One whose rest is turns away is a constant.
              .most_ratio = 2.0 * std::numbers::pi},
             {.amplitudes = 1,
              .shapes = {{"rest", -3.2, 3.2, {0.0}, 1}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"k_nprad", a(0)}, {"rest_rad", s(0)}};
                  },
              .use = EffectFit::Use::kDriven}},
    .hidden_by = no_force_on_a_motion,
    .words =
        [](const FoundNumbers& n) {
          return (n.on_machine() ? "a spring of " : "a cable or hose that pulls with ") + n("k");
        },
};

}  // namespace dcnn::effects::cable_spring
