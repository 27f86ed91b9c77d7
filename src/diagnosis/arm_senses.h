// SPDX-License-Identifier: Apache-2.0
// Which joints of an arm measure their drive's torque, and which its reaction.
#pragma once

#include "diagnosis/arm_sums.h"

namespace dcnn {

/// The model of an arm's links beside an offset and friction of each joint, with the joints turned
/// that others' motion and their own friction show to be. `told`: ArmModel::shared; `senses`
/// (joints): what each joint's rows were taken for, 1 its drive's torque, -1 the reaction.
ArmModel with_likeliest_senses(const ArmSums& sums, const Eigen::MatrixXd& told,
                               const Eigen::VectorXd& senses);

}  // namespace dcnn
