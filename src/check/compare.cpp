#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "check/arm.h"
#include "check/joints.h"
#include "check/kind.h"
#include "check/statistics.h"
#include "core/elementary.h"
#include "data/held_rows.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr int kRounds = 3;            // faults that come together
constexpr double kMentioned = 0.02;   // a rival of less probability is not listed
constexpr Index kFewestCentres = 6;   // of a fit with seven unknowns
constexpr double kNoEvidence = -1e9;  // ln of a weight next to none
constexpr double kLeastMass = 1e-3;   // kg; below, no tool is told from none
constexpr int kMassSteps = 32;        // from the estimate to the typical mass, even in logarithms

double rms(const Eigen::MatrixXd& m) {
  return m.rows() == 0 ? 0.0 : std::sqrt(m.squaredNorm() / static_cast<double>(m.rows()));
}

Eigen::MatrixXd centred(const Eigen::MatrixXd& m) { return m.rowwise() - m.colwise().mean(); }

double motion_weight(const Log& log, const Kinematics& motion, const Reading& reading) {
  double sum = 0.0;
  if (log.smooth && log.step > 0.0) {
    const double dt = log.step * reading.clock;
    sum += plausibility(std::max(rms(motion.w) / dt, 1e-9), kTurnSpeed);
    if (motion.has_position) {
      sum += plausibility(std::max(reading.position * rms(motion.velocity) / dt, 1e-9), kSpeed);
    }
  }
  if (motion.has_position) {
    sum += plausibility(std::max(reading.position * rms(centred(motion.position)), 1e-9), kReach);
    sum += plausibility(std::max(reading.position * rms(motion.position), 1e-9), kDistance);
  }
  return sum;
}

double angle_weight(const Log& log, const Reading& reading) {
  double most = 0.0;
  if (log.has_all(kEuler) && !log.has_quaternion()) {
    most = rms(centred(log.block(kEuler))) / std::sqrt(3.0);
  }
  for (const std::size_t j : log.arm) {  // a limb's, with its limits
    const Joint& joint = log.joints[j];
    if (joint.turns) most = std::max(most, rms(centred(log.column(joint.position))));
  }
  return most > 0.0 ? plausibility(reading.angle * most, kTurn) : 0.0;
}

double mass_weight(const Log& log, const Sampled& rows, const RigidFit& fit,
                   const Reading& reading) {
  if (reading.compensated && !reading.weight_apart) return 0.0;
  Typical typical = kMass;
  if (log.declared.model) {
    typical = {log.declared.model->mass, kNominalMassSpread, kNominalMassSpread};
  }
  // The likeliest mass under the prior and the recording together: one that a motion hardly shows,
  // because it hardly turns the tool, is no surprise whatever its estimate.
  const auto weight = [&](double mass) {
    const double z = (mass - fit.free_mass) / std::max(fit.mass_spread, 1e-300);
    // Controllers subtract a mass that is meant to be the tool's.
    const double subtracted =
        reading.weight_apart ? plausibility((mass - fit.weighed) / mass, kSubtracted) : 0.0;
    return plausibility(mass, typical) + subtracted -
           0.5 * independent_residuals(rows) * elementary::log(1.0 + z * z);
  };
  const double estimate = std::max(fit.free_mass, kLeastMass);
  double best = weight(estimate);
  for (int k = 1; k <= kMassSteps; ++k) {
    const double share = static_cast<double>(k) / kMassSteps;
    best = std::max(best, weight(estimate * elementary::pow(typical.median / estimate, share)));
  }
  return best;
}

double fit_weight(const Log& log, const Sampled& rows, const RigidFit& fit,
                  const Reading& reading) {
  const Eigen::MatrixXd logged = rows.smoothed(log.block({"fx", "fy", "fz"}), rows.value);
  const double floor = kToolError * rms(centred(logged)) / std::sqrt(3.0);
  // In the units of the log: a density of what was logged.
  return -0.5 * independent_residuals(rows) * log_variance(fit.residual / reading.force, floor);
}

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

