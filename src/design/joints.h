// SPDX-License-Identifier: Apache-2.0
// The pose and its derivatives of an arm whose joints move.
#pragma once

#include <Eigen/Dense>

#include "dcnn/physics/chain.h"

namespace dcnn::design {

/// Motion of the flange E in B at one instant.
struct FlangeState {
  Eigen::Matrix3d R;                   ///< E to B
  Eigen::Vector3d p, v, a, w_E, dw_E;  ///< position, velocity, acceleration in B; rates in E
};
/// Outward recursion over the joints (Craig 2005, section 6.5).
FlangeState flange_state(const JointChain& chain, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd);

/// x,y,z,alpha,beta,gamma of the flange.
Eigen::VectorXd pose_of(const JointChain& chain, const Eigen::VectorXd& q);

}  // namespace dcnn::design
