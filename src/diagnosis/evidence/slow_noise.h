// SPDX-License-Identifier: Apache-2.0
// Noise that rises towards low frequencies, below the band in which the floor is read.
#pragma once

#include "diagnosis/evidence/grid.h"

namespace dcnn::evidence {

/// ln of the Bayes factor, its prior included, of noise of density 1 + corner/f over that of
/// density 1, in the cosine transforms of the residual's runs: the corner of each channel
/// log-uniform between kLeastCorner and kMostCorner (priors.h, kSlowNoise).
struct SlowNoise {
  double log_factor = 0.0;
  /// No band of an octave holds more than kMostSlowNoise times the floor: else it is no sensor's.
  bool plausible = true;
};
SlowNoise slow_noise(const Grid& grid, const Eigen::VectorXd& residual);

}  // namespace dcnn::evidence
