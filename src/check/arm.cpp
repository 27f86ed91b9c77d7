// SPDX-License-Identifier: Apache-2.0
#include "check/arm.h"

#include <algorithm>
#include <cmath>

#include "check/statistics.h"
#include "core/elementary.h"
#include "physics/foreign_force.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kMostRows = 300;  // more tell readings apart no better
constexpr Index kFewestArmRows = 20;
constexpr int kReweightings = 6;   // of joints by their residuals
constexpr double kHeld = 1e12;     // precision that holds a coefficient at zero
constexpr double kTurnsAt = 0.05;  // of the rms speed, over which dry friction turns
constexpr double kTold = 10.0;     // deviations of a factor that the motion tells, rows alike
constexpr Index kTerms = 4;        // of a drive: offset, dry, viscous, rotor inertia

struct ArmMotion {
  MatrixXd q, qd, qdd;  // (n, joints) in the chain's angles
};

/// Every k-th of the sampled rows.
Sampled thinned(const Sampled& rows) {
  Sampled out = rows;
  out.centres.clear();
  const auto n = static_cast<Index>(rows.centres.size());
  const Index stride = std::max<Index>(1, (n + kMostRows - 1) / kMostRows);
  for (Index i = 0; i < n; i += stride) {
    out.centres.push_back(rows.centres[static_cast<std::size_t>(i)]);
  }
  return out;
}

ArmMotion motion_of(const Log& log, const Sampled& rows, const Reading& reading) {
  const auto n = static_cast<Index>(rows.centres.size()), joints = reading.arm.sign.size();
  ArmMotion motion{MatrixXd(n, joints), MatrixXd::Zero(n, joints), MatrixXd::Zero(n, joints)};
  const double dt = log.step * reading.clock;
  for (Index j = 0; j < joints; ++j) {
    const Joint& joint = log.joints[reading.arm.joint[static_cast<std::size_t>(j)]];
    const double unit = reading.arm.sign[j] * (joint.turns ? reading.angle : 1.0);
    const VectorXd q = unit * log.column(joint.position);
    motion.q.col(j) = rows.smoothed(q, rows.value).array() + reading.arm.zero[j];
    if (rows.half == 0 || dt <= 0.0) continue;
    motion.qd.col(j) = rows.smoothed(q, rows.first) / dt;
    motion.qdd.col(j) = rows.smoothed(q, rows.second) / (dt * dt);
  }
  return motion;
}

/// N·m of the description for one unit of the log.
double unit_of(const Log& log, const Reading& reading, Index joint) {
  return reading.arm.torque[joint] *
         log.joints[reading.arm.joint[static_cast<std::size_t>(joint)]].scale;
}

MatrixXd torques_of(const Log& log, const Sampled& rows, const Reading& reading) {
  MatrixXd torque(static_cast<Index>(rows.centres.size()), reading.arm.sign.size());
  for (Index j = 0; j < torque.cols(); ++j) {
    const Joint& joint = log.joints[reading.arm.joint[static_cast<std::size_t>(j)]];
    torque.col(j) =
        unit_of(log, reading, j) * rows.smoothed(log.column(joint.measured), rows.value);
  }
  return torque;
}

JointChain chain_of(const Log& log, const Reading& reading) {
  JointChain chain = *log.declared.arm;
  chain.gravity = reading.compensated ? Eigen::Vector3d(0.0, 0.0, 0.0)
                                      : Eigen::Vector3d(reading.arm.gravity * chain.gravity);
  return chain;
}

/// Offset, dry and viscous friction and rotor inertia, (n,4), of unit rms: torques.
MatrixXd drive_columns(const ArmMotion& motion, Index joint) {
  const VectorXd v = motion.qd.col(joint), a = motion.qdd.col(joint);
  const double n = static_cast<double>(std::max<Index>(1, v.size()));
  const double fast = std::sqrt(v.squaredNorm() / n), hard = std::sqrt(a.squaredNorm() / n);
  MatrixXd columns(v.size(), kTerms);
  columns.col(0).setOnes();
  columns.col(1) = elementary::tanh((v / (kTurnsAt * fast + 1e-12)).array());
  columns.col(2) = v / (fast + 1e-12);
  columns.col(3) = a / (hard + 1e-12);
  return columns;
}

/// Mean and deviation of links, payload and drives under the description.
struct ArmPrior {
  VectorXd mean, deviation;
};

void describe_body(const BodyVector& body, ArmPrior& prior, Index at) {
  // Bodies that were identified are one of many sets with the same torques, masses below zero too.
  const double mass = std::abs(body[0]),
               size = 0.5 * std::abs(body[4] + body[7] + body[9]);  // m r²
  const double moment = std::max(body.segment<3>(1).norm(), std::sqrt(mass * size));
  prior.mean.segment<10>(at) = body;
  prior.deviation[at] = kLinkError * mass;
  prior.deviation.segment<3>(at + 1).setConstant(kLinkError * moment);
  prior.deviation.segment<6>(at + 4).setConstant(kLinkError * size);
}

