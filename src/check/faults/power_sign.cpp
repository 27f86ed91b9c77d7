#include <algorithm>
#include <array>
#include <cmath>

#include "check/joints.h"
#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

using Eigen::Index;

/// How much likelier a joint's torque is with the sign that the log declares than with the other.
struct SignEvidence {
  std::string channel;
  double log_odds = 0.0;
};

constexpr Index kSigned = 2;  // own inertia and dry friction, which no joint has negative

/// Least squares with `sign` times the first columns' coefficients not below zero: the best of the
/// subsets of these columns that fulfils it. Returns the residual of the torque `y`.
Eigen::VectorXd residual_with_sign(const Eigen::MatrixXd& A, const Eigen::VectorXd& y,
                                   double sign) {
  const Eigen::MatrixXd normal =
      A.transpose() * A + 1e-9 * Eigen::MatrixXd::Identity(A.cols(), A.cols());
  const Eigen::VectorXd right = A.transpose() * y;
  Eigen::VectorXd best;
  for (int subset = 0; subset < (1 << kSigned); ++subset) {
    Eigen::MatrixXd held = normal;
    for (Index k = 0; k < kSigned; ++k) {
      if (!(subset >> k & 1)) held(k, k) += 1e15;  // a coefficient held at zero
    }
    const Eigen::VectorXd x = held.ldlt().solve(right);
    if ((sign * x.head(kSigned).array() < -1e-9 * y.norm()).any()) continue;
    Eigen::VectorXd residual = y - A * x;
    if (best.size() == 0 || residual.squaredNorm() < best.squaredNorm()) best = std::move(residual);
  }
  return best;
}

/// The likelihood ratio of normal residuals of unknown variance, of as many rows as are
/// independent.
SignEvidence sign_of(const Log& log, const Joint& joint, const Sampled& rows,
                     const std::vector<JointMotion>& motions, std::size_t own) {
  const Eigen::VectorXd y = joint.scale * rows.smoothed(log.column(joint.measured), rows.value);
  const Eigen::MatrixXd A = torque_columns(motions, own, Place::kGravity);
  const Eigen::VectorXd with = residual_with_sign(A, y, 1.0),
                        against = residual_with_sign(A, y, -1.0);
  const double independent =
      std::min(kMostIndependent, 0.75 * static_cast<double>(with.size() - A.cols()));
  // Rounding of a torque that is explained to the last digit is no evidence.
  const double floor = 1e-12 * y.squaredNorm() + 1e-300;
  return {joint.measured,
          0.5 * independent *
              elementary::log((against.squaredNorm() + floor) / (with.squaredNorm() + floor))};
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
    return sign.log_odds > elementary::log(kCertain / (1.0 - kCertain));
  });
  for (const SignEvidence& sign : signs) {
    const double odds = elementary::exp(-sign.log_odds) * kFaultPrior / (1.0 - kFaultPrior);
    // A drive's torque and its reaction are both logged; joints of one log that differ are not.
    Fault fault = fault_of(
        power_sign_fault, odds / (1.0 + odds), sign.channel,
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
