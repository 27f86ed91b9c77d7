// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "check/arm.h"
#include "check/combined.h"
#include "check/joints.h"
#include "check/kind.h"
#include "check/rows.h"
#include "check/statistics.h"
#include "data/held_rows.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr int kRounds = 3;           // faults that come together
constexpr double kMentioned = 0.02;  // a rival of less probability is not listed
constexpr Index kFewestCentres = 6;  // of a fit with seven unknowns

Eigen::MatrixXd centred(const Eigen::MatrixXd& m) { return m.rowwise() - m.colwise().mean(); }

/// Kinematics by what they depend on: many readings share them.
class Motions {
 public:
  Motions(const Log& log, const Sampled& rows) : log_(log), rows_(rows) {}

  const Kinematics& of(const Reading& reading) {
    for (const auto& [key, motion] : known_) {
      if (key.orientation == reading.orientation && key.angle == reading.angle) return motion;
    }
    known_.emplace_back(reading, kinematics(log_, rows_, reading));
    return known_.back().second;
  }

 private:
  const Log& log_;
  const Sampled& rows_;
  std::vector<std::pair<Reading, Kinematics>> known_;
};

/// All readings one fault away from `base`, those of a fit only where there is a motion. A kind's
/// prior is shared by the weights that its readings have.
std::vector<Reading> readings_about(const Log& log, const Sampled& rows, const Reading& base,
                                    const Kinematics* motion) {
  std::vector<Reading> all{base};
  all[0].fault.clear();
  all[0].words = "as declared";
  for (const FaultKind* kind : fault_kinds()) {
    std::vector<Reading> variants;
    if (kind->readings != nullptr) kind->readings(log, base, variants);
    if (kind->estimates != nullptr && motion != nullptr) {
      kind->estimates({log, rows, *motion, base}, variants);
    }
    double sum = 0.0;
    for (const Reading& variant : variants) sum += variant.prior;
    for (Reading& variant : variants) {
      variant.fault = kind->id;
      variant.prior *= kFaultPrior / sum;
      all.push_back(std::move(variant));
    }
  }
  return all;
}

const FaultKind& kind_of(const std::string& id) {
  for (const FaultKind* kind : fault_kinds()) {
    if (kind->id == id) return *kind;
  }
  fail(Exit::kFailure, "no fault is called '", id, "'");
}

struct Round {
  std::vector<Reading> readings;
  Eigen::VectorXd probability;
  std::map<std::string, double> of_fault;
  Index best = 0;
};

Eigen::VectorXd weights_of(const Log& log, const Sampled& rows, Motions* motions,
                           const std::vector<Reading>& readings) {
  Eigen::VectorXd weights(static_cast<Index>(readings.size()));
  for (Index k = 0; k < weights.size(); ++k) {
    const Reading& reading = readings[static_cast<std::size_t>(k)];
    weights[k] = finite_log_weight(log, rows, motions ? &motions->of(reading) : nullptr, reading);
  }
  return weights;
}

/// Of each of the log's joints, by the correlation of what a reading leaves.
Eigen::VectorXd independent_torques(const Log& log, const Sampled& rows, const Reading& reading) {
  const ArmFit fit = fit_arm(log, rows, reading);
  Eigen::VectorXd independent = Eigen::VectorXd::Zero(static_cast<Index>(log.joints.size()));
  for (Index j = 0; j < fit.residual.cols(); ++j) {
    independent[static_cast<Index>(reading.arm.joint[static_cast<std::size_t>(j)])] =
        std::min(fit.independent, independent_of(fit.residual.col(j)));
  }
  return independent;
}

/// Columns of joints are exchanged where two torques at least say so: what one alone gains by it
/// may be something that nobody described, as a cable or another joint's friction that it feels.
/// Such a reading has the weight that it has without the torque that gains most.
void weigh_orders(const Log& log, const Sampled& rows, const std::vector<Reading>& readings,
                  Eigen::VectorXd& weights) {
  if (!can_fit_arm(log, rows)) return;
  const Eigen::VectorXd declared = arm_weight(log, rows, readings[0]).of_torque;
  for (Index k = 1; k < weights.size(); ++k) {
    const Reading& reading = readings[static_cast<std::size_t>(k)];
    if (weights[k] <= weights[0] || reading.arm.joint == readings[0].arm.joint) continue;
    const Eigen::VectorXd gains = arm_weight(log, rows, reading).of_torque - declared;
    weights[k] -= std::max(0.0, gains.maxCoeff());
  }
}

Round weigh(const Log& log, const Sampled& sampled, Motions* motions, const Reading& base) {
  Round round;
  Sampled rows = sampled;
  round.readings = readings_about(log, rows, base, motions ? &motions->of(base) : nullptr);
  Eigen::VectorXd weights = weights_of(log, rows, motions, round.readings);
  // What friction leaves of a joint at rest is alike for as long as it rests. How many residuals
  // are independent the likeliest reading tells: what a wrong one leaves is alike for long, too.
  Index likeliest_reading = 0;
  weights.maxCoeff(&likeliest_reading);
  const Reading& likeliest_of_all = round.readings[static_cast<std::size_t>(likeliest_reading)];
  if (!likeliest_of_all.fault.empty() && can_fit_arm(log, rows)) {
    rows.independent_torques = independent_torques(log, rows, likeliest_of_all);
    weights = weights_of(log, rows, motions, round.readings);
  }
  weigh_orders(log, rows, round.readings, weights);
  round.probability = shares_of(weights);
  for (Index k = 0; k < weights.size(); ++k) {
    round.of_fault[round.readings[static_cast<std::size_t>(k)].fault] += round.probability[k];
  }
  // The likeliest fault first, then its likeliest variant: variants share one prior.
  std::string likeliest;
  for (const auto& [fault, p] : round.of_fault) {
    if (p > round.of_fault[likeliest]) likeliest = fault;
  }
  round.best = -1;
  for (Index k = 0; k < weights.size(); ++k) {
    if (round.readings[static_cast<std::size_t>(k)].fault != likeliest) continue;
    if (round.best < 0 || weights[k] > weights[round.best]) round.best = k;
  }
  return round;
}