/// Deviations of drive terms are the joint's rms torque.
ArmPrior prior_of(const JointChain& chain, const VectorXd& torque_rms) {
  const auto joints = static_cast<Index>(chain.joints.size());
  const Index links = 10 * joints;
  ArmPrior prior{VectorXd::Zero(links + 10 + kTerms * joints),
                 VectorXd::Zero(links + 10 + kTerms * joints)};
  double mass = 0.0;
  for (Index j = 0; j < joints; ++j) {
    const BodyVector& body = *chain.joints[static_cast<std::size_t>(j)].body;
    mass += std::abs(body[0]);
    describe_body(body, prior, 10 * j);
    prior.deviation.segment(links + 10 + kTerms * j, kTerms).setConstant(torque_rms[j]);
  }
  const double payload = kPayloadShare * mass;
  prior.deviation[links] = payload;
  prior.deviation.segment<3>(links + 1).setConstant(payload * kLever.median);
  prior.deviation.segment<6>(links + 4).setConstant(payload * kLever.median * kLever.median);
  return prior;
}

/// Per joint: the columns' products, in units of the prior's deviations.
struct NormalJoint {
  MatrixXd columns, normal;
  VectorXd rest, right;  ///< of the torque, less what the prior's mean predicts
};

std::vector<NormalJoint> normal_joints(const JointChain& chain, const ArmMotion& motion,
                                       const MatrixXd& torque, const ArmPrior& prior) {
  const auto joints = static_cast<Index>(chain.joints.size());
  const Index links = 10 * joints;
  const MatrixXd to_link = flange_to_link(chain);
  std::vector<NormalJoint> all;
  for (Index j = 0; j < joints; ++j) {
    NormalJoint one;
    one.columns = MatrixXd::Zero(torque.rows(), prior.mean.size());
    one.columns.leftCols(links) =
        chain_regressor(chain, motion.q, motion.qd, motion.qdd, static_cast<std::size_t>(j));
    one.columns.middleCols(links, 10) = one.columns.middleCols(links - 10, 10) * to_link;
    one.columns.middleCols(links + 10 + kTerms * j, kTerms) = drive_columns(motion, j);
    one.rest = torque.col(j) - one.columns * prior.mean;
    one.columns *= prior.deviation.asDiagonal();
    one.normal = one.columns.transpose() * one.columns;
    one.right = one.columns.transpose() * one.rest;
    all.push_back(std::move(one));
  }
  return all;
}

/// The posterior's precision, in units of the prior's deviations.
MatrixXd precision(const std::vector<NormalJoint>& joints, const VectorXd& weight) {
  const Index unknowns = joints[0].right.size();
  MatrixXd normal = MatrixXd::Identity(unknowns, unknowns);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    normal += weight[static_cast<Index>(j)] * joints[j].normal;
  }
  return normal;
}

/// Deviations from the prior's mean in its units; dry friction and rotor inertia below zero are
/// held at zero.
VectorXd solve(const std::vector<NormalJoint>& joints, const VectorXd& weight) {
  const Index links = 10 * static_cast<Index>(joints.size()) + 10;
  MatrixXd normal = precision(joints, weight);
  VectorXd right = VectorXd::Zero(normal.rows());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    right += weight[static_cast<Index>(j)] * joints[j].right;
  }
  VectorXd x = normal.ldlt().solve(right);
  bool below = false;
  for (Index j = 0; j < weight.size(); ++j) {
    for (const Index term : {links + kTerms * j + 1, links + kTerms * j + 3}) {
      if (x[term] < 0.0) normal(term, term) += kHeld * (1.0 + normal(term, term)), below = true;
    }
  }
  return below ? VectorXd(normal.ldlt().solve(right)) : x;
}

/// (joints), N·m below which a residual tells readings apart no more: descriptions are no better.
/// Of all of a torque, its mean too: where a joint hardly moves its torque varies by its friction.
VectorXd floors_of(const MatrixXd& torque, const std::vector<NormalJoint>& joints) {
  VectorXd floors(torque.cols());
  for (Index j = 0; j < torque.cols(); ++j) {
    const VectorXd described = torque.col(j) - joints[static_cast<std::size_t>(j)].rest;
    floors[j] = kArmError * std::max(rms_of(torque.col(j)), rms_of(described)) + 1e-150;
  }
  return floors;
}

}  // namespace

bool can_fit_arm(const Log& log, const Sampled& rows) {
  return !log.arm.empty() && static_cast<Index>(rows.centres.size()) >= kFewestArmRows;
}

