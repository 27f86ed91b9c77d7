// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::step_bias {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  add(wrench, read_offset(parameters, "step"), Eigen::VectorXd::Ones(motion.samples()));
}

}  // namespace

const EffectKind effect{
    .name = "step_bias",
    .stage = Stage::kOffset,
    .kind = "sensor",
    .meaning = "offset jumps once (bumped sensor) and stays",
    .on_machine = "offset that jumps once and stays",
    .equation = "+ s from t >= a",
    .example = R"({"step_x_n": 0.4, "step_y_n": -0.3, "step_z_n": 0.2})",
    .interval = IntervalRule::kOnset,
    .needs_time = TimeNeed::kClock,
    .apply = apply,
    .fits = {{.amplitudes = 3,
              .with_torque = 6,
              .parameters = [](const Eigen::VectorXd& a,
                               const Eigen::VectorXd&) { return offset_parameters(a, "step"); }}},
    .words =
        [](const FoundNumbers& n) {
          return n.on_machine() ? "an offset that jumps by " + n("step")
                                : "the sensor's offset jumps by " + n.push("step");
        },
};

}  // namespace dcnn::effects::step_bias