Fault fault_from(const Round& round, const Reading& reading) {
  Fault fault = fault_of(kind_of(reading.fault), round.of_fault.at(reading.fault), reading.channel,
                         reading.words);
  if (!reading.flag.empty()) fault.flag = reading.flag;
  if (!reading.remedy.empty()) fault.remedy = reading.remedy;
  fault.stops = fault.stops && !reading.harmless;
  return fault;
}

/// The rivals of the likeliest reading that are worth a line.
void list_rivals(const Round& round, Adopted& out) {
  for (const auto& [id, p] : round.of_fault) {
    const Reading& best = round.readings[static_cast<std::size_t>(round.best)];
    if (id.empty() || id == best.fault || p < kMentioned) continue;
    const Reading* likeliest = nullptr;
    double most = -1.0;
    for (std::size_t k = 0; k < round.readings.size(); ++k) {
      const double here = round.probability[static_cast<Index>(k)];
      if (round.readings[k].fault == id && here > most) most = here, likeliest = &round.readings[k];
    }
    out.faults.push_back(fault_from(round, *likeliest));
  }
}

void list_weights(const Round& round, Adopted& out) {
  for (std::size_t k = 0; k < round.readings.size(); ++k) {
    const double p = round.probability[static_cast<Index>(k)];
    if (p >= 1e-6) out.weights.push_back({round.readings[k].words, p});
  }
  std::sort(out.weights.begin(), out.weights.end(),
            [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

/// Whether the force never changes: then no reading of the log explains more of it than another.
bool is_dead(const Log& log) {
  return never_changes(log.column("fx")) && never_changes(log.column("fy")) &&
         never_changes(log.column("fz"));
}

/// Faults one after another from `out.reading` on; the prior of all that are applied.
double adopt_rounds(const Log& log, Motions* motions, Adopted& out) {
  double prior = 1.0;
  for (int k = 0; k < kRounds; ++k) {
    out.reading.prior = 1.0;
    out.reading.estimated = 0;
    say_nothing(out.reading);
    const Round round = weigh(log, out.rows, motions, out.reading);
    if (k == 0) list_weights(round, out);
    const Reading& best = round.readings[static_cast<std::size_t>(round.best)];
    list_rivals(round, out);
    if (best.fault.empty()) break;
    out.faults.push_back(fault_from(round, best));
    if (out.faults.back().probability < kLikely) break;
    out.reading = best;
    prior *= best.prior;
  }
  return prior;
}

/// Where one fault at a time has led somewhere, or to no tool that explains the force: several at
/// once.
void adopt_combined(const Log& log, double prior, Motions& motions, Adopted& out) {
  const auto fit_beside_friction = [&] {
    out.beside_friction = fit_rigid(log, out.rows, motions.of(out.reading), out.reading, {0, true});
  };
  fit_beside_friction();
  const RigidFit& fit = out.beside_friction;
  const double share = fit.residual.squaredNorm() / centred(fit.force).squaredNorm();
  if (prior == 1.0 && fit.mass > 0.0 && share < kMostForeign) return;
  Reading rival = out.reading;
  rival.prior = prior;
  const Combined found = combine(log, out.rows, declared_reading(log), rival);
  if (found.parts.empty()) return;
  out.faults.clear(), out.weights.clear();
  out.reading = found.parts.back();
  adopt_rounds(log, &motions, out);
  fit_beside_friction();
  for (std::size_t k = 0; k < found.parts.size(); ++k) {
    const Reading& part = found.parts[k];
    const Round alone{{part}, {}, {{part.fault, found.probability[k]}}, 0};
    out.faults.push_back(fault_from(alone, part));
  }
}

}  // namespace

Reading declared_reading(const Log& log) {
  Reading reading;
  reading.position = log.declared.read.position_unit;
  reading.angle = reading.rate = log.declared.read.angle_unit;
  reading.force = 1.0;
  reading.force_axes *= log.declared.read.force_sign;
  reading.orientation.order = log.has_quaternion() ? "wxyz" : "zyx";
  const auto joints = static_cast<Index>(log.arm.size());
  reading.arm.joint = log.arm;
  reading.arm.sign = reading.arm.torque = Eigen::VectorXd::Ones(joints);
  reading.arm.zero = Eigen::VectorXd::Zero(joints);
  return reading;
}

Adopted adopt(const Log& log) {
  Adopted out;
  out.reading = declared_reading(log);
  out.rows = sample(log);
  out.compared = log.is_wrist() && static_cast<Index>(out.rows.centres.size()) >= kFewestCentres &&
                 !is_dead(log);
  out.independent = independent_residuals(log, out.rows);
  Motions motions(log, out.rows);
  const double prior = adopt_rounds(log, out.compared ? &motions : nullptr, out);
  if (out.compared) {
    adopt_combined(log, prior, motions, out);
    out.motion = motions.of(out.reading);
    out.fit = fit_rigid(log, out.rows, out.motion, out.reading);
  }
  return out;
}

}  // namespace dcnn::check
