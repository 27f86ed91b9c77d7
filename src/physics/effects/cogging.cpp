// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn::effects::cogging {
namespace {

auto law(Options& parameters) {
  const double amp = parameter(parameters, "amp_n"), order = parameter(parameters, "order");
  const double phase = parameter(parameters, "phase_rad");
  return [=](double q) { return amp * elementary::sin(order * q + phase); };
}

std::string words(const FoundNumbers& n) {
  return n.on_machine()
             ? "cogging of " + n.size("amp") + " that repeats with order " + n.plain("order")
             : "a force of " + n("amp") + " that repeats " + n.plain("order") + " times a turn";
}

}  // namespace

const EffectKind effect{
    .name = "cogging",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "force periodic in one coordinate",
    .on_machine = "force periodic in the position",
    .equation = "amp sin(order q + phase) n",
    .example = R"({"amp_n": 0.1, "order": 12.0, "phase_rad": 0.5})",
    .axis = AxisRule::kAngle,
    .course = EffectKind::Course::kWave,
    .at_many = true,
    .apply = pushed<law>,
    .stream = pushing<law>,
    .fits = {{.amplitudes = 2,
              .shapes = {{.name = "order",
                          .low = 0.5,
                          .high = 200.0,
                          .length = -1,
                          .peak = ShapeParameter::Peak::kNarrow}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"amp_n", a.norm()},
                                {"order", s(0)},
                                {"phase_rad", elementary::atan2(a(1), a(0))}};
                  }}},
    .words = words,
};

}  // namespace dcnn::effects::cogging
