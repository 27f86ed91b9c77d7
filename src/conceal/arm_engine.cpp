// SPDX-License-Identifier: Apache-2.0
#include "conceal/arm_engine.h"

#include <cmath>

#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Where joints and masses are at one time.
struct Posture {
  std::vector<Vector3d> pivot, axis;  // of the joints
  Eigen::Matrix3Xd masses;
};

Posture posture_of(const std::vector<Limb>& arm, const Eigen::RowVectorXd& q, Index masses) {
  Posture at;
  at.masses.resize(3, masses);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vector3d p = Vector3d::Zero();
  Index place = 0;
  for (std::size_t k = 0; k < arm.size(); ++k) {
    p += R * arm[k].origin;
    const Eigen::Matrix3d before = R * arm[k].turned;
    const double c = elementary::cos(q(static_cast<Index>(k))),
                 s = elementary::sin(q(static_cast<Index>(k)));
    R.col(0) = c * before.col(0) + s * before.col(1);
    R.col(1) = c * before.col(1) - s * before.col(0);
    R.col(2) = before.col(2);
    at.pivot.push_back(p);
    at.axis.emplace_back(R.col(2));
    for (const PointMass& m : arm[k].masses) at.masses.col(place++) = p + R * m.at;
  }
  return at;
}

}  // namespace

std::vector<PointMass> solid(double mass, const Vector3d& centre, const Vector3d& radii,
                             const Eigen::Matrix3d& axes) {
  // A pair at ±a of m/6 each adds m a²/3 along its axis.
  std::vector<PointMass> masses;
  for (Index k = 0; k < 3; ++k) {
    const Vector3d arm = std::sqrt(3.0) * radii(k) * axes.col(k);
    masses.push_back({mass / 6.0, centre + arm});
    masses.push_back({mass / 6.0, centre - arm});
  }
  return masses;
}

Eigen::MatrixXd drive_torques(const std::vector<Limb>& arm, const Eigen::MatrixXd& q, double step,
                              const Vector3d& gravity) {
  std::vector<double> mass;
  std::vector<std::size_t> limb;
  for (std::size_t k = 0; k < arm.size(); ++k) {
    for (const PointMass& m : arm[k].masses) {
      mass.push_back(m.mass);
      limb.push_back(k);
    }
  }
  const auto count = static_cast<Index>(mass.size());
  Eigen::MatrixXd torque = Eigen::MatrixXd::Zero(q.rows(), q.cols());
  Posture before = posture_of(arm, q.row(0), count), now = posture_of(arm, q.row(1), count);
  for (Index i = 1; i + 1 < q.rows(); ++i) {
    const Posture next = posture_of(arm, q.row(i + 1), count);
    for (std::size_t m = 0; m < mass.size(); ++m) {
      const auto col = static_cast<Index>(m);
      const Vector3d x = now.masses.col(col);
      const Vector3d acceleration =
          (next.masses.col(col) - 2.0 * x + before.masses.col(col)) / (step * step);
      const Vector3d inertia_force = mass[m] * (acceleration - gravity);
      for (std::size_t k = 0; k <= limb[m]; ++k) {
        torque(i, static_cast<Index>(k)) += now.axis[k].cross(x - now.pivot[k]).dot(inertia_force);
      }
    }
    before = now;
    now = next;
  }
  torque.row(0) = torque.row(1);
  torque.row(q.rows() - 1) = torque.row(q.rows() - 2);
  return torque;
}

}  // namespace dcnn::conceal
