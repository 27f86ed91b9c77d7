// SPDX-License-Identifier: Apache-2.0
// Torques of a serial arm by d'Alembert's principle on point masses: no inertia tensors, no
// recursion.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace dcnn::conceal {

/// Mass and place in the frame of the link that carries it.
struct PointMass {
  double mass = 0.0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
};

/// Six point masses with this mass, centre, and radii of gyration along the columns of `axes`.
std::vector<PointMass> solid(double mass, const Eigen::Vector3d& centre,
                             const Eigen::Vector3d& radii, const Eigen::Matrix3d& axes);

/// A joint that turns about z of its frame, and the link that it carries.
struct Limb {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< in the frame of the limb before
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();  ///< at angle 0
  std::vector<PointMass> masses;
};

/// (T, limbs): torque of each drive, where rows of `q` are `step` apart: sum over the masses of m
/// (dx/dq)·(d²x/dt² - g), accelerations by differences of the positions. The first and the last row
/// repeat their neighbours.
Eigen::MatrixXd drive_torques(const std::vector<Limb>& arm, const Eigen::MatrixXd& q, double step,
                              const Eigen::Vector3d& gravity);

}  // namespace dcnn::conceal
