// SPDX-License-Identifier: Apache-2.0
// Draws of the parameters from their distribution, restricted to bodies that can exist.
#pragma once

#include "dcnn/core/random.h"
#include "identification/wrist_fit.h"

namespace dcnn::identification {

/// [[tr(I)/2·1 - I, h], [h^T, m]], lengths in units of 0.1 m: positive definite if and only if there
/// is a body of positive density with these parameters (Wensing, Kim and Slotine 2018).
Eigen::Matrix4d pseudo_inertia_of(const WristState& state);

struct Draws {
  std::vector<WristState> states;
  bool constrained = false;  ///< the estimate itself is no body: draws come from the boundary's side
  double inside = 1.0;       ///< share of the free distribution that bodies can have
};

/// The Student distribution about the fit, truncated to positive definite pseudo-inertias (with
/// forces alone: to positive masses). By rejection; where few draws pass, by hit and run on the
/// truncated normal distribution.
Draws draw_states(const WristFit& fit, int count, Rng& rng);

/// The mean of the draws in the parameters; a body, for bodies are a convex set.
WristState mean_state(const WristFit& fit, const Draws& draws);

}  // namespace dcnn::identification
