// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::inertia {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double inertia = parameter(parameters, "delta_inertia_kg");
  const bool turns = spec.axis.starts_with("w_");
  require(turns || motion.a_B.rows() == motion.samples(), Exit::kData, motion.recording,
          ": inertia needs an acceleration; log x,y,z or ax,ay,az");
  const Eigen::MatrixXd n = direction_of(spec.axis, motion);
  for (Index k = 0; k < motion.samples(); ++k) {
    const double along = turns ? n.row(k).dot(motion.dw_S.row(k))
                               : (n.row(k) * motion.R_BS[static_cast<std::size_t>(k)].transpose())
                                     .dot(motion.a_B.row(k));
    wrench.force.row(k) -= inertia * along * n.row(k);
  }
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  const double inertia = parameter(parameters, "delta_inertia_kg");
  return [inertia, line = LineNow(spec.axis)](InstantWrench& wrench, const Instant& now) {
    wrench.force -= inertia * line.acceleration(now) * line.n_S(now);
  };
}

}  // namespace

const EffectKind effect{
    .name = "inertia",
    .stage = Stage::kForce,
    .kind = "parameter",
    .meaning = "more (or less) inertia than simulated",
    .on_machine = "inertia error",
    .equation = "-delta_inertia dv/dt n",
    .example = R"({"delta_inertia_kg": 0.2})",
    .axis = AxisRule::kLine,
    .subject = EffectKind::Subject::kMachines,
    .is_carried = true,
    .base_signal = "acceleration",
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 1,
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"delta_inertia_kg", a(0)}};
                  }}},
    .hidden_by =
        [](const Showing& of) {
          return of.reads_motion ? "what is read is a motion, of which a delay looks like it"
                                 : nullptr;
        },
    .words =
        [](const FoundNumbers& n) { return "an inertia that is off by " + n("delta_inertia"); },
};

}  // namespace dcnn::effects::inertia
