// SPDX-License-Identifier: Apache-2.0
// What must be true of a model before, and of a sample while, it runs online.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dcnn/runtime/compensator.h"

namespace dcnn {

/// Error(kModel) for a model that is not of a wrist tool, looks ahead, or has no clock.
void require_online(const Identifier& identifier, const std::string& where);

/// Where in a wrench each target stands: 3 of a force or 6 of force and torque; else Error(kModel).
std::vector<Index> wrench_places(const Targets& targets, const std::string& where);

/// The model sample by sample, after it has answered like the whole-recording one on rows drawn
/// from its own statistics; else Error(kModel).
std::unique_ptr<Predictor> checked_predictor(const Identifier& identifier,
                                             const std::string& where);

inline bool is_causal(const DerivativeSpec& derivative) {
  return derivative.kind == DerivativeSpec::Kind::kCausalSavitzkyGolay;
}

/// All finite and within what a robot can be; the quaternion's norm is 1 to 1e-3.
bool is_possible(const OnlineSample& sample) noexcept;

/// |cos beta| < 0.05, as in training (FeatureLayout).
bool is_singular(const Eigen::Matrix3d& R_BE) noexcept;

}  // namespace dcnn
