// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/rotation.h"

#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "data/rows.h"

namespace dcnn {

Eigen::Vector4d quaternion_from_euler(const Eigen::Vector3d& euler) {
  const double ca = elementary::cos(euler[0] / 2), sa = elementary::sin(euler[0] / 2);
  const double cb = elementary::cos(euler[1] / 2), sb = elementary::sin(euler[1] / 2);
  const double cg = elementary::cos(euler[2] / 2), sg = elementary::sin(euler[2] / 2);
  return {ca * cb * cg + sa * sb * sg, ca * cb * sg - sa * sb * cg, ca * sb * cg + sa * cb * sg,
          sa * cb * cg - ca * sb * sg};
}

Eigen::Matrix3d rotation_from_euler(const Eigen::Vector3d& euler) {
  return rotation_from_quaternion(quaternion_from_euler(euler));
}

Eigen::Vector3d euler_from_rotation(const Eigen::Matrix3d& R) {
  // Below this cos(beta), alpha and gamma cannot be told apart.
  constexpr double kGimbalLock = 1e-9;
  const double cosine = R.col(0).head<2>().norm();
  const double beta = elementary::atan2(-R(2, 0), cosine);
  if (cosine < kGimbalLock) return {elementary::atan2(-R(0, 1), R(1, 1)), beta, 0.0};
  return {elementary::atan2(R(1, 0), R(0, 0)), beta, elementary::atan2(R(2, 1), R(2, 2))};
}

Eigen::Matrix3d rotation_from_quaternion(const Eigen::Vector4d& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle) {
  const Eigen::Matrix3d S = cross_matrix(axis);
  // 1 - cos(angle) without cancellation.
  const double half = elementary::sin(0.5 * angle);
  return Eigen::Matrix3d::Identity() + elementary::sin(angle) * S + 2.0 * half * half * (S * S);
}

double nearest_turn(double angle, double near) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle - kTurn * std::round((angle - near) / kTurn);
}

void unwrap(Eigen::Ref<Eigen::MatrixXd> angles) {
  constexpr double kSurelyLess = 3.14;  // than half a turn: rounding would leave the angle alone
  // On one thread: a simulation calls this for a few rows in every cycle, and on a busy machine the
  // threads' barriers take far longer than the work.
  for (Index column = 0; column < angles.cols(); ++column) {
    for (Index i = 1; i < angles.rows(); ++i) {
      double& angle = angles(i, column);
      const double before = angles(i - 1, column);
      if (!(std::abs(angle - before) < kSurelyLess)) angle = nearest_turn(angle, before);
    }
  }
}

Eigen::MatrixXd quaternions(const Recording& recording) {
  Eigen::MatrixXd q;
  if (recording.has_all(kQuaternion)) {
    q = recording.block(kQuaternion);
    q.array().colwise() /= q.rowwise().norm().array().eval();
  } else {
    const Eigen::MatrixXd euler = recording.block(kEuler);
    q.resize(euler.rows(), 4);
    for_each_row(euler.rows(),
                 [&](Index i) { q.row(i) = quaternion_from_euler(euler.row(i).transpose()); });
  }
  for (Index i = 1; i < q.rows(); ++i) {
    if (q.row(i).dot(q.row(i - 1)) < 0.0) q.row(i) = -q.row(i);
  }
  return q;
}

Eigen::MatrixXd euler_angles(const Recording& recording) {
  Eigen::MatrixXd euler;
  if (recording.has_all(kQuaternion)) {
    const Eigen::MatrixXd q = quaternions(recording);
    euler.resize(q.rows(), 3);
    for_each_row(q.rows(), [&](Index i) {
      euler.row(i) = euler_from_rotation(rotation_from_quaternion(q.row(i).transpose()));
    });
  } else {
    euler = recording.block(kEuler);
  }
  unwrap(euler);
  return euler;
}

std::vector<Eigen::Matrix3d> rotations(const Recording& recording) {
  const Eigen::MatrixXd q = quaternions(recording);
  std::vector<Eigen::Matrix3d> R(static_cast<std::size_t>(q.rows()));
  for_each_row(q.rows(), [&](Index i) {
    R[static_cast<std::size_t>(i)] = rotation_from_quaternion(q.row(i).transpose());
  });
  return R;
}

Eigen::Matrix3d euler_rate_matrix(const Eigen::Vector3d& euler) {
  const double cb = elementary::cos(euler[1]), sb = elementary::sin(euler[1]);
  const double cg = elementary::cos(euler[2]), sg = elementary::sin(euler[2]);
  Eigen::Matrix3d W;
  W << -sb, 0.0, 1.0,    //
      cb * sg, cg, 0.0,  //
      cb * cg, -sg, 0.0;
  return W;
}

Eigen::Matrix3d euler_rate_matrix_derivative(const Eigen::Vector3d& euler,
                                             const Eigen::Vector3d& rates) {
  const double cb = elementary::cos(euler[1]), sb = elementary::sin(euler[1]);
  const double cg = elementary::cos(euler[2]), sg = elementary::sin(euler[2]);
  const double db = rates[1], dg = rates[2];
  Eigen::Matrix3d D;
  D << -cb * db, 0.0, 0.0,                          //
      -sb * sg * db + cb * cg * dg, -sg * dg, 0.0,  //
      -sb * cg * db - cb * sg * dg, -cg * dg, 0.0;
  return D;
}

}  // namespace dcnn
