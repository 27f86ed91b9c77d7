// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "check/joints.h"
#include "check/rows.h"
#include "check/statistics.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

using Eigen::Index;

/// How much likelier a joint's torque is with the sign that the log declares than with the other.
struct SignEvidence {
  std::string channel;
  double log_odds = 0.0;
};

/// Own inertia and dry friction, which no joint has below zero. (A drive that holds a joint which
/// others move may damp it.)
constexpr Index kSigned = 2;
constexpr Index kLeftOut = 12;  // of time, one of which is left out in turn

/// Least squares of y = A x from its normal equations, with `sign` times the first coefficients not
/// below zero: the best of the subsets of these columns that fulfils it.
Eigen::VectorXd solve_with_sign(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right,
                                double sign, double size) {
  Eigen::VectorXd best;
  double most = 0.0;  // of what is explained
  for (int subset = 0; subset < (1 << kSigned); ++subset) {
    Eigen::MatrixXd held = normal;
    for (Index k = 0; k < kSigned; ++k) {
      if (!(subset >> k & 1)) held(k, k) += 1e15;  // a coefficient held at zero
    }
    const Eigen::VectorXd x = held.ldlt().solve(right);
    if ((sign * x.head(kSigned).array() < -1e-9 * size).any()) continue;
    const double explained = x.dot(right);
    if (best.size() == 0 || explained > most) most = explained, best = x;
  }
  return best;
}

/// Of each stretch of time the logarithm of what the opposite sign leaves of it over what this one
/// does, of squares per row, each fitted to the other stretches; `floor` is added to both.
Eigen::ArrayXd left_out_ratios(const Eigen::MatrixXd& A, const Eigen::VectorXd& y, double floor) {
  const Eigen::MatrixXd ridge = 1e-9 * Eigen::MatrixXd::Identity(A.cols(), A.cols());
  const Eigen::MatrixXd all = A.transpose() * A + ridge;
  const Eigen::VectorXd right = A.transpose() * y;
  Eigen::ArrayXd ratios(kLeftOut);
  for (Index k = 0; k < kLeftOut; ++k) {
    const Index begin = k * y.size() / kLeftOut, end = (k + 1) * y.size() / kLeftOut;
    const auto own = A.middleRows(begin, end - begin);
    const auto torque = y.segment(begin, end - begin);
    const Eigen::MatrixXd normal = all - own.transpose() * own;
    const Eigen::VectorXd match = right - own.transpose() * torque;
    const auto left = [&](double sign) {
      const Eigen::VectorXd x = solve_with_sign(normal, match, sign, y.norm());
      return (torque - own * x).squaredNorm() / static_cast<double>(end - begin) + floor;
    };
    ratios(k) = elementary::log(left(-1.0) / left(1.0));
  }
  return ratios;
}

/// How much likelier a mean of normal values of unknown deviation is than zero, with its sign.
double log_odds_of_mean(const Eigen::ArrayXd& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = values.mean(), square = (values - mean).square().sum();
  return std::copysign(0.5 * n * elementary::log(1.0 + n * mean * mean / (square + 1e-300)), mean);
}

/// What the description sets beside the joint's torque: a pressure, a simulated torque. Of unit
/// length, of either sign, as far as there are ten rows to a column.
void append_declared(const Log& log, const Joint& joint, const Sampled& rows, Eigen::MatrixXd& A) {
  for (const Axis& axis : log.declared.system.axes) {
    if (axis.measured != joint.measured) continue;
    std::vector<std::string> names = axis.base;
    names.push_back(axis.simulated);
    for (const std::string& name : names) {
      if (!log.has(name) || !varies(log.column(name)) || 10 * A.cols() >= A.rows()) continue;
      append(A, rows.smoothed(log.column(name), rows.value));
    }
  }
}

/// What either sign leaves of each stretch of time on which it was not fitted. What no column
/// describes is alike for seconds: it may favour one sign by far in some stretches, and not in all.
SignEvidence sign_of(const Log& log, const Joint& joint, const Sampled& rows,
                     const std::vector<JointMotion>& motions, std::size_t own) {
  const Eigen::VectorXd y = joint.scale * rows.smoothed(log.column(joint.measured), rows.value);
  Eigen::MatrixXd A = torque_columns(motions, own, Place::kGravity);
  append_declared(log, joint, rows, A);
  // Rounding of a torque that is explained to the last digit is no evidence.
  const double floor = 1e-12 * y.squaredNorm() / static_cast<double>(y.size()) + 1e-300;
  return {joint.measured, log_odds_of_mean(left_out_ratios(A, y, floor))};
}

/// Of an arm whose links are known, gravity and inertia tell it: readings of the log.
void opposite_torques(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (log.arm.empty()) return;
  Reading all = base;
  all.arm.torque *= -1.0;
  all.channel = log.joints[base.arm.joint[0]].measured;
  all.words =
      "all torques have the other sign than the arm described: they are of the load, not "
      "of the drives";
  out.push_back(all);
  for (std::size_t j = 0; j < log.arm.size() && log.arm.size() > 1; ++j) {
    Reading reading = base;
    reading.arm.torque[static_cast<Index>(j)] *= -1.0;
    reading.channel = log.joints[base.arm.joint[j]].measured;
    reading.words = log.declared.arm->joints[j].name + ": " + reading.channel +
                    " has the other sign than the arm described";
    out.push_back(std::move(reading));
  }
}

std::vector<Fault> find_power_sign(const Evidence& e) {
  const Sampled& rows = e.adopted.rows;
  std::vector<Fault> out;
  if (!e.log.arm.empty()) return out;
  if (rows.half == 0 || rows.centres.size() < 40) return out;
  const auto joints = driven_joints(e.log);
  std::vector<JointMotion> motions;
  for (const Joint* joint :
       joints) {  // as the likeliest reading has it: gravity depends on the angle
    motions.push_back(joint_motion(e.log, rows, e.adopted.reading, *joint));
  }
  std::vector<SignEvidence> signs;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    signs.push_back(sign_of(e.log, *joints[k], rows, motions, k));
  }
  const bool right = std::any_of(signs.begin(), signs.end(), [](const SignEvidence& sign) {
    return sign.log_odds > log_odds_of(kCertain);
  });
  for (const SignEvidence& sign : signs) {
    const double probability = probability_of_log_odds(log_odds_of(kFaultPrior) - sign.log_odds);
    // A drive's torque and its reaction are both logged; joints of one log that differ are not.
    Fault fault = fault_of(
        power_sign_fault, probability, sign.channel,
        sign.channel +
            ": the joint's own inertia and dry friction explain it with the opposite sign (" +
            brief(elementary::exp(std::min(-sign.log_odds, 20.0))) +
            " times as likely), as if they drove the motion: its sign is wrong" +
            (right ? ", that of other joints is right" : ", or it is the reaction of the load"));
    fault.stops = right;
    if (fault.probability >= kLikely) out.push_back(fault);
  }
  return out;
}

}  // namespace

const FaultKind power_sign_fault{"power_sign",
                                 true,
                                 "turn the sign of the column, of its scale in the system's "
                                 "description, or of the joint's position",
                                 "",
                                 find_power_sign,
                                 opposite_torques,
                                 true};

}  // namespace dcnn::check
