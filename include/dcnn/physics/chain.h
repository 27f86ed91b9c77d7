// SPDX-License-Identifier: Apache-2.0
// A serial arm as a chain of joints with any axes, and its rigid body linear in the inertial
// parameters.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/error.h"
#include "dcnn/core/json.h"

namespace dcnn {

/// Inertial parameters of a body, in this order, about the origin of its frame.
inline const std::vector<std::string> kLinkParameters{"m",   "mx",  "my",  "mz",  "ixx",
                                                      "ixy", "ixz", "iyy", "iyz", "izz"};
/// Their values: m, h = m·c, and the inertia about the frame's origin.
using BodyVector = Eigen::Matrix<double, 10, 1>;

/// A joint and the link that it carries; the link's frame is the joint's.
struct ChainJoint {
  std::string name;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< at q = 0, in the frame of the joint before
  Eigen::Vector3d p = Eigen::Vector3d::Zero();      ///< origin in that frame, m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of unit length, in its own frame
  bool slides = false;
  std::optional<BodyVector> body = std::nullopt;  ///< as described; links fixed to it are lumped in
};

struct JointChain {
  std::vector<ChainJoint> joints;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< m/s², in the base
  Eigen::Matrix3d flange_R =
      Eigen::Matrix3d::Identity();  ///< of the flange in the last joint's frame
  Eigen::Vector3d flange_p = Eigen::Vector3d::Zero();

  /// (10·joints): those of all links; nothing unless every link's body is given.
  std::optional<Eigen::VectorXd> bodies() const;
};

/// `arm` of a system description: either a table of Denavit and Hartenberg (keys convention, dh
/// [[a, alpha, d, theta0], …]), or `joints` with their bodies and a `flange`; gravity_mps2. The
/// convention modified (Craig) is Rx(alpha)·Tx(a)·Rz(theta)·Tz(d), standard
/// Rz(theta)·Tz(d)·Tx(a)·Rx(alpha), theta = q + theta0; a link's frame has its z on the joint's
/// axis in both, and the flange is the last row's frame.
JointChain parse_chain(const Json& json, const std::string& where, Exit exit);
/// The gravity that a description of an arm (`arm` of a System, or null) gives for a chain that was
/// read elsewhere, as from a URDF: how its base is mounted. Its own where that gives none.
void set_gravity(const Json& arm, const std::string& where, Exit exit, JointChain& chain);
/// In the form with `joints`.
Json to_json(const JointChain& chain);

/// Keys mass_kg, moment_kgm (m·c), inertia_kgm2 (ixx ixy ixz iyy iyz izz about the frame's origin).
BodyVector parse_body(const Json& json, const std::string& where, Exit exit);
Json body_json(const BodyVector& body);

/// (T, 10·joints): what each inertial parameter, link by link, adds to the torque (force) of the
/// drive of `joint`, from 0. Recursive Newton and Euler; q, qd, qdd are (T, joints).
Eigen::MatrixXd chain_regressor(const JointChain& chain, const Eigen::MatrixXd& q,
                                const Eigen::MatrixXd& qd, const Eigen::MatrixXd& qdd,
                                std::size_t joint);

/// The body seen from a frame whose origin is at p and whose axes are R's columns: x = p + R x'.
BodyVector body_in_frame(const BodyVector& body, const Eigen::Matrix3d& R,
                         const Eigen::Vector3d& p);
/// (10, 10): parameters of a body in the flange's frame to those in the last link's.
Eigen::MatrixXd flange_to_link(const JointChain& chain);

/// Columns that leave of the others less than `tolerance` of their length, each as much by itself
/// as possible (QR with pivots on columns of unit length): the base parameters of a motion.
std::vector<Eigen::Index> independent_columns(const Eigen::MatrixXd& columns, double tolerance);

}  // namespace dcnn
