// SPDX-License-Identifier: Apache-2.0
// Which effects the signals of a log can show.
#include <algorithm>
#include <set>

#include "diagnosis/candidates.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

bool has_acceleration(const Case& study) {
  return std::all_of(study.logs.begin(), study.logs.end(),
                     [](const Log& log) { return log.motion.a_B.rows() == log.motion.samples(); });
}

/// Whether an axis' reading is a position or a rate, as a second encoder's or a gyroscope's.
bool reads_a_motion(const Case& study) {
  static const std::set<std::string> kUnits{"rad",   "deg",   "m",   "mm",   "rev", "rad/s",
                                            "deg/s", "rev/s", "rpm", "mm/s", "m/s"};
  return study.axis && kUnits.count(study.axis->axis().unit) > 0;
}

Showing showing_of(const Case& study) {
  Showing of;
  of.on_machine = study.axis != nullptr;
  of.own_tool = study.own_tool;
  of.has_inertia = study.has_inertia;
  of.is_full = study.simulator.model.inertial == ToolModel::Inertial::kFull;
  of.several_axes = study.axis && study.axis->system.axes.size() > 1;
  of.reads_motion = reads_a_motion(study);
  of.fitted_base = !study.logs.front().regressors.empty();
  of.own_offsets = has_own_offsets(study);
  return of;
}

}  // namespace

bool is_testable(const Case& study, const EffectKind& kind, std::string* why) {
  const auto because = [&](const char* text) {
    if (why) *why = text;
    return false;
  };
  if (kind.needs_time == TimeNeed::kMotion && study.is_static()) {
    return because("between poses at rest nothing is recorded");
  }
  if (kind.needs_time == TimeNeed::kClock && !study.has_clock()) {
    return because("the recordings have no time");
  }
  if (kind.axis == AxisRule::kLine) {
    if (study.is_static()) return because("nothing moves in a list of poses");
    for (const Log& log : study.logs) {
      if (log.motion.v_B.rows() != log.motion.samples()) {
        return because("no position or velocity is logged");
      }
    }
  }
  const bool along = kind.axis == AxisRule::kLine || kind.axis == AxisRule::kAngle;
  if (study.axis && (along || kind.stage == Stage::kDynamics) && !study.axis_moves) {
    return because("the axis moves no more than the noise of its position");
  }
  if (study.axis && kind.axis == AxisRule::kAngle && study.axis->axis().position.empty()) {
    return because("no position is logged");
  }
  const Shown shown = study.has_torque() ? std::max(kind.force, kind.torque) : kind.force;
  if (shown == Shown::kNever) return because("it changes torques alone, and none is measured");
  if (shown == Shown::kInMotion) {
    if (study.is_static()) return because("at rest the force does not depend on it");
    if (!has_acceleration(study)) return because("no position or acceleration is logged");
  }
  const char* hidden = kind.hidden_by ? kind.hidden_by(showing_of(study)) : nullptr;
  return hidden == nullptr || because(hidden);
}

bool is_in_base(const Case& study, const EffectKind& kind) {
  if (!study.axis || kind.base_signal == nullptr) return false;
  const std::vector<std::string>& base = study.axis->axis().base;
  return std::count(base.begin(), base.end(), kind.base_signal) > 0;
}

void add_constant(const Case& study, std::vector<Member>& members) {
  const auto& kinds = effect_kinds();
  const EffectKind& constant = **std::find_if(
      kinds.begin(), kinds.end(), [](const EffectKind* kind) { return kind->is_constant; });
  const bool has_one = std::any_of(members.begin(), members.end(),
                                   [&](const Member& m) { return m.kind == &constant; });
  if (is_listed(study, constant) && !has_one) {
    members.push_back(make_member(study, constant, constant.fits[0], "", {}));
  }
}

std::vector<Member> own_parameters(const Case& study) {
  std::vector<Member> members;
  // An arm's links are fitted to these recordings: their scale is no number of its own.
  if (study.axis && study.axis->base_deviations.size() > 0) return members;
  // Of another machine's simulator its scale is all that is known; a fitted base is fitted.
  const auto own = study.axis ? EffectKind::Own::kMachines : EffectKind::Own::kTools;
  for (const EffectKind* kind : effect_kinds()) {
    if (kind->own != own || !is_testable(study, *kind)) continue;
    Member member = make_member(study, *kind, first_form(study, *kind), "", Eigen::VectorXd(0));
    member.amplitudes.setZero();
    members.push_back(member);
  }
  return members;
}

}  // namespace dcnn
