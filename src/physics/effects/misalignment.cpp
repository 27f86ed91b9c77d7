// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "dcnn/data/rotation.h"
#include "physics/effect_law.h"

namespace dcnn::effects::misalignment {
namespace {

void apply(Wrench& wrench, const Motion&, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const Eigen::Matrix3d Rm = rotation_from_euler(parameters3(parameters, "rot", "_rad").reverse());
  wrench.force *= Rm;  // rows are transposed vectors
  wrench.torque *= Rm;
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  const Eigen::Matrix3d turned =
      rotation_from_euler(parameters3(parameters, "rot", "_rad").reverse()).transpose();
  return [turned](InstantWrench& wrench, const Instant&) {
    wrench.force = (turned * wrench.force).eval();
    wrench.torque = (turned * wrench.torque).eval();
  };
}

}  // namespace

const EffectKind effect{
    .name = "misalignment",
    .stage = Stage::kSensor,
    .kind = "sensor",
    .meaning = "sensor axes turned against the pose frame",
    .equation = "F -> Rm^T F, Rm = Rz(rz) Ry(ry) Rx(rx)",
    .example = R"({"rot_x_rad": 0.02, "rot_y_rad": -0.01, "rot_z_rad": 0.03})",
    .subject = EffectKind::Subject::kTools,
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 3,
              .most_strength = std::numbers::pi,  // no turn is longer
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"rot_x_rad", a(0)}, {"rot_y_rad", a(1)}, {"rot_z_rad", a(2)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return "the sensor's axes are turned by " +
                 in_thousandths(n.length("rot", "rad"), "mrad");
        },
};

}  // namespace dcnn::effects::misalignment
