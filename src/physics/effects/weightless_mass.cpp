// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

// Robot controllers often subtract the weight of a payload from what their sensor reads, and not
// its inertia.
namespace dcnn::effects::weightless_mass {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const double mass = parameter(parameters, "mass_kg");
  require(motion.a_B.rows() == motion.samples(), Exit::kData, motion.recording,
          ": weightless_mass needs an acceleration; log x,y,z or ax,ay,az");
  for (Index k = 0; k < motion.samples(); ++k) {
    wrench.force.row(k) -= mass * motion.a_B.row(k) * motion.R_BS[static_cast<std::size_t>(k)];
  }
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  const double mass = parameter(parameters, "mass_kg");
  return [mass](InstantWrench& wrench, const Instant& now) {
    wrench.force -= mass * now.R_BS.transpose() * now.a_B;
  };
}

}  // namespace

const EffectKind effect{
    .name = "weightless_mass",
    .kind = "structural",
    .meaning = "inertia of a mass whose weight is compensated",
    .equation = "-m R^T a",
    .example = R"({"mass_kg": 0.3})",
    .interval = IntervalRule::kNever,
    .needs_time = TimeNeed::kMotion,
    .subject = EffectKind::Subject::kTools,
    .force = Shown::kInMotion,
    .torque = Shown::kInMotion,
    .at_a_point = true,
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 1,
              .non_negative = true,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"mass_kg", a(0)}};
                  }}},
    .hidden_by =
        [](const Showing& of) {
          return of.has_inertia ? "what is simulated has its inertia" : nullptr;
        },
    .words =
        [](const FoundNumbers& n) {
          return "the inertia of " + mass_text(n.value("mass")) + " whose weight is compensated";
        },
};

}  // namespace dcnn::effects::weightless_mass