Eigen::VectorXd posterior(Eigen::VectorXd weights) {
  weights.array() -= weights.maxCoeff();
  weights = elementary::exp(weights.array());
  return weights / weights.sum();
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

Round weigh(const Log& log, const Sampled& rows, Motions* motions, const Reading& base) {
  Round round;
  round.readings = readings_about(log, rows, base, motions ? &motions->of(base) : nullptr);
  Eigen::VectorXd weights(static_cast<Index>(round.readings.size()));
  for (Index k = 0; k < weights.size(); ++k) {
    const Reading& reading = round.readings[static_cast<std::size_t>(k)];
    const double weight = log_weight(log, rows, motions ? &motions->of(reading) : nullptr, reading);
    // Numbers that overflow are refused by whoever reads the log; they are no evidence.
    weights[k] = std::isfinite(weight) ? weight : kNoEvidence;
  }
  round.probability = posterior(weights);
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

}  // namespace

double independent_residuals(const Sampled& rows) {
  return std::min(kMostIndependent, 0.75 * static_cast<double>(rows.centres.size()));
}

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

double log_weight(const Log& log, const Sampled& rows, const Kinematics* motion,
                  const Reading& reading) {
  // Schwarz' penalty for what was estimated.
  double sum = elementary::log(reading.prior) + angle_weight(log, reading) -
               0.5 * reading.estimated * elementary::log(independent_residuals(rows));
  if (log.smooth && log.step > 0.0) sum += clock_weight(log, reading.clock);
  if (!log.joints.empty()) {
    if (log.step > 0.0) sum += rates_weight(log, rows, reading);
    if (log.arm.empty()) sum += angles_weight(log, rows, reading);
  }
  if (can_fit_arm(log, rows)) sum += arm_weight(log, rows, reading);
  if (motion == nullptr) return sum;
  sum += motion_weight(log, *motion, reading);
  const auto weight = [&](const Reading& as) {
    const RigidFit fit = fit_rigid(log, rows, *motion, as, {0, true});
    return mass_weight(log, rows, fit, as) + fit_weight(log, rows, fit, as);
  };
  const double own = weight(reading);
  if (!motion->has_position || reading.fault == "position_unit") return sum + own;
  // Positions in a larger unit would explain, too, that nothing of their accelerations is felt.
  Reading quasi_static = reading;
  quasi_static.position = 0.0;
  return sum + std::max(own, weight(quasi_static) + elementary::log(kQuasiStatic));
}

/// Whether the force never changes: then no reading of the log explains more of it than another.
bool is_dead(const Log& log) {
  return never_changes(log.column("fx")) && never_changes(log.column("fy")) &&
         never_changes(log.column("fz"));
}

Adopted adopt(const Log& log) {
  Adopted out;
  out.reading = declared_reading(log);
  out.rows = sample(log);
  out.compared = log.is_wrist() && static_cast<Index>(out.rows.centres.size()) >= kFewestCentres &&
                 !is_dead(log);
  out.independent = independent_residuals(out.rows);
  Motions motions(log, out.rows);
  for (int k = 0; k < kRounds; ++k) {
    out.reading.prior = 1.0;
    out.reading.estimated = 0;
    const Round round = weigh(log, out.rows, out.compared ? &motions : nullptr, out.reading);
    if (k == 0) list_weights(round, out);
    const Reading& best = round.readings[static_cast<std::size_t>(round.best)];
    list_rivals(round, out);
    if (best.fault.empty()) break;
    out.faults.push_back(fault_from(round, best));
    if (out.faults.back().probability < kLikely) break;
    out.reading = best;
  }
  if (out.compared) {
    out.motion = motions.of(out.reading);
    out.fit = fit_rigid(log, out.rows, out.motion, out.reading);
  }
  return out;
}

}  // namespace dcnn::check
