#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

using Eigen::Index;

struct Power {
  std::string name, channel;
  double dissipation = 0.0;  ///< z-value of the power that friction takes
  double inertia = 0.0;      ///< z-value of the own inertia
};

/// Least squares of the torque on own acceleration, velocity, its sign, gravity and a constant.
Power power_of(const Log& log, const Joint& joint, const Sampled& rows, double dt) {
  const Eigen::VectorXd q = log.column(joint.position);
  const Eigen::VectorXd place = rows.smoothed(q, rows.value), v = rows.smoothed(q, rows.first) / dt,
                        a = rows.smoothed(q, rows.second) / (dt * dt),
                        y = joint.sense * rows.smoothed(log.column(joint.measured), rows.value);
  const Index n = v.size();
  const double slow = 0.05 * std::sqrt(v.squaredNorm() / static_cast<double>(n)) + 1e-12;
  Eigen::MatrixXd A(n, 6);
  A << a, v, elementary::tanh(v.array() / slow).matrix(), Eigen::VectorXd::Ones(n),
      elementary::sin(place.array()).matrix(), elementary::cos(place.array()).matrix();
  const Eigen::VectorXd size = A.colwise().norm().cwiseMax(1e-12).transpose();
  A = A * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd normal = A.transpose() * A + 1e-9 * Eigen::MatrixXd::Identity(6, 6);
  const Eigen::VectorXd x = normal.ldlt().solve(A.transpose() * y), r = y - A * x;
  const double rho =
      std::clamp(r.head(n - 1).dot(r.tail(n - 1)) / std::max(r.squaredNorm(), 1e-300), 0.0, 0.99);
  const Eigen::MatrixXd covariance =
      r.squaredNorm() / static_cast<double>(n - 6) * (1.0 + rho) / (1.0 - rho) * normal.inverse();
  Eigen::VectorXd friction =
      Eigen::VectorXd::Zero(6);  // mean of v times what the friction columns give
  friction[1] = v.squaredNorm() / size[1];
  friction[2] = (v.array() * elementary::tanh(v.array() / slow)).sum() / size[2];
  return {joint.name, joint.measured,
          friction.dot(x) / std::sqrt(friction.dot(covariance * friction)),
          x[0] / std::sqrt(covariance(0, 0))};
}

std::vector<Fault> find_power_sign(const Evidence& e) {
  const Sampled& rows = e.adopted.rows;
  std::vector<Fault> out;
  if (rows.half == 0 || rows.centres.size() < 40) return out;
  std::vector<Power> powers;
  for (const Joint& joint : e.log.joints) {
    if (joint.position.empty() || joint.measured.empty()) continue;
    if (robust_deviation(e.log.column(joint.position)) <= 0.0) continue;
    powers.push_back(power_of(e.log, joint, rows, e.log.step * e.adopted.reading.clock));
  }
  int right = 0;
  for (const Power& power : powers) right += power.dissipation > 4.0;
  for (const Power& power : powers) {
    if (power.dissipation >= 0.0 || power.inertia > 3.0) continue;
    // A drive's torque and its reaction are both logged; joints of one log that differ are not.
    Fault fault =
        fault_of(power_sign_fault, posterior_of_p(tail(power.dissipation)), power.channel,
                 power.channel +
                     ": the torque takes power out of the motion (friction would drive it, z = " +
                     brief(power.dissipation) + "): its sign is wrong" +
                     (right > 0 ? ", that of other joints is right"
                                : ", or it is the reaction of the load"));
    fault.stops = right > 0;
    if (fault.probability >= kLikely) out.push_back(fault);
  }
  return out;
}

}  // namespace

const FaultKind power_sign_fault{"power_sign", true,
                                 "turn the sign of the column, of its scale in the system's "
                                 "description, or of the joint's position",
                                 "", find_power_sign};

}  // namespace dcnn::check
