// SPDX-License-Identifier: Apache-2.0
#include "dcnn/check/check.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "check/arm.h"
#include "check/kind.h"
#include "check/priors.h"
#include "check/rows.h"
#include "physics/foreign_force.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr double kListed = 0.05;  // of a fault's probability; less is not worth a line
constexpr std::size_t kReadingsListed = 8;

/// What one fault does to the statistic of another: the consequence is not listed beside its cause,
/// where that is certain or the likelier one.
const std::vector<std::pair<std::string, std::string>> kConsequences{
    {"counts", "force_unit"},     {"counts", "quantisation"},   {"wrap", "spikes"},
    {"wrap", "contact"},          {"dropouts", "spikes"},       {"dropouts", "frozen"},
    {"saturation", "frozen"},     {"frozen", "contact"},        {"saturation", "contact"},
    {"held", "quantisation"},     {"held", "frozen"},           {"frozen", "held"},
    {"clock_order", "jitter"},    {"moving_rows", "no_motion"}, {"frozen", "delay"},
    {"contact", "position_axes"}, {"no_motion", "delay"},       {"spikes", "contact"},
    {"dropouts", "contact"}};

void drop_consequences(std::vector<Fault>& faults) {
  const std::vector<Fault> all = faults;
  std::erase_if(faults, [&](const Fault& fault) {
    return std::any_of(all.begin(), all.end(), [&](const Fault& cause) {
      return cause.probability >= std::max(kLikely, std::min(fault.probability, kCertain)) &&
             std::find(kConsequences.begin(), kConsequences.end(), std::pair(cause.id, fault.id)) !=
                 kConsequences.end();
    });
  });
}

/// Counts and a unit of force explain the same numbers: one or the other.
void share_units_with_counts(std::vector<Fault>& faults) {
  double counts = 0.0;
  for (const Fault& fault : faults) {
    if (fault.id == "counts") counts = std::max(counts, fault.probability);
  }
  for (Fault& fault : faults) {
    if (fault.id == "force_unit") fault.probability = std::min(fault.probability, 1.0 - counts);
  }
}

void drop_readings_of_forces(std::vector<Fault>& faults, const std::string& but = "") {
  std::erase_if(faults, [&](const Fault& fault) {
    return std::any_of(fault_kinds().begin(), fault_kinds().end(), [&](const FaultKind* kind) {
      return kind->id == fault.id && kind->of_force && fault.id != but;
    });
  });
}

/// A column that is no force at all leaves nothing to fit a tool to: no reading, and where it wraps
/// no shift in time and no offset either.
void drop_readings_of_broken_columns(const Log& log, std::vector<Fault>& faults) {
  const auto broken = [&](const char* id) {
    return std::any_of(faults.begin(), faults.end(), [&](const Fault& fault) {
      return fault.id == id && fault.probability >= kLikely;
    });
  };
  if (log.is_wrist() && broken("wrap")) {
    std::erase_if(faults,
                  [](const Fault& fault) { return fault.id == "delay" || fault.id == "zeroed"; });
  }
  if (broken("wrap") || broken("dropouts")) drop_readings_of_forces(faults);
}

/// Certain ones that stop first; a register that wraps before what else its counts show; the rest
/// by falling probability.
void sort_faults(std::vector<Fault>& faults) {
  const auto rank = [](const Fault& fault) {
    return std::tuple(!(fault.stops && fault.probability >= kCertain),
                      !(fault.id == "wrap" && fault.probability >= kCertain), -fault.probability);
  };
  std::stable_sort(faults.begin(), faults.end(),
                   [&](const Fault& a, const Fault& b) { return rank(a) < rank(b); });
}

/// What the motion shows of a rigid tool: relative deviations from the fit's covariance.
void set_identifiable(const Adopted& a, Report& report) {
  if (!a.compared) return;
  const Eigen::VectorXd deviation = fit_deviations(a);
  const double newtons = kOffsetTold * kEarthGravity * std::max(a.fit.mass, kLightTool);
  const bool mass = a.fit.mass > 0.0 && deviation[0] < kMassTold * a.fit.mass;
  report.identifiable["mass"] = mass;
  for (Index k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    report.identifiable["com_" + axis] = mass && deviation[1 + k] < kCentreTold * a.fit.mass;
    report.identifiable["bias_" + axis] = deviation[4 + k] < newtons;
  }
  report.identifiable["friction"] = a.motion.has_position && a.rows.half > 0;
  report.identifiable["delay"] = a.rows.half > 0;
}

/// Seconds of these rows; their numbers without a clock.
Eigen::VectorXd times_of(const Log& log, const Adopted& a, const std::vector<Index>& rows) {
  Eigen::VectorXd t(static_cast<Index>(rows.size()));
  for (Index i = 0; i < t.size(); ++i) {
    const Index row = rows[static_cast<std::size_t>(i)];
    t[i] = log.t.size() > 0 ? log.t[row] * a.reading.clock : static_cast<double>(row);
  }
  return t;
}

