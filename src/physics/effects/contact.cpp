// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::contact {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const Offset pushed = read_offset(parameters, "force");
  for (Index k = 0; k < motion.samples(); ++k) {
    const Eigen::Matrix3d R_SB = motion.R_BS[static_cast<std::size_t>(k)].transpose();
    wrench.force.row(k) += (R_SB * pushed.force).transpose();
    if (wrench.torque.rows() > 0) wrench.torque.row(k) += (R_SB * pushed.torque).transpose();
  }
}

}  // namespace

const EffectKind effect{
    .name = "contact",
    .stage = Stage::kForce,
    .kind = "external",
    .meaning = "external force for some seconds, constant in base",
    .equation = "+ R^T f on [a,b]",
    .example = R"({"force_x_n": 1.0, "force_y_n": -2.0, "force_z_n": 0.5})",
    .interval = IntervalRule::kRequired,
    .needs_time = TimeNeed::kMotion,
    .subject = EffectKind::Subject::kTools,  // what a drive leaves in some seconds is hardly a hand
                                             // on the machine
    .apply = apply,
    .fits = {{.amplitudes = 3,
              .with_torque = 6,
              .parameters = [](const Eigen::VectorXd& a,
                               const Eigen::VectorXd&) { return offset_parameters(a, "force"); }}},
    .words = [](const FoundNumbers& n) { return "a contact of " + n.push("force"); },
};

}  // namespace dcnn::effects::contact
