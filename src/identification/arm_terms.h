// SPDX-License-Identifier: Apache-2.0
// Columns of one joint's drive.
#pragma once

#include "identification/arm_fit.h"

namespace dcnn::identification {

/// (n, terms): what a unit of each term adds to the joint's torque in the thinned rows; `rigid` (n) is
/// the torque that the rigid body takes.
Eigen::MatrixXd drive_columns(const ArmLog& log, Index joint, const Drive& drive,
                              const Eigen::VectorXd& rigid);
/// (n, terms) of single terms.
Eigen::MatrixXd term_columns(const ArmLog& log, Index joint, const Drive& drive,
                             const std::vector<DriveTerm>& terms, const Eigen::VectorXd& rigid);

/// (n, 10): a payload's parameters in the flange's frame, as torque of the joint.
Eigen::MatrixXd payload_columns(const JointChain& chain, const ArmLog& log, std::size_t joint);

}  // namespace dcnn::identification
