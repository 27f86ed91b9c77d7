// SPDX-License-Identifier: Apache-2.0
// The rows a feature set can have: blocks that are there as a whole or left out.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/features.h"

namespace dcnn {

enum class Quantity {
  kOrientation,
  kVelocity,
  kAngularVelocity,
  kAcceleration,
  kAngularAcceleration,
  kAxisPosition,
  kAxisVelocity,
  kAxisAcceleration,
  kSignal,
};

struct Block {
  Quantity quantity;
  std::vector<std::string> names;  ///< of the rows
  std::string unit;
  std::size_t axis = 0;  ///< which axis, for the set axes
};

/// All blocks of a feature set, in the order of the rows.
std::vector<Block> feature_blocks(const FeatureSpec& spec, const System& system);
std::vector<Block> axis_blocks(const System& system);

/// The blocks whose rows the layout has; a row that no block makes is an Error(exit) naming
/// `where`.
std::vector<Block> used_blocks(const FeatureLayout& layout, const std::string& where, Exit exit);

/// The log itself holds the rates of the block, so that nothing is differentiated (wrist only).
bool is_logged(const Block& block, const Recording& recording);

/// Mean direction of each Euler angle over all rows: to which later recordings are shifted.
Eigen::Vector3d circular_mean(const std::vector<Recording>& recordings);
/// (T, 3) Euler angles, unwrapped; each segment begins within pi of the branch.
Eigen::MatrixXd aligned_euler(const Recording& recording, const Eigen::Vector3d& branch);

/// omega = 2 vec(conj(q)·rate)/|q|^2 in E for rate = dq/dt, and alpha for its derivative: the
/// product of dq/dt with itself has no vector part. No Euler angle anywhere, so no singularity.
Eigen::Vector3d angular_rate(const Eigen::Vector4d& q, const Eigen::Vector4d& rate);

/// The recording has what the block is computed from.
bool is_available(const Block& block, const Recording& recording, const System& system);
bool is_axis_available(const Block& block, const Recording& recording, const System& system);

/// The columns of each block, side by side: (T, rows of the layout).
Eigen::MatrixXd wrist_features(const Recording& recording, const FeatureLayout& layout,
                               const std::vector<Block>& blocks);
Eigen::MatrixXd axis_features(const Recording& recording, const FeatureLayout& layout,
                              const std::vector<Block>& blocks);

}  // namespace dcnn
