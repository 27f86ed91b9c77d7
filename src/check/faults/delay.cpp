// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/held.h"
#include "check/joints.h"
#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr Eigen::Index kMostShift = 40;
constexpr std::size_t kFewestForDelay = 100;  // rows, of a fit of a joint's torque
/// Speeds [m/s] over which dry friction changes its sign: about what the window makes of any, and a
/// sharp one.
constexpr double kFrictionSpeeds[] = {0.02, 0.005};

/// Shares of a joint's rms speed, the same.
constexpr double kJointFrictionShares[] = {0.05, 0.01};

std::vector<Fault> delay_fault_of(const Evidence& e, double log_odds, Eigen::Index shift,
                                  const std::string& channel, const std::string& what) {
  const double seconds =
      e.log.step * e.adopted.reading.clock * static_cast<double>(std::abs(shift));
  return {fault_of(delay_fault, probability_of_log_odds(log_odds), channel,
                   what + (shift > 0 ? " lags" : " leads") + " the logged motion by " +
                       brief(1e3 * seconds) + " ms")};
}

/// A joint's torque less what its motion explains, for any shift in rows.
class JointShift {
 public:
  JointShift(const Evidence& e, const std::vector<const Joint*>& joints,
             std::vector<JointMotion> motions, std::size_t own)
      : rows_(e.adopted.rows), torque_(e.log.column(joints[own]->measured)) {
    for (const double share : kJointFrictionShares) {
      motions[own].dry = smoothed_dry(e.log, rows_, *joints[own], share);
      const Eigen::MatrixXd A = torque_columns(motions, own, Place::kGravity);
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
      bases_.push_back(qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), qr.rank()));
    }
    const Eigen::VectorXd y = rows_.smoothed(torque_, rows_.value);
    floor_ = kToolError * std::sqrt((y.array() - y.mean()).square().mean());
  }

  /// With the friction that suits this shift best.
  Eigen::VectorXd residual(Eigen::Index shift) const {
    const Eigen::VectorXd y = rows_.smoothed(torque_, rows_.value, shift);
    Eigen::VectorXd least;
    for (const Eigen::MatrixXd& basis : bases_) {
      Eigen::VectorXd here = y - basis * (basis.transpose() * y);
      if (least.size() == 0 || cost(here) < cost(least)) least = std::move(here);
    }
    return least;
  }
  double cost(const Eigen::VectorXd& residual) const {
    return 0.5 * log_variance(residual, floor_);
  }

 private:
  const Sampled& rows_;
  Eigen::VectorXd torque_;
  std::vector<Eigen::MatrixXd> bases_;
  double floor_ = 0.0;
};

/// Gains of log-likelihood of one joint by every shift from -reach to reach.
Eigen::VectorXd gains_of(const JointShift& joint, Eigen::Index reach) {
  Eigen::VectorXd cost(2 * reach + 1);
  for (Eigen::Index s = -reach; s <= reach; ++s) cost[s + reach] = joint.cost(joint.residual(s));
  Eigen::Index best = 0;
  cost.minCoeff(&best);
  const double independent =
      std::min(kMostIndependent, independent_of(joint.residual(best - reach)));
  return independent * (double(cost[reach]) - cost.array());
}

/// Rows by which the force lags because it is held for k rows, or leads because the pose is: the
/// value is older by (k-1)/2 rows in the mean.
Eigen::Index held_shift(const Log& log) {
  const auto lag = [&](const std::vector<std::string>& names) {
    const Held held = held_of(log, names);
    return held.probability >= kLikely ? held.length / 2 : 0;
  };
  return lag({"fx", "fy", "fz"}) - lag(log.positions());
}

/// One delay for all channels, by each one's gains (shifts,channels) of log-likelihood for shifts
/// from -K to K, against the shift that held values explain. What a channel's model leaves may look
/// like a shift of its own, with the probability `own_shift`; no such shift is another channel's.
std::vector<Fault> delay_of(const Evidence& e, const Eigen::MatrixXd& gains, double own_shift,
                            Eigen::Index held, const std::string& channel,
                            const std::string& what) {
  const Eigen::Index reach = gains.rows() / 2;
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(gains.rows());
  for (Eigen::Index k = 0; k < gains.cols(); ++k) {
    const Eigen::VectorXd likelihood =
        elementary::exp(gains.col(k).array() - double(gains.col(k).maxCoeff()));
    const double own = own_shift * likelihood.mean();
    weight.array() += elementary::log(own + (1.0 - own_shift) * likelihood.array());
  }
  // What is held explains its shift to a row.
  const Eigen::Index slack = held == 0 ? 0 : 1;
  const Eigen::Index begin =
      std::clamp<Eigen::Index>(reach + std::min<Eigen::Index>(held, 0) - slack, 0, 2 * reach);
  const Eigen::Index end = std::clamp<Eigen::Index>(
      reach + std::max<Eigen::Index>(held, 0) + slack + 1, 1, 2 * reach + 1);
  weight.array() -= double(weight.segment(begin, end - begin).maxCoeff());
  weight.segment(begin, end - begin).setConstant(-INFINITY);
  Eigen::Index best = 0;
  const double most = weight.maxCoeff(&best);
  if (!std::isfinite(most)) return {};
  const double log_odds =
      elementary::log(kFaultPrior / static_cast<double>(2 * reach)) + log_sum(weight);
  return delay_fault_of(e, log_odds, best - reach, channel, what);
}

