// SPDX-License-Identifier: Apache-2.0
// Orientation: R_BE = Rz(alpha)·Ry(beta)·Rx(gamma) maps E to B.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// (alpha, beta, gamma), rad.
Eigen::Matrix3d rotation_from_euler(const Eigen::Vector3d& euler);
/// The same turn as a unit quaternion (w,x,y,z).
Eigen::Vector4d quaternion_from_euler(const Eigen::Vector3d& euler);
/// beta in [-pi/2, pi/2], alpha and gamma in (-pi, pi]; at the singularity alpha carries the turn.
Eigen::Vector3d euler_from_rotation(const Eigen::Matrix3d& R);

/// Of a unit quaternion (w,x,y,z).
Eigen::Matrix3d rotation_from_quaternion(const Eigen::Vector4d& q);

/// v x w = cross_matrix(v) w.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);
/// A turn by `angle` [rad] about an axis of unit length (Rodrigues).
Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle);

/// The angle plus that multiple of 2 pi which brings it nearest to `near`, rad.
double nearest_turn(double angle, double near);
/// Adds multiples of 2 pi to each column so that |step| < pi.
void unwrap(Eigen::Ref<Eigen::MatrixXd> angles);

/// Orientations of a recording as unit quaternions (w,x,y,z), (T,4), q and -q chosen so that
/// neighbours are near (continuous within a segment). Quaternion columns win over Euler angles.
Eigen::MatrixXd quaternions(const Recording& recording);

/// Euler angles of a recording, (T,3) alpha,beta,gamma, unwrapped. Quaternion columns win.
Eigen::MatrixXd euler_angles(const Recording& recording);

/// R_BE of each sample.
std::vector<Eigen::Matrix3d> rotations(const Recording& recording);

/// omega_E from Euler angles and their rates: omega = W(euler)·rates, both (3), frame E.
Eigen::Matrix3d euler_rate_matrix(const Eigen::Vector3d& euler);
/// dW/dt, so that alpha_E = W·accelerations + dW/dt·rates.
Eigen::Matrix3d euler_rate_matrix_derivative(const Eigen::Vector3d& euler,
                                             const Eigen::Vector3d& rates);

}  // namespace dcnn
