// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "physics/effect_law.h"

namespace dcnn::effects::mass {
namespace {

void change(ToolModel& model, Options& parameters) {
  model.mass += parameter(parameters, "delta_mass_kg");
}

}  // namespace

const EffectKind effect{
    .name = "mass",
    .stage = Stage::kTool,
    .kind = "parameter",
    .meaning = "tool heavier or lighter",
    .equation = "m -> m + d",
    .example = R"({"delta_mass_kg": 0.05})",
    .interval = IntervalRule::kNever,
    .own = EffectKind::Own::kTools,
    .change = change,
    .fits = {{.amplitudes = 1,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"delta_mass_kg", a(0)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          const double d = n.value("delta_mass");
          return "the tool is " + mass_text(std::abs(d)) + (d > 0.0 ? " heavier" : " lighter") +
                 " than simulated";
        },
};

}  // namespace dcnn::effects::mass
