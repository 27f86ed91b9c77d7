// Which effects the signals of a log can show.
#include <algorithm>
#include <map>
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
  const std::string name = kind.name;
  const Shown shown = study.has_torque() ? std::max(kind.force, kind.torque) : kind.force;
  if (shown == Shown::kNever) return because("it changes torques alone, and none is measured");
  if (shown == Shown::kInMotion) {
    if (study.is_static()) return because("at rest the force does not depend on it");
    if (!has_acceleration(study)) return because("no position or acceleration is logged");
  }
  if (kind.stage == Stage::kTool && !study.own_tool && name != "mass") {
    return because("the simulator's own tool is not known");
  }
  if (name == "weightless_mass" && study.has_inertia) {
    return because("what is simulated has its inertia");
  }
  if (name == "time_delay" && study.axis && study.axis->system.axes.size() > 1) {
    return because("the axes share one clock: none of them alone is late");
  }
  if ((name == "viscous_friction" || name == "inertia") && reads_a_motion(study)) {
    return because("what is read is a motion, of which a delay looks like it");
  }
  if (name == "inertial_terms" && study.simulator.model.inertial == ToolModel::Inertial::kFull) {
    return because("the simulator has all inertial terms");
  }
  if (name == "gain" && study.axis && !study.logs.front().regressors.empty()) {
    return because("the coefficients of the base simulator are fitted, and a scale is in them");
  }
  if (name == "bias" && has_own_offsets(study)) {
    return because("each recording has an offset of its own (zeroed)");
  }
  return true;
}

bool is_in_base(const Case& study, const EffectKind& kind) {
  static const std::map<std::string, std::string> kLaws{
      {"position", "cable_spring"}, {"velocity", "viscous_friction"}, {"acceleration", "inertia"}};
  if (!study.axis) return false;
  const std::vector<std::string>& base = study.axis->axis().base;
  return std::any_of(base.begin(), base.end(), [&](const std::string& signal) {
    const auto law = kLaws.find(signal);
    return law != kLaws.end() && law->second == kind.name;
  });
}

std::vector<Member> own_parameters(const Case& study) {
  std::vector<Member> members;
  // An arm's links are fitted to these recordings: their scale is no number of its own.
  if (study.axis && study.axis->base_deviations.size() > 0) return members;
  for (const char* name : {"mass", "com", "gravity_tilt", "bias", "gain"}) {
    const EffectKind& kind = *find_effect(name);
    // Of another machine's simulator its scale is all that is known; a fitted base is fitted.
    const bool scale = std::string(name) == "gain";
    if (scale != (study.axis != nullptr) || !is_testable(study, kind)) continue;
    Member member = make_member(study, kind, first_form(study, kind), "", Eigen::VectorXd(0));
    member.amplitudes.setZero();
    members.push_back(member);
  }
  return members;
}

}  // namespace dcnn
