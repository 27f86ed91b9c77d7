// SPDX-License-Identifier: Apache-2.0
// Rigid-body frames of one instant, with what their gradients need.
#pragma once

#include <Eigen/Dense>

namespace dcnn::frame_tcn {

/// Channels of one instant in SI units: theta = (alpha, beta, gamma), v, theta', a, theta''.
using Instant = Eigen::Matrix<double, 15, 1>;

/// R_BS^T, angular velocity and acceleration in S, and the velocity turned into S.
/// omega = W(theta)·theta', alpha = W·theta'' + dW/dt·theta', dR^T u/dtheta_i = (R^T u) x w_i with
/// w_i the columns of W.
class Frame {
 public:
  /// `mounting` is R_ES.
  Frame(const Instant& x, const Eigen::Matrix3d& mounting);

  Eigen::Matrix3d to_sensor;  ///< R_BS^T
  Eigen::Vector3d omega, alpha, velocity;

  /// Adds to `gradient` (of the 15 channels) what gradients of omega, alpha and velocity make.
  void pull_back(const Eigen::Vector3d& d_omega, const Eigen::Vector3d& d_alpha,
                 const Eigen::Vector3d& d_velocity, Instant& gradient) const;
  /// The same for d(R^T u) where turned = R^T u and u does not depend on the angles.
  void pull_back_turn(const Eigen::Vector3d& turned, const Eigen::Vector3d& d_turned,
                      Instant& gradient) const;

 private:
  Eigen::Vector3d rate_, acceleration_;                 // theta', theta''
  Eigen::Matrix3d W_, W_b_, W_g_, W_bb_, W_bg_, W_gg_;  // by beta and gamma
};

}  // namespace dcnn::frame_tcn
