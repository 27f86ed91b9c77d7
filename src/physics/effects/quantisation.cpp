// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::quantisation {
namespace {

void apply(Wrench& wrench, const Motion&, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const double q = parameter(parameters, "step_n", 0.0);
  if (q > 0.0) wrench.force = q * (wrench.force / q).array().round();
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  const double q = parameter(parameters, "step_n", 0.0);
  return [q](InstantWrench& wrench, const Instant&) {
    if (q > 0.0) wrench.force = q * (wrench.force / q).array().round();
  };
}

}  // namespace

const EffectKind effect{
    .name = "quantisation",
    .stage = Stage::kQuantisation,
    .kind = "sensor",
    .meaning = "reading in coarse steps",
    .equation = "q round(F/q)",
    .example = R"({"step_n": 0.05})",
    .apply = apply,
    .stream = stream,
    .fits = {{.shapes = {{"step", 1e-6, 1e3, {}}},
              .parameters =
                  [](const Eigen::VectorXd&, const Eigen::VectorXd& s) {
                    return Json{{"step_n", s(0)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return n.on_machine() ? "a reading in steps of " + n("step")
                                : "the reading comes in steps of " + force_text(n.value("step"));
        },
};

}  // namespace dcnn::effects::quantisation
