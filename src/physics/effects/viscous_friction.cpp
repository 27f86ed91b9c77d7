// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "physics/friction.h"

namespace dcnn::effects::viscous_friction {
namespace {

/// `v1`: the speed at which the film of lubricant has lost half of its drag per speed, as in the
/// harmonic drives of robots (Waiboer, Aarts, Jonker 2005 fit a power of the speed instead).
auto law(Options& parameters) {
  const double c = parameter(parameters, "c_nspm", 0.0);
  const double slower =
      parameters.has("v1_mps") ? 1.0 / parameter(parameters, "v1_mps", kTiny) : 0.0;
  return [=](double v) { return c * v / (1.0 + slower * std::abs(v)); };
}

}  // namespace

const EffectKind effect{
    .name = "viscous_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "linear friction",
    .on_machine = "viscous friction",
    .equation = "-c v n; -c v/(1 + abs(v)/v1) n where v1 is given",
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
                  }},
             {.amplitudes = 1,
              .non_negative = true,
              .shapes = {{"v1", 0.03, 30.0, {1.5}, 1, -1, ShapeParameter::Speed::kBending}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"c_nspm", a(0)}, {"v1_mps", s(0)}};
                  },
              .use = EffectFit::Use::kMachines,
              .special = true}},
    .hidden_by =
        [](const Showing& of) {
          return of.reads_motion ? "what is read is a motion, of which a delay looks like it"
                                 : nullptr;
        },
    .words = [](const FoundNumbers& n) { return "viscous friction of " + n("c"); },
};

}  // namespace dcnn::effects::viscous_friction
