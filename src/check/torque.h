// SPDX-License-Identifier: Apache-2.0
// The torque of a rigid tool, fitted to a wrist's torques under one reading of them.
#pragma once

#include <string>

#include "check/kind.h"

namespace dcnn::check {

/// T_S = unit · axes · T_log, or R^T of that.
struct TorqueReading {
  const FaultKind* kind = nullptr;  ///< null: nothing is wrong with it
  double prior = 1.0, unit = 1.0;   ///< N·m per unit of the file
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  bool in_base = false;
  std::string channel, words;
};

struct TorqueFit {
  Eigen::Vector3d moment{0, 0, 0};   ///< h = m c [kg m]
  Eigen::Matrix3d covariance;        ///< of h, one to a residual [kg² m²]
  double variance = 0.0;             ///< of the residual per axis, robust [N² m²]
  Eigen::MatrixXd torque, residual;  ///< (n,3) in S [N·m]
};

/// What all readings share: the tool's columns and the torques as logged.
class TorqueDesign {
 public:
  explicit TorqueDesign(const Evidence& evidence);
  /// T = h x field - I dw - w x I w + p x rest + bias by robust least squares; `rest` is the force
  /// that no rigid tool makes, and acts at a point p. No moment of inertia is below zero.
  TorqueFit fit(const TorqueReading& reading) const;
  /// Log posterior but for a constant.
  double log_weight(const TorqueReading& reading) const;
  /// Share of the torque's power about its mean that the reading leaves, noise apart.
  double foreign_share(const TorqueReading& reading) const;

 private:
  double lever_weight(const TorqueFit& fit) const;
  double force_weight(const TorqueFit& fit) const;

  const Evidence& e_;
  const RigidFit& force_;              ///< beside friction: its moment is the tool's
  std::vector<Eigen::MatrixXd> rows_;  ///< (3,15) of h, p, I, bias
  std::vector<Eigen::Matrix3d> R_;     ///< R_BS
  Eigen::MatrixXd logged_;             ///< (n,3), smoothed
};

/// Whether the log has torques beside forces that a rigid tool explains.
bool can_fit_torque(const Evidence& evidence);

}  // namespace dcnn::check
