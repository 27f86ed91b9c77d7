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

/// The recording has what the block is computed from.
bool is_available(const Block& block, const Recording& recording, const System& system);
bool is_axis_available(const Block& block, const Recording& recording, const System& system);

/// The columns of each block, side by side: (T, rows of the layout).
Eigen::MatrixXd wrist_features(const Recording& recording, const FeatureLayout& layout,
                               const std::vector<Block>& blocks);
Eigen::MatrixXd axis_features(const Recording& recording, const FeatureLayout& layout,
                              const std::vector<Block>& blocks);

}  // namespace dcnn
