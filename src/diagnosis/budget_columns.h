// SPDX-License-Identifier: Apache-2.0
// The columns of which budget() makes its parts.
#pragma once

#include "core/linear_algebra.h"
#include "dcnn/core/json.h"
#include "diagnosis/joint_fit.h"

namespace dcnn {

/// Whitened columns of unit length, at as many rows as a budget needs.
class BudgetColumns {
 public:
  explicit BudgetColumns(const Setting& setting);

  const Case& study() const { return setting_.coarse; }
  /// Rows of the whitener that are kept, and the columns there.
  const std::vector<Index>& rows() const { return kept_; }
  const Eigen::MatrixXd& all() const { return all_; }

  void add_whitened(const Eigen::MatrixXd& columns);
  void add(const Signals& signals);
  /// A force along an axis of the sensor, or of the base; one vector a recording.
  void add_along(int axis, bool base, const std::vector<Eigen::VectorXd>& size);
  /// The same in every channel, each with a number of its own.
  void add_by_channel(const std::vector<Eigen::VectorXd>& size);

 private:
  const Setting& setting_;
  std::vector<Index> kept_;
  Eigen::MatrixXd all_;
};

/// Functions of the rates and angles of the moment.
void add_state(BudgetColumns& columns);
/// Slope and bend of the prediction, and bristles that the motion drags along.
void add_memory(BudgetColumns& columns, const Signals& prediction);
/// Slow waves of the clock, and the temperature where it is logged.
void add_clock(BudgetColumns& columns);
/// A constant force of the base in each segment (`where.segments`).
void add_events(BudgetColumns& columns, const Json& segments);

}  // namespace dcnn
