#include <algorithm>
#include <cmath>

#include "check/joints.h"
#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr Eigen::Index kMostShift = 40;
constexpr double kOwnShift = 0.5;
constexpr std::size_t kFewestForDelay = 100;  // rows, of a fit of a joint's torque
/// Speeds [m/s] over which dry friction changes its sign: about what the window makes of any, and a
/// sharp one.
constexpr double kFrictionSpeeds[] = {0.02, 0.005};

/// Shares of a joint's rms speed, the same.
constexpr double kJointFrictionShares[] = {0.05, 0.01};

std::vector<Fault> delay_fault_of(const Evidence& e, double odds, Eigen::Index shift,
                                  const std::string& channel, const std::string& what) {
  const double seconds =
      e.log.step * e.adopted.reading.clock * static_cast<double>(std::abs(shift));
  Fault fault = fault_of(delay_fault, odds / (1.0 + odds), channel,
                         what + (shift > 0 ? " lags" : " leads") + " the logged motion by " +
                             brief(1e3 * seconds) + " ms");
  if (fault.probability < 0.01) return {};
  return {fault};
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

/// One delay for the torques of all joints. What a joint's model leaves may look like a shift of
/// its own, with the probability kOwnShift; no such shift is another joint's.
std::vector<Fault> find_joint_delay(const Evidence& e) {
  const Sampled& rows = e.adopted.rows;
  if (rows.half == 0 || rows.centres.size() < kFewestForDelay) return {};
  const auto joints = driven_joints(e.log);
  std::vector<JointMotion> motions;
  for (const Joint* joint : joints) {
    motions.push_back(joint_motion(e.log, rows, e.adopted.reading, *joint));
  }
  const Eigen::Index reach = std::min(kMostShift, e.log.rows() / 20);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(2 * reach + 1);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Eigen::VectorXd gain = gains_of(JointShift(e, joints, motions, k), reach);
    const double most = gain.maxCoeff();
    const Eigen::VectorXd likelihood = elementary::exp(gain.array() - most);
    const double own = kOwnShift * likelihood.mean();
    weight.array() += elementary::log(own + (1.0 - kOwnShift) * likelihood.array());
  }
  weight.array() -= double(weight[reach]);
  weight[reach] = -INFINITY;
  Eigen::Index best = 0;
  const double most = weight.maxCoeff(&best);
  const double sum = elementary::exp(weight.array() - most).sum();
  const double odds =
      kFaultPrior / static_cast<double>(2 * reach) * sum * elementary::exp(std::min(most, 600.0));
  return delay_fault_of(e, odds, best - reach, joints.empty() ? "" : joints[0]->measured,
                        "the joints' torque");
}

/// Gain of log-likelihood by shifting the force, for shifts -K … K; penalised by their number.
std::vector<Fault> find_delay(const Evidence& e) {
  const Adopted& a = e.adopted;
  if (!a.compared) return find_joint_delay(e);
  if (a.rows.half == 0 || a.fit.mass <= 0.0) return {};
  const Eigen::Index reach = std::min(kMostShift, e.log.rows() / 20);
  const double spread =
      std::sqrt((a.fit.force.rowwise() - a.fit.force.colwise().mean()).squaredNorm() /
                static_cast<double>(3 * a.fit.force.rows()));
  std::vector<Eigen::MatrixXd> frictions;
  for (const double speed : kFrictionSpeeds) {
    if (!a.motion.has_position) break;
    frictions.push_back(smoothed_friction(e.log, a.rows, a.reading, speed));
  }
  if (frictions.empty()) frictions.emplace_back();
  const auto residual = [&](Eigen::Index shift, const Eigen::MatrixXd& friction) {
    const FitOptions options{shift, true, friction.size() > 0 ? &friction : nullptr};
    return fit_rigid(e.log, a.rows, a.motion, a.reading, options).residual;
  };
  const double floor = kToolError * spread;
  const auto cost = [&](Eigen::Index shift, const Eigen::MatrixXd& friction) {
    return 0.5 * log_variance(residual(shift, friction), floor);
  };
  // Each hypothesis with the friction that suits it best.
  const auto least_cost = [&](Eigen::Index shift) {
    double least = cost(shift, frictions[0]);
    for (std::size_t k = 1; k < frictions.size(); ++k) {
      least = std::min(least, cost(shift, frictions[k]));
    }
    return least;
  };
  Eigen::Index best = 0;
  double least = cost(0, frictions[0]);
  for (Eigen::Index shift = -reach; shift <= reach; ++shift) {
    const double here = cost(shift, frictions[0]);
    if (here < least) least = here, best = shift;
  }
  if (best == 0) return {};
  // A delay leaves a residual that is alike for long; how many are independent the better one
  // tells.
  const double independent = independent_of(residual(best, frictions[0]));
  const double gain = independent * (least_cost(0) - least_cost(best));
  const double odds =
      kFaultPrior / static_cast<double>(2 * reach) * elementary::exp(std::min(gain, 600.0));
  return delay_fault_of(e, odds, best, "fx", "the force");
}

}  // namespace

const FaultKind delay_fault{
    "delay", false, "log both on one clock; dcnn-diagnose finds the delay to a fraction of a row",
    "", find_delay};

}  // namespace dcnn::check
