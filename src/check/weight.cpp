// SPDX-License-Identifier: Apache-2.0
// The log posterior of a reading, but for a constant.
#include <algorithm>
#include <cmath>

#include "check/arm.h"
#include "check/joints.h"
#include "check/reading.h"
#include "check/statistics.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr double kLeastMass = 1e-3;  // kg; below, no tool is told from none
constexpr int kMassSteps = 32;       // from the estimate to the typical mass, even in logarithms

double rms(const Eigen::MatrixXd& m) {
  return m.rows() == 0 ? 0.0 : std::sqrt(m.squaredNorm() / static_cast<double>(m.rows()));
}

Eigen::MatrixXd about_mean(const Eigen::MatrixXd& m) { return m.rowwise() - m.colwise().mean(); }

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
    sum +=
        plausibility(std::max(reading.position * rms(about_mean(motion.position)), 1e-9), kReach);
    sum += plausibility(std::max(reading.position * rms(motion.position), 1e-9), kDistance);
  }
  return sum;
}

double angle_weight(const Log& log, const Reading& reading) {
  double most = 0.0;
  if (log.has_all(kEuler) && !log.has_quaternion()) {
    most = rms(about_mean(log.block(kEuler))) / std::sqrt(3.0);
  }
  for (const std::size_t j : log.arm) {  // a limb's, with its limits
    const Joint& joint = log.joints[j];
    if (joint.turns) most = std::max(most, rms(about_mean(log.column(joint.position))));
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
           0.5 * independent_residuals(log, rows) * elementary::log(1.0 + z * z);
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
  const double floor = kToolError * rms(about_mean(logged)) / std::sqrt(3.0);
  // In the units of the log: a density of what was logged.
  return -0.5 * independent_residuals(log, rows) *
         log_variance(fit.residual / reading.force, floor);
}

}  // namespace

double independent_residuals(const Log& log, const Sampled& rows) {
  const double poses = 0.75 * static_cast<double>(rows.centres.size());
  const double slow = kIndependentPerSecond * rows.seconds(log.rows());
  return std::min({kMostIndependent, poses, rows.half == 0 ? poses : slow});
}

double log_weight(const Log& log, const Sampled& rows, const Kinematics* motion,
                  const Reading& reading) {
  double sum = elementary::log(reading.prior) + angle_weight(log, reading);
  if (reading.estimated > 0) {  // Schwarz' penalty
    sum -= 0.5 * reading.estimated * elementary::log(independent_residuals(log, rows));
  }
  if (log.smooth && log.step > 0.0) sum += clock_weight(log, reading.clock);
  if (!log.joints.empty()) {
    if (log.step > 0.0) sum += rates_weight(log, rows, reading);
    if (log.arm.empty()) sum += angles_weight(log, rows, reading);
  }
  if (can_fit_arm(log, rows)) sum += arm_weight(log, rows, reading).sum();
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

double finite_log_weight(const Log& log, const Sampled& rows, const Kinematics* motion,
                         const Reading& reading) {
  constexpr double kNoEvidence = -1e9;  // ln of a weight whose share is 0 in double
  const double weight = log_weight(log, rows, motion, reading);
  return std::isfinite(weight) ? weight : kNoEvidence + elementary::log(reading.prior);
}

}  // namespace dcnn::check
