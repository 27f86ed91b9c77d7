// SPDX-License-Identifier: Apache-2.0
#include "check/joints.h"

#include <algorithm>
#include <cmath>

#include "check/statistics.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kOfAnother = 6;     // columns
constexpr double kDryTurns = 0.05;  // of the rms speed, over which smoothed dry friction turns

void append_gravity(MatrixXd& A, const VectorXd& angle) {
  append(A, elementary::sin(angle.array()).matrix());
  append(A, elementary::cos(angle.array()).matrix());
}

/// The shaft of a motor or a wheel: in degrees, too, it turns farther than the cables of an arm's
/// joint allow, or farther than once without turning back. Its size tells no unit.
bool turns_endlessly(const VectorXd& angle) {
  const double range = angle.maxCoeff() - angle.minCoeff();
  const double path =
      (angle.tail(angle.size() - 1) - angle.head(angle.size() - 1)).cwiseAbs().sum();
  constexpr double kTurnDegrees = 360.0, kMostTurns = 4.0;  // of a joint, end to end
  constexpr double kNoise = 1.05;  // path over range where nothing turns back
  return range > kMostTurns * kTurnDegrees || (range > kTurnDegrees && path < kNoise * range);
}

/// Log likelihood of a joint's torque.
double torque_weight(const Log& log, const Sampled& rows, const Joint& joint,
                     const std::vector<JointMotion>& motions, std::size_t own, Place place) {
  const VectorXd y = rows.smoothed(log.column(joint.measured), rows.value);
  const MatrixXd A = torque_columns(motions, own, place);
  MatrixXd normal = A.transpose() * A;
  normal.diagonal().array() += 1e-9;
  const VectorXd residual = y - A * normal.ldlt().solve(A.transpose() * y);
  const double centred = rms_of(y.array() - y.mean()), n = static_cast<double>(y.size());
  const double freedom = std::max(1.0, n - static_cast<double>(A.cols()));
  const double floor = kToolError * centred;
  return -0.5 * std::min(kMostIndependent, 0.75 * freedom) *
         elementary::log(std::max(residual.squaredNorm() / freedom + floor * floor, 1e-300));
}

}  // namespace

void append(MatrixXd& A, const VectorXd& column) {
  A.conservativeResize(column.size(), A.cols() + 1);
  A.col(A.cols() - 1) = column / std::max(column.norm(), 1e-12);
}

std::vector<const Joint*> driven_joints(const Log& log) {
  std::vector<const Joint*> joints;
  for (const Joint& joint : log.joints) {
    if (joint.position.empty() || joint.measured.empty()) continue;
    if (robust_deviation(log.column(joint.position)) > 0.0) joints.push_back(&joint);
  }
  return joints;
}

JointMotion joint_motion(const Log& log, const Sampled& rows, const Reading& reading,
                         const Joint& joint) {
  const double dt = log.step * reading.clock;
  const VectorXd q = (joint.turns ? reading.angle : 1.0) * log.column(joint.position);
  JointMotion motion{rows.smoothed(q, rows.value),
                     rows.smoothed(q, rows.first) / dt,
                     rows.smoothed(q, rows.second) / (dt * dt),
                     {}};
  const double slow = kDryTurns * rms_of(motion.v) + 1e-12;
  motion.dry = elementary::tanh(motion.v.array() / slow).matrix();
  return motion;
}

VectorXd smoothed_dry(const Log& log, const Sampled& rows, const Joint& joint, double share) {
  Sampled every = rows;  // each row whose window lies within its segment
  every.centres.clear();
  for (const Segment& segment : log.segments) {
    for (Index i = segment.begin + rows.half; i + rows.half < segment.end; ++i) {
      every.centres.push_back(i);
    }
  }
  const VectorXd v = every.smoothed(log.column(joint.position), rows.first);
  const double slow = share * rms_of(v) + 1e-300;
  VectorXd dry = VectorXd::Zero(log.rows());
  for (std::size_t k = 0; k < every.centres.size(); ++k) {
    dry[every.centres[k]] = elementary::tanh(v[static_cast<Index>(k)] / slow);
  }
  return rows.smoothed(dry, rows.value);
}

MatrixXd torque_columns(const std::vector<JointMotion>& motions, std::size_t own, Place place) {
  const JointMotion& motion = motions[own];
  const Index n = motion.v.size();
  MatrixXd A(n, 0);
  append(A, motion.a);
  append(A, motion.dry);
  append(A, motion.v);
  append(A, VectorXd::Ones(n));
  if (place == Place::kGravity) append_gravity(A, motion.place);
  const VectorXd about = motion.place.array() - motion.place.mean();
  if (place != Place::kGravity) append(A, about);
  if (place == Place::kSlow) append(A, about.cwiseAbs2()), append(A, about.array().cube().matrix());
  for (std::size_t away = 1; away < motions.size(); ++away) {
    for (const std::size_t k : {own + away, own - away}) {  // wraps where there is none
      if (k >= motions.size() || 10 * (A.cols() + kOfAnother) > n) continue;
      append(A, motions[k].a);
      append(A, motions[k].v);
      append(A, motions[k].v.cwiseAbs2());
      append(A, motions[k].v.cwiseProduct(motion.v));
      if (place == Place::kGravity) append_gravity(A, motions[k].place);
      if (place != Place::kGravity) append(A, motions[k].place);
    }
  }
  return A;
}

double angles_weight(const Log& log, const Sampled& rows, const Reading& reading) {
  double limb = elementary::log(1.0 - kDrives), drive = elementary::log(kDrives);
  for (const Joint& joint : log.joints) {
    if (!joint.turns || joint.position.empty()) continue;
    const VectorXd q = log.column(joint.position);
    if (!varies(q) || turns_endlessly(q)) continue;
    const double size = rms_of(q.array() - q.mean());
    limb += plausibility(reading.angle * size, kTurn);
    drive += plausibility(reading.angle * size, kDriveTurn) +
             elementary::log(kTurn.above / kDriveTurn.above);
  }
  if (rows.half == 0 || rows.centres.size() < 40) return log_sum(Eigen::Vector2d(limb, drive));
  const auto joints = driven_joints(log);
  std::vector<JointMotion> motions;
  for (const Joint* joint : joints) motions.push_back(joint_motion(log, rows, reading, *joint));
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (!joints[k]->turns) continue;
    const auto weight = [&](Place place) {
      return torque_weight(log, rows, *joints[k], motions, k, place);
    };
    const double linear = weight(Place::kLinear);
    const double slow = std::max(linear, weight(Place::kSlow) + elementary::log(kSlowTorque));
    limb += std::max(weight(Place::kGravity), slow);
    drive += slow;
  }
  return log_sum(Eigen::Vector2d(limb, drive));
}

}  // namespace dcnn::check