void set_curves(const Log& log, const Adopted& a, Report& report) {
  if (!a.compared) return;
  const Eigen::VectorXd t = times_of(log, a, a.rows.centres);
  for (Index j = 0; j < 3; ++j) {
    const std::string axis = std::string("f") + "xyz"[j];
    report.measured.push_back({axis, "force [N]", t, a.fit.force.col(j)});
    report.rigid.push_back({axis, "force [N]", t, a.fit.force.col(j) - a.fit.residual.col(j)});
  }
  report.model = "rigid tool";
}

/// What the motion shows of a drive, relative to the joint's torque.
void set_identifiable_drives(const Log& log, const ArmFit& fit, Report& report) {
  const Eigen::MatrixXd deviation = drive_deviation(fit);
  for (Index j = 0; j < deviation.rows(); ++j) {
    const std::string& joint = log.declared.arm->joints[static_cast<std::size_t>(j)].name;
    Index term = 1;
    for (const char* stem : {"dry_", "viscous_", "inertia_"}) {
      report.identifiable[stem + joint] = deviation(j, term++) < kDriveTold;
    }
  }
}

void set_arm_curves(const Log& log, const Adopted& a, const ArmFit& fit, Report& report) {
  const Eigen::VectorXd t = times_of(log, a, fit.rows);
  for (Index j = 0; j < fit.torque.cols(); ++j) {
    const ChainJoint& joint = log.declared.arm->joints[static_cast<std::size_t>(j)];
    const std::string quantity = joint.slides ? "force [N]" : "torque [N·m]";
    report.measured.push_back({joint.name, quantity, t, fit.torque.col(j)});
    report.rigid.push_back({joint.name, quantity, t, fit.torque.col(j) - fit.residual.col(j)});
  }
  report.model = "arm described";
}

double foreign_share_of(const Log& log, const Adopted& a) {
  const double power = (a.fit.force.rowwise() - a.fit.force.colwise().mean()).squaredNorm();
  double noise = 0.0;
  for (const char* name : {"fx", "fy", "fz"}) {
    noise += std::pow(a.reading.force * noise_of(log.column(name)), 2);
  }
  noise *= a.rows.value.squaredNorm() * static_cast<double>(a.fit.residual.rows());
  return foreign_share(a.fit.residual.squaredNorm(), noise, power);
}

std::string foreign_note_of(const Log& log, const Adopted& a) {
  return foreign_force_note(
      foreign_share_of(log, a),
      "contacts, friction, or a force and a pose that do not belong together; no mass or offset "
      "from this log is the tool's");
}

void add_notes(const Log& log, const Adopted& a, const std::optional<ArmFit>& fit, Report& report) {
  if (a.compared) {
    const std::string note = foreign_note_of(log, a);
    if (note.empty()) return;
    report.notes.push_back(note);
    // Signs, axes and frames by which a tool explains the rest, however well, may be of what a
    // controller subtracted or of a cable.
    drop_readings_of_forces(report.faults, "compensated");
    return;
  }
  if (fit) {
    const std::string note =
        foreign_force_note(unexplained_share(*fit),
                           "another arm than described, contacts, or torques that are none; signs, "
                           "zeros and orders of "
                           "its joints are not told from this log",
                           "what the torques vary by is not the described arm's");
    if (note.empty()) return;
    report.notes.push_back(note);
    drop_readings_of_forces(report.faults);
    return;
  }
  report.notes.push_back(
      log.is_wrist()
          ? "too short to fit a rigid tool, or its force never changes: units, signs, axes and "
            "frames were not compared"
          : "no pose with forces: units, signs and axes were compared by their size alone");
}

}  // namespace

const Fault* Report::stopping(const std::vector<std::string>& accepted) const {
  for (const Fault& fault : faults) {
    const bool passes = std::find(accepted.begin(), accepted.end(), fault.id) != accepted.end();
    if (fault.stops && fault.probability >= kCertain && !passes) return &fault;
  }
  return nullptr;
}

Report check(const Log& log) {
  Report report;
  report.log = log.name;
  const Adopted adopted = adopt(log);
  report.faults = adopted.faults;
  const Evidence evidence{log, adopted};
  for (const FaultKind* kind : fault_kinds()) {
    if (kind->find == nullptr) continue;
    for (Fault& fault : kind->find(evidence)) report.faults.push_back(std::move(fault));
  }
  share_units_with_counts(report.faults);
  // What is no number is no evidence either.
  std::erase_if(report.faults, [](const Fault& fault) { return !(fault.probability >= kListed); });
  drop_consequences(report.faults);
  drop_readings_of_broken_columns(log, report.faults);
  sort_faults(report.faults);
  report.readings = adopted.weights;
  if (report.readings.size() > kReadingsListed) report.readings.resize(kReadingsListed);
  set_identifiable(adopted, report);
  set_curves(log, adopted, report);
  std::optional<ArmFit> fit;
  if (can_fit_arm(log, adopted.rows)) fit = fit_arm(log, adopted.rows, adopted.reading);
  if (fit) set_identifiable_drives(log, *fit, report), set_arm_curves(log, adopted, *fit, report);
  add_notes(log, adopted, fit, report);
  return report;
}

}  // namespace dcnn::check
