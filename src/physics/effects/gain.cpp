// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "dcnn/core/number.h"
#include "physics/effect_law.h"

namespace dcnn::effects::gain {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const Eigen::Vector3d k = parameters3(parameters, "gain", "");
  // Of an axis of another machine it is the scale of the simulated part alone: every other effect
  // is in units of the reading.
  if (!motion.of_axis) {
    wrench.force *= (1.0 + k.array()).matrix().asDiagonal();
  } else if (wrench.load.rows() == wrench.force.rows()) {
    wrench.force += wrench.load * k.asDiagonal();
  }
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  const Eigen::Vector3d scale = parameters3(parameters, "gain", "").array() + 1.0;
  return [scale](InstantWrench& wrench, const Instant&) {
    if (wrench.of_axis) {
      wrench.force.array() += (scale.array() - 1.0) * wrench.load.array();
    } else {
      wrench.force.array() *= scale.array();
    }
  };
}

/// Of a sensor in its own unit; more is another unit or another sensor, which dcnn-check names.
constexpr double kMost = 3.0;

}  // namespace

const EffectKind effect{
    .name = "gain",
    .stage = Stage::kSensor,
    .kind = "sensor",
    .meaning = "scale error per axis",
    .on_machine = "scale error",
    .equation = "F_i -> (1+k_i) F_i",
    .example = R"({"gain_x": 0.02, "gain_y": -0.03, "gain_z": 0.01})",
    .own = EffectKind::Own::kMachines,
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 3,
              .most_strength = kMost,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"gain_x", a(0)}, {"gain_y", a(1)}, {"gain_z", a(2)}};
                  }},
             {.amplitudes = 1,  // of all axes, as a unit or an amplifier that they share makes it
              .most_strength = kMost,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"gain_x", a(0)}, {"gain_y", a(0)}, {"gain_z", a(0)}};
                  },
              .use = EffectFit::Use::kTools,
              .special = true}},
    .hidden_by =
        [](const Showing& of) {
          return of.on_machine && of.fitted_base
                     ? "the coefficients of the base simulator are fitted, and a scale is in them"
                     : nullptr;
        },
    .words =
        [](const FoundNumbers& n) {
          if (n.on_machine()) return "a scale that is off by " + n.plain("gain", 100.0) + " %";
          double most = 0.0;
          for (const FoundNumber& of_axis : n.all()) most = std::max(most, std::abs(of_axis.value));
          return "the sensor's scale is off by up to " + brief(100.0 * most) + " %";
        },
};

}  // namespace dcnn::effects::gain
