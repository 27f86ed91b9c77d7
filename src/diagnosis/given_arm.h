// SPDX-License-Identifier: Apache-2.0
// An arm whose simulator is given (simulated torques, or links whose bodies are described): whether
// a body at its flange is missing, or the links are others than those described.
#pragma once

#include <optional>

#include "diagnosis/arm_sums.h"

namespace dcnn {

struct GivenArm {
  enum class Missing { kNothing, kPayload, kLinks };
  Missing missing = Missing::kNothing;
  BodyVector payload = BodyVector::Zero();  ///< in the flange's frame
  Eigen::VectorXd links;                    ///< (10·joints): of links that differ, fitted
  Json finding;  ///< null where nothing is missing; holdout_gain is not set
};

/// The likeliest account of what the given simulator leaves on all joints at once
/// (arm_structure.h), beside terms of single joints: nothing; mass and centre of a payload (4
/// numbers); with its inertia (10); the links' base parameters where `bodies` are described (else
/// no rows). Intervals are jackknife over pieces of time.
GivenArm what_is_missing(const std::vector<JointRows>& rows, const JointChain& chain,
                         const Eigen::VectorXd& bodies);

/// (10·joints, columns): links' parameters from those that all joints together tell apart.
Eigen::MatrixXd told_parameters(const std::vector<JointRows>& rows);

}  // namespace dcnn