ArmFit fit_arm(const Log& log, const Sampled& all, const Reading& reading) {
  const Sampled rows = thinned(all);
  const JointChain chain = chain_of(log, reading);
  ArmFit fit;
  fit.rows = rows.centres;
  fit.torque = torques_of(log, rows, reading);
  const Index n = fit.torque.rows(), joints = fit.torque.cols();
  const VectorXd rms = (fit.torque.colwise().squaredNorm() / static_cast<double>(n)).cwiseSqrt();
  const ArmPrior prior = prior_of(chain, rms);
  const auto normal = normal_joints(chain, motion_of(log, rows, reading), fit.torque, prior);
  fit.variance = rms.cwiseAbs2();
  fit.floor = floors_of(fit.torque, normal);
  fit.independent = independent_residuals(log, rows);
  VectorXd x, weight;
  for (int k = 0; k < kReweightings; ++k) {
    weight = fit.independent / static_cast<double>(n) *
             (fit.variance + fit.floor.cwiseAbs2()).cwiseInverse();
    x = solve(normal, weight);
    fit.residual.resize(n, joints);
    for (Index j = 0; j < joints; ++j) {
      const NormalJoint& one = normal[static_cast<std::size_t>(j)];
      fit.residual.col(j) = one.rest - one.columns * x;
      fit.variance[j] = median(fit.residual.col(j).cwiseAbs2()) / chi_square_median(1);
    }
  }
  fit.precision = precision(normal, weight);
  fit.surprise = 0.5 * x.head(10 * joints + 10).squaredNorm();
  return fit;
}

ArmWeight arm_weight(const Log& log, const Sampled& rows, const Reading& reading) {
  const ArmFit fit = fit_arm(log, rows, reading);
  ArmWeight weight{-fit.surprise, VectorXd::Zero(static_cast<Index>(log.joints.size()))};
  for (Index j = 0; j < fit.residual.cols(); ++j) {
    const auto column = static_cast<Index>(reading.arm.joint[static_cast<std::size_t>(j)]);
    // In the units of the log: a density of what was logged.
    const double unit = std::abs(unit_of(log, reading, j));
    const double independent =
        rows.independent_torques.size() > 0 ? rows.independent_torques[column] : fit.independent;
    weight.of_torque[column] =
        -0.5 * independent * log_variance(fit.residual.col(j) / unit, fit.floor[j] / unit);
  }
  return weight;
}

std::optional<VectorXd> torque_factors(const Log& log, const Reading& reading) {
  const Sampled rows = thinned(sample(log));
  if (!can_fit_arm(log, rows)) return std::nullopt;
  const JointChain chain = chain_of(log, reading);
  const ArmMotion motion = motion_of(log, rows, reading);
  const MatrixXd torque = torques_of(log, rows, reading);
  const VectorXd links = *chain.bodies();
  VectorXd factors = VectorXd::Zero(torque.cols());
  std::vector<double> told;
  for (Index j = 0; j < torque.cols(); ++j) {
    MatrixXd A(torque.rows(), 1 + kTerms);
    A << chain_regressor(chain, motion.q, motion.qd, motion.qdd, static_cast<std::size_t>(j)) *
             links,
        drive_columns(motion, j);
    const VectorXd x = A.colPivHouseholderQr().solve(torque.col(j));
    const double freedom = static_cast<double>(std::max<Index>(1, A.rows() - A.cols()));
    const double variance = (torque.col(j) - A * x).squaredNorm() / freedom;
    const MatrixXd inverse =
        (A.transpose() * A).ldlt().solve(MatrixXd::Identity(A.cols(), A.cols()));
    if (!(x[0] > kTold * std::sqrt(std::max(0.0, variance * inverse(0, 0))))) continue;
    factors[j] = 1.0 / x[0];
    told.push_back(factors[j]);
  }
  if (told.empty()) return std::nullopt;
  const double typical =
      median(Eigen::Map<const VectorXd>(told.data(), static_cast<Index>(told.size())));
  for (double& factor : factors) {
    if (factor == 0.0) factor = typical;
  }
  return factors;
}

MatrixXd drive_deviation(const ArmFit& fit) {
  const Index unknowns = fit.precision.rows(), joints = fit.torque.cols();
  const MatrixXd inverse = fit.precision.ldlt().solve(MatrixXd::Identity(unknowns, unknowns));
  const VectorXd deviations = inverse.diagonal().tail(kTerms * joints).cwiseSqrt();
  return deviations.reshaped<Eigen::RowMajor>(joints, kTerms);
}

double unexplained_share(const ArmFit& fit) {
  const MatrixXd centred = fit.torque.rowwise() - fit.torque.colwise().mean();
  return foreign_share(fit.residual.squaredNorm(), 0.0, centred.squaredNorm());
}

}  // namespace dcnn::check
