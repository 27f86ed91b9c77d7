// SPDX-License-Identifier: Apache-2.0
// One regression for all joints of an arm.
#pragma once

#include "identification/arm_log.h"

namespace dcnn::identification {

/// A term of one joint's drive.
enum class DriveTerm { kOffset, kDry, kViscous, kRotor, kLoad, kQuadratic, kStribeck, kGain };

struct Drive {
  std::vector<DriveTerm> terms{DriveTerm::kOffset, DriveTerm::kDry, DriveTerm::kViscous,
                               DriveTerm::kRotor};
  double presliding = 1e-3;  ///< path of the dry friction's Dahl state
  double creep_s = 0.0;      ///< in which the dry friction falls by 1/e at rest; 0: it stays
  double slow = 0.1;         ///< speed at which Stribeck friction has fallen by 1/e
  double gain = 1.0;         ///< of the rigid torque, where drive gains are fitted
};

struct ArmFit {
  std::vector<Drive> drives;
  std::vector<Index> first;  ///< place of each drive's first term
  Index payload = -1;        ///< place of the payload's ten parameters; -1: none
  Eigen::VectorXd x, deviation;  ///< links (10 each), drives, payload
  Eigen::MatrixXd covariance;
  Eigen::VectorXd residual_rms, correlated;  ///< (joints); rows that count as one
  Eigen::VectorXd prior_deviation;           ///< of x
};

/// Weighted least squares under priors; friction's path, and terms beyond dry, viscous and inertia,
/// are chosen joint by joint.
ArmFit fit_arm(const JointChain& chain, std::vector<ArmLog>& logs, bool drive_gains);

/// (n, joints): what the fit says of a recording, in its thinned rows.
Eigen::MatrixXd predicted_torque(const JointChain& chain, const ArmFit& fit, const ArmLog& log);

/// How many combinations of the links' and drives' inertial parameters the logs tell.
int told_combinations(const std::vector<ArmLog>& logs);

}  // namespace dcnn::identification
