// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::bias {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  add(wrench, read_offset(parameters, "delta_bias"), Eigen::VectorXd::Ones(motion.samples()));
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  const Offset offset = read_offset(parameters, "delta_bias");
  return [offset](InstantWrench& wrench, const Instant&) {
    wrench.force += offset.force;
    wrench.torque += offset.torque;
  };
}

}  // namespace

const EffectKind effect{
    .name = "bias",
    .stage = Stage::kOffset,
    .kind = "sensor",
    .meaning = "constant offset",
    .on_machine = "constant offset",
    .equation = "+ b",
    .example = R"({"delta_bias_x_n": 0.3, "delta_bias_y_n": -0.2, "delta_bias_z_n": 0.1})",
    .is_constant = true,
    .own = EffectKind::Own::kTools,
    .strength = "delta_bias_x_n",
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 3,
              .with_torque = 6,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return offset_parameters(a, "delta_bias");
                  }},
             {.amplitudes = 1,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return offset_parameters(Eigen::Vector3d(a(0), 0.0, 0.0), "delta_bias");
                  },
              .use = EffectFit::Use::kDriven}},
    .hidden_by =
        [](const Showing& of) {
          return of.own_offsets ? "each recording has an offset of its own (zeroed)" : nullptr;
        },
    .words =
        [](const FoundNumbers& n) {
          return "a constant offset of " +
                 (n.on_machine() ? n("delta_bias") : n.push("delta_bias"));
        },
};

}  // namespace dcnn::effects::bias
