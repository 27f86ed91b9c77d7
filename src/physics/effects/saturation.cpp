// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "physics/effect_law.h"

namespace dcnn::effects::saturation {
namespace {

void apply(Wrench& wrench, const Motion&, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double limit = parameter(parameters, "limit_n", 0.0);
  const Index i = axis_index(spec.axis);
  wrench.force.col(i) = wrench.force.col(i).cwiseMax(-limit).cwiseMin(limit);
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  const double limit = parameter(parameters, "limit_n", 0.0);
  return [limit, i = axis_index(spec.axis)](InstantWrench& wrench, const Instant&) {
    wrench.force(i) = std::min(std::max(wrench.force(i), -limit), limit);
  };
}

}  // namespace

const EffectKind effect{
    .name = "saturation",
    .stage = Stage::kSaturation,
    .kind = "sensor",
    .meaning = "reading clipped",
    .equation = "clip(F_axis, -L, L)",
    .example = R"({"limit_n": 5.0})",
    .axis = AxisRule::kSensor,
    .apply = apply,
    .stream = stream,
    .fits = {{.shapes = {{"limit", 1e-3, 1e4, {}}},
              .parameters =
                  [](const Eigen::VectorXd&, const Eigen::VectorXd& s) {
                    return Json{{"limit_n", s(0)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return (n.on_machine() ? "a reading that is clipped at " : "the reading is clipped at ") +
                 n("limit");
        },
};

}  // namespace dcnn::effects::saturation
