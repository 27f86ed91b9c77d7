// SPDX-License-Identifier: Apache-2.0
// The motion of a load between two stops, from the field that acts on it.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// What is not known of a load but tried.
struct Slug {
  double gap;      ///< m
  double grip;     ///< dry friction over mass [m/s^2]
  double rebound;  ///< speed after an impact over that before
};

struct Impact {
  std::size_t log;
  Index from, at;  ///< samples: begins to slide, arrives
  double change;   ///< of its speed, along the axis [m/s]
};

/// A recording's field along the axis [m/s^2], and where it leaves the band of a friction.
struct AxisField {
  Eigen::VectorXd along;
  std::vector<Index> leaves;

  void leave(double grip);
};

/// All impacts, from stop to stop, in the order of time.
std::vector<Impact> impacts_of(const std::vector<AxisField>& fields, const Slug& slug, double dt);

}  // namespace dcnn
