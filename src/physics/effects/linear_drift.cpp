// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::linear_drift {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  add(wrench, read_offset(parameters, "rate", "ps"), motion.t);
}

}  // namespace

const EffectKind effect{
    .name = "linear_drift",
    .stage = Stage::kOffset,
    .kind = "sensor",
    .meaning = "offset that grows steadily",
    .on_machine = "drift",
    .equation = "rate t",
    .example = R"({"rate_x_nps": 0.001, "rate_y_nps": -0.002, "rate_z_nps": 0.003})",
    .needs_time = TimeNeed::kClock,
    .apply = apply,
    .fits = {{.amplitudes = 3,
              .with_torque = 6,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return offset_parameters(a, "rate", "ps");
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return n.on_machine()
                     ? "an offset that grows by " + n("rate")
                     : "the sensor's offset grows by " + n.push("rate", "/s", 60.0) + " a minute";
        },
};

}  // namespace dcnn::effects::linear_drift
