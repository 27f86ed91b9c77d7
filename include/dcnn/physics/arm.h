// The rigid body of a serial arm, linear in its inertial parameters.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/core/error.h"
#include "dcnn/core/json.h"

namespace dcnn {

/// A serial arm of revolute joints by Denavit and Hartenberg.
struct Arm {
  struct Row {
    double a, alpha, d, theta0;  ///< m, rad, m, rad; theta = q + theta0
  };
  /// Modified (Craig): Rx(alpha)·Tx(a)·Rz(theta)·Tz(d); standard: Rz(theta)·Tz(d)·Tx(a)·Rx(alpha).
  bool modified = true;
  std::vector<Row> rows;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< m/s², in the arm's base
};

/// Keys: convention (modified|standard), dh [[a, alpha, d, theta0], …], gravity_mps2.
Arm parse_arm(const Json& json, const std::string& where, Exit exit);

/// Inertial parameters of one link, in this order, about the origin of its frame.
inline const std::vector<std::string> kLinkParameters{"m",   "mx",  "my",  "mz",  "ixx",
                                                      "ixy", "ixz", "iyy", "iyz", "izz"};

/// (T, 10·links): what each inertial parameter, link by link, adds to the drive torque of `joint`
/// (from 0). Positions, velocities and accelerations are (T, links), rad.
Eigen::MatrixXd arm_regressor(const Arm& arm, const Eigen::MatrixXd& q, const Eigen::MatrixXd& qd,
                              const Eigen::MatrixXd& qdd, std::size_t joint);

/// Columns that span the others to one part in `tolerance` of their length, each as much by itself as
/// possible (QR with pivots on columns of unit length): the base parameters of a motion.
std::vector<Eigen::Index> independent_columns(const Eigen::MatrixXd& columns, double tolerance);

}  // namespace dcnn
