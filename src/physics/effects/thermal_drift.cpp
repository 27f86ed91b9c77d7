// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn::effects::thermal_drift {
namespace {

/// Follows the logged temperature.
void follow(Wrench& wrench, const Motion& motion, Options& parameters) {
  const Offset k = read_offset(parameters, "k", "pk");
  const double t_ref = parameter(parameters, "t_ref_degc");
  require(
      motion.temperature.size() == motion.samples(), Exit::kData, motion.recording,
      ": thermal_drift with t_ref_degc needs a column temperature; log it, or give a_x_n … tau_s");
  add(wrench, k, motion.temperature.array() - t_ref);
}

/// Settles with the clock.
void settle(Wrench& wrench, const Motion& motion, Options& parameters) {
  const Offset a = read_offset(parameters, "a");
  const double tau = parameter(parameters, "tau_s", kTiny);
  add(wrench, a, 1.0 - elementary::exp(-motion.t.array() / tau));
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  if (parameters.has("t_ref_degc")) {
    follow(wrench, motion, parameters);
  } else {
    settle(wrench, motion, parameters);
  }
}

}  // namespace

const EffectKind effect{
    .name = "thermal_drift",
    .stage = Stage::kOffset,
    .kind = "sensor",
    .meaning = "offset that settles, or follows the logged temperature",
    .on_machine = "offset that settles",
    .equation = "a (1 - exp(-t/tau)), or k (T - t_ref)",
    .example = R"({"a_x_n": 0.3, "a_y_n": -0.2, "a_z_n": 0.5, "tau_s": 60.0})",
    .needs_time = TimeNeed::kClock,
    .apply = apply,
    .fits = {{.amplitudes = 3,
              .with_torque = 6,
              .shapes = {{"tau", 0.5, 5000.0, {10.0, 40.0, 150.0}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    Json p = offset_parameters(a, "a");
                    p["tau_s"] = s(0);
                    return p;
                  }},
             {.amplitudes = 3,
              .with_torque = 6,
              .shapes = {{"t_ref", -50.0, 150.0, {20.0, 25.0, 30.0, 40.0}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    Json p = offset_parameters(a, "k", "pk");
                    p["t_ref_degc"] = s(0);
                    return p;
                  }}},
    .words = [](const FoundNumbers& n) -> std::string {
      if (!n.on_machine()) {
        return n.has("tau")
                   ? "the sensor's offset settles by " + n.push("a") + " within " + n("tau")
                   : "the sensor's offset follows the temperature by " + n.push("k", "/K") +
                         " a kelvin";
      }
      return n.has("k") ? "an offset that follows the temperature with " + n("k")
                        : "an offset that settles by " + n("a") + " within " + n("tau");
    },
};

}  // namespace dcnn::effects::thermal_drift