/// One delay for the torques of all joints.
std::vector<Fault> find_joint_delay(const Evidence& e) {
  const Sampled& rows = e.adopted.rows;
  if (rows.half == 0 || rows.centres.size() < kFewestForDelay) return {};
  const auto joints = driven_joints(e.log);
  std::vector<JointMotion> motions;
  for (const Joint* joint : joints) {
    motions.push_back(joint_motion(e.log, rows, e.adopted.reading, *joint));
  }
  const Eigen::Index reach = std::min(kMostShift, e.log.rows() / 20);
  Eigen::MatrixXd gains(2 * reach + 1, static_cast<Eigen::Index>(joints.size()));
  for (std::size_t k = 0; k < joints.size(); ++k) {
    gains.col(static_cast<Eigen::Index>(k)) = gains_of(JointShift(e, joints, motions, k), reach);
  }
  return delay_of(e, gains, kJointShift, 0, joints.empty() ? "" : joints[0]->measured,
                  "the joints' torque");
}

/// The force less what a rigid tool explains, for any shift in rows, axis by axis: physics that
/// acts along one of them leaves the others' weights as they are.
class ForceShift {
 public:
  explicit ForceShift(const Evidence& e) : e_(e) {
    const Adopted& a = e.adopted;
    for (const double speed : kFrictionSpeeds) {
      if (!a.motion.has_position) break;
      frictions_.push_back(smoothed_friction(e.log, a.rows, a.reading, speed));
    }
    if (frictions_.empty()) frictions_.emplace_back();
    const Eigen::MatrixXd about = a.fit.force.rowwise() - a.fit.force.colwise().mean();
    floor_ = kToolError * about.norm() / std::sqrt(static_cast<double>(about.size()));
  }

  /// With the friction that suits this shift best, (n,3).
  Eigen::MatrixXd residual(Eigen::Index shift) const {
    Eigen::MatrixXd least;
    for (const Eigen::MatrixXd& friction : frictions_) {
      FitOptions options{shift, true, friction.size() > 0 ? &friction : nullptr};
      options.axis_floor = floor_;
      Eigen::MatrixXd here =
          fit_rigid(e_.log, e_.adopted.rows, e_.adopted.motion, e_.adopted.reading, options)
              .residual;
      if (least.size() == 0 || costs(here).sum() < costs(least).sum()) least = std::move(here);
    }
    return least;
  }

  Eigen::Vector3d costs(const Eigen::MatrixXd& residual) const {
    Eigen::Vector3d costs;
    for (Eigen::Index j = 0; j < 3; ++j) costs[j] = 0.5 * log_variance(residual.col(j), floor_);
    return costs;
  }

  /// Gains of log-likelihood of each axis by shifts from -reach to reach, (shifts,3).
  Eigen::MatrixXd gains(Eigen::Index reach) const {
    Eigen::MatrixXd cost(2 * reach + 1, 3);
    Eigen::MatrixXd best;
    double least = INFINITY;
    for (Eigen::Index s = -reach; s <= reach; ++s) {
      Eigen::MatrixXd here = residual(s);
      cost.row(s + reach) = costs(here).transpose();
      if (cost.row(s + reach).sum() < least) {
        least = cost.row(s + reach).sum();
        best = std::move(here);
      }
    }
    // A delay leaves a residual that is alike for long; how many are independent the better one
    // tells.
    Eigen::MatrixXd gain(cost.rows(), 3);
    for (Eigen::Index j = 0; j < 3; ++j) {
      const double independent = std::min(kMostIndependent, independent_of(best.col(j)));
      gain.col(j) = independent * (double(cost(reach, j)) - cost.col(j).array());
    }
    return gain;
  }

 private:
  const Evidence& e_;
  std::vector<Eigen::MatrixXd> frictions_;
  double floor_ = 0.0;
};

/// One delay for all axes of the force. What physics beyond the tool leaves along one of them may
/// look like a shift of its own, as for joints.
std::vector<Fault> find_delay(const Evidence& e) {
  const Adopted& a = e.adopted;
  if (!a.compared) return find_joint_delay(e);
  if (a.rows.half == 0 || a.fit.mass <= 0.0) return {};
  const Eigen::Index reach = std::min(kMostShift, e.log.rows() / 20);
  return delay_of(e, ForceShift(e).gains(reach), kAxisShift, held_shift(e.log), "fx", "the force");
}

}  // namespace

const FaultKind delay_fault{
    "delay", false, "log both on one clock; dcnn-diagnose finds the delay to a fraction of a row",
    "", find_delay};

}  // namespace dcnn::check
