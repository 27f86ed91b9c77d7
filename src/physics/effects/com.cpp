// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::com {
namespace {

void change(ToolModel& model, Options& parameters) {
  model.com += parameters3(parameters, "delta_com", "_m");
}

}  // namespace

const EffectKind effect{
    .name = "com",
    .stage = Stage::kTool,
    .kind = "parameter",
    .meaning = "centre of mass elsewhere",
    .equation = "c -> c + d",
    .example = R"({"delta_com_x_m": 0.01, "delta_com_y_m": -0.005, "delta_com_z_m": 0.02})",
    .interval = IntervalRule::kNever,
    .force = Shown::kInMotion,
    .own = EffectKind::Own::kTools,
    .change = change,
    .fits = {{.amplitudes = 3,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{
                        {"delta_com_x_m", a(0)}, {"delta_com_y_m", a(1)}, {"delta_com_z_m", a(2)}};
                  }}},
    .hidden_by = [](const Showing& of) { return of.own_tool ? nullptr : kUnknownTool; },
    .words =
        [](const FoundNumbers& n) {
          return "the centre of mass is " + in_thousandths(n.length("delta_com", "m"), "mm") +
                 " away from where it is simulated";
        },
};

}  // namespace dcnn::effects::com
