// A serial arm as a chain of joints with any axes, and its rigid body linear in the inertial parameters.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/physics/arm.h"

namespace dcnn {

/// Inertial parameters of a body in a frame, in the order of kLinkParameters: m, h = m·c, and
/// ixx ixy ixz iyy iyz izz about the frame's origin.
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
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};                 ///< m/s², in the base
  Eigen::Matrix3d flange_R = Eigen::Matrix3d::Identity();   ///< of the flange in the last joint's frame
  Eigen::Vector3d flange_p = Eigen::Vector3d::Zero();
};

/// The chain of a DH table; its flange is the frame of the last row.
JointChain chain_of(const Arm& arm);

/// The chain from the root of a URDF to `tip` (none: the only leaf behind movable joints). Where the
/// library was built without urdfdom, and for every fault, Error(kData).
JointChain read_urdf_chain(const std::filesystem::path& path, const std::string& tip);

/// (T, 10·joints): what each inertial parameter, link by link, adds to the torque (force) of the
/// drive of `joint`, from 0. Recursive Newton and Euler; q, qd, qdd are (T, joints).
Eigen::MatrixXd chain_regressor(const JointChain& chain, const Eigen::MatrixXd& q,
                                const Eigen::MatrixXd& qd, const Eigen::MatrixXd& qdd,
                                std::size_t joint);

/// The body seen from a frame whose origin is at p and whose axes are R's columns: x = p + R x'.
BodyVector body_in_frame(const BodyVector& body, const Eigen::Matrix3d& R,
                         const Eigen::Vector3d& p);

}  // namespace dcnn
