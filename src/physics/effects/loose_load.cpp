// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "physics/effect_law.h"

namespace dcnn::effects::loose_load {
namespace {

/// A slug that slides without friction between two stops, relative to the tool. Stops are plastic
/// (no rebound): an impact ends the motion, and the slug stays until the field turns.
class Slug {
 public:
  Slug(double half_gap, double field) : half_gap_(half_gap), s_(std::copysign(half_gap, field)) {}

  /// Moves for h seconds under a field (m/s^2 along the axis) running linearly from u0 to u1.
  void advance(double u0, double u1, double h) {
    for (int i = 0; i < kSubSteps; ++i) {
      fall(u0 + (u1 - u0) * (i + 0.5) / kSubSteps, h / kSubSteps);
    }
  }
  double velocity() const { return v_; }

 private:
  static constexpr int kSubSteps = 16;

  void fall(double u, double h) {
    s_ += v_ * h + 0.5 * u * h * h;
    v_ += u * h;
    if (std::abs(s_) < half_gap_) return;
    s_ = std::copysign(half_gap_, s_);
    v_ = 0.0;
  }

  double half_gap_, s_, v_ = 0.0;
};

/// The force of a sample is the mean of -slug·s'' from half a step before to half a step after it,
/// so that an impact, shorter than any step, hands over its whole momentum.
void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel& model,
           Options& parameters) {
  const double slug = parameter(parameters, "slug_kg", 0.0);
  const double gap = parameter(parameters, "gap_m", 0.0);
  if (motion.samples() == 0) return;
  ToolModel moving = model;
  moving.inertial = ToolModel::Inertial::kLinear;
  const Index i = axis_index(spec.axis);
  const Eigen::VectorXd field = felt_acceleration(moving, motion).col(i);
  Slug load(gap / 2.0, field(0));
  double before = 0.0;
  for (Index k = 0; k + 1 < motion.samples(); ++k) {
    const double h = step(motion, k + 1), middle = (field(k) + field(k + 1)) / 2.0;
    load.advance(field(k), middle, h / 2.0);
    wrench.force(k, i) -= slug * (load.velocity() - before) / h;
    before = load.velocity();
    load.advance(middle, field(k + 1), h / 2.0);
  }
}

}  // namespace

const EffectKind effect{
    .name = "loose_load",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "part of the load slides between stops (knocks when gravity turns)",
    .equation = "-slug s'' n, abs(s) <= gap/2",
    .example = R"({"slug_kg": 0.05, "gap_m": 0.004})",
    .axis = AxisRule::kSensor,
    .needs_time = TimeNeed::kMotion,
    .subject = EffectKind::Subject::kTools,
    .force = Shown::kInMotion,
    .torque = Shown::kInMotion,
    .apply = apply,
    .fits = {{.amplitudes = 1,
              .non_negative = true,
              .shapes = {{"gap", 1e-5, 0.1, {}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"slug_kg", a(0)}, {"gap_m", s(0)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return "a part of about " + in_thousandths(n.value("slug"), "g") +
                 " that slides between stops";
        },
};

}  // namespace dcnn::effects::loose_load
