// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn::effects::cable_field {
namespace {

/// The cable of the embedded data set: smooth in the orientation, without memory.
void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const double amp = parameter(parameters, "amp_n");
  for (Index k = 0; k < motion.samples(); ++k) {
    const Eigen::RowVector3d q = motion.euler.row(k);
    wrench.force.row(k) +=
        amp * Eigen::RowVector3d(elementary::sin(q(0) + 0.4), elementary::cos(2.0 * q(1)),
                                 elementary::sin(q(2)) * elementary::cos(q(0)));
  }
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  const double amp = parameter(parameters, "amp_n");
  return [amp](InstantWrench& wrench, const Instant& now) {
    const Eigen::Vector3d& q = now.euler;
    wrench.force += amp * Eigen::Vector3d(elementary::sin(q(0) + 0.4), elementary::cos(2.0 * q(1)),
                                          elementary::sin(q(2)) * elementary::cos(q(0)));
  };
}

}  // namespace

const EffectKind effect{
    .name = "cable_field",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "cable that pulls differently in every orientation (demonstration data)",
    .equation = "+ amp (sin(alpha+0.4), cos(2 beta), sin(gamma) cos(alpha))",
    .example = R"({"amp_n": 0.2})",
    .subject = EffectKind::Subject::kTools,
    .apply = apply,
    .stream = stream,
};

}  // namespace dcnn::effects::cable_field
