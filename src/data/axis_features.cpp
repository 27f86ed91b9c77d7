// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "data/feature_blocks.h"

namespace dcnn {
namespace {

/// The logged column behind a block, empty where the quantity is derived.
std::string logged(const Block& block, const Axis& axis) {
  switch (block.quantity) {
    case Quantity::kAxisPosition:
      return axis.position;
    case Quantity::kAxisVelocity:
      return axis.velocity;
    case Quantity::kAxisAcceleration:
      return axis.acceleration;
    default:
      return block.names[0];
  }
}

/// The derivative of the given order (1 or 2) of the axis' position.
Eigen::VectorXd derived(const Recording& recording, const FeatureSpec& spec, const Axis& axis,
                        Quantity quantity) {
  const Derivatives rates =
      differentiate(recording.block({axis.position}), recording, spec.derivative);
  return quantity == Quantity::kAxisVelocity ? rates.first.col(0) : rates.second.col(0);
}

}  // namespace

std::vector<Block> axis_blocks(const System& system) {
  std::vector<Block> blocks;
  std::vector<std::string> signals;
  for (std::size_t k = 0; k < system.axes.size(); ++k) {
    const Axis& axis = system.axes[k];
    blocks.push_back({Quantity::kAxisPosition, {axis.name + "_position"}, "", k});
    blocks.push_back({Quantity::kAxisVelocity, {axis.name + "_velocity"}, "", k});
    blocks.push_back({Quantity::kAxisAcceleration, {axis.name + "_acceleration"}, "", k});
    for (const std::string& signal : axis.signals) {
      // One row for a signal that several axes share.
      if (std::find(signals.begin(), signals.end(), signal) != signals.end()) continue;
      signals.push_back(signal);
      blocks.push_back({Quantity::kSignal, {signal}, "", k});
    }
  }
  return blocks;
}

bool is_axis_available(const Block& block, const Recording& recording, const System& system) {
  const Axis& axis = system.axes[block.axis];
  const std::string column = logged(block, axis);
  if (!column.empty()) return recording.has(column);
  const bool rate = block.quantity != Quantity::kAxisPosition;
  return rate && recording.dt > 0.0 && !axis.position.empty() && recording.has(axis.position);
}

Eigen::MatrixXd axis_features(const Recording& recording, const FeatureLayout& layout,
                              const std::vector<Block>& blocks) {
  Eigen::MatrixXd x(recording.samples(), static_cast<Index>(blocks.size()));
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const Axis& axis = layout.system.axes[blocks[k].axis];
    const std::string column = logged(blocks[k], axis);
    x.col(static_cast<Index>(k)) = column.empty()
                                       ? derived(recording, layout.spec, axis, blocks[k].quantity)
                                       : recording.column(column);
  }
  return x;
}

}  // namespace dcnn
