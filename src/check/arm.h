// SPDX-License-Identifier: Apache-2.0
// An arm whose links are described (URDF), fitted to the torques of a log under one reading of it.
#pragma once

#include <optional>

#include "check/reading.h"

namespace dcnn::check {

/// Torques of all joints, in the order of the chain.
struct ArmFit {
  Eigen::MatrixXd torque, residual;  ///< (n, joints), N·m
  Eigen::VectorXd variance, floor;   ///< (joints), of the residual, robust; N·m, see kArmError
  double independent = 0.0;          ///< residuals of each joint
  Eigen::MatrixXd precision;         ///< of the posterior, in units of the prior's deviations
  double surprise = 0.0;  ///< -ln of the prior's density at the links found, but for a constant
  std::vector<Eigen::Index> rows;  ///< of the log
};

/// Whether an arm is described and the log has rows enough to fit it.
bool can_fit_arm(const Log& log, const Sampled& rows);

/// tau = Y(q, qd, qdd) (links, payload) + offset + dry + viscous + rotor inertia, joint by joint.
/// The links are Gaussian about the description, the body at the flange about none; dry friction
/// and rotor inertia are not below zero.
ArmFit fit_arm(const Log& log, const Sampled& rows, const Reading& reading);

/// Log of the posterior's part that the described arm adds, but for a constant.
struct ArmWeight {
  double of_links = 0.0;      ///< of the links found, under their description
  Eigen::VectorXd of_torque;  ///< of each of the log's joints, 0 where the arm has it not
  double sum() const { return of_links + of_torque.sum(); }
};
ArmWeight arm_weight(const Log& log, const Sampled& rows, const Reading& reading);

/// (joints) what each logged torque has to be multiplied by for the links as they are described;
/// nothing where the motion tells it of no joint. A joint that does not tell its own takes the
/// median of the others.
std::optional<Eigen::VectorXd> torque_factors(const Log& log, const Reading& reading);

/// (joints, 4): deviations of offset, dry and viscous friction and rotor inertia as torques on this
/// motion, over the joint's rms torque.
Eigen::MatrixXd drive_deviation(const ArmFit& fit);

/// Share of the torques' power about their mean that the described arm leaves; 0 without one.
double unexplained_share(const ArmFit& fit);

}  // namespace dcnn::check
