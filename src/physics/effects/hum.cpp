// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn::effects::hum {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const double hz = parameter(parameters, "freq_hz", 0.0);
  const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * hz * motion.t.array();
  const Offset sine = read_offset(parameters, "sin"), cosine = read_offset(parameters, "cos");
  if (!sine.is_zero()) add(wrench, sine, elementary::sin(angle));
  if (!cosine.is_zero()) add(wrench, cosine, elementary::cos(angle));
}

}  // namespace

const EffectKind effect{
    .name = "hum",
    .stage = Stage::kOffset,
    .kind = "sensor",
    .meaning = "one fixed frequency in time, as it appears at the sample rate",
    .on_machine = "hum",
    .equation = "s sin(2 pi f t) + c cos(2 pi f t)",
    .example =
        R"({"freq_hz": 50.0, "sin_x_n": 0.1, "sin_y_n": 0.0, "sin_z_n": -0.05, "cos_x_n": 0.02, "cos_y_n": 0.08, "cos_z_n": 0.0})",
    .needs_time = TimeNeed::kMotion,
    .at_many = true,
    .apply = apply,
    .fits = {{.amplitudes = 6,
              .with_torque = 12,
              .shapes = {{.name = "freq",
                          .low = 0.05,
                          .high = 500.0,
                          .peak = ShapeParameter::Peak::kLine}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    const Index half = a.size() / 2;
                    Json p = offset_parameters(a.head(half), "sin");
                    p.update(offset_parameters(a.tail(half), "cos"));
                    p["freq_hz"] = s(0);
                    return p;
                  }}},
    .words =
        [](const FoundNumbers& n) {
          if (n.on_machine()) return "a hum at " + n("freq");
          return "a hum of " + n.push("") + " at " + n("freq");
        },
};

}  // namespace dcnn::effects::hum
