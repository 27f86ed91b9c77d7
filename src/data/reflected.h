// SPDX-License-Identifier: Apache-2.0
// A signal made continuous around the circle, for its transform: what its ends and a reflection do.
#pragma once

#include <Eigen/Dense>

namespace dcnn {

/// Decaying curves that have the signal's second derivative at its two ends. An odd reflection has
/// none there; without them the smoothed acceleration would begin and end at zero.
struct EndCurves {
  double first = 0.0, last = 0.0;  ///< second derivatives, 1/s^2
  Eigen::VectorXd decay;           ///< exp(-t/T) of the time from the first sample

  /// Of a signal that is low-passed at this frequency.
  EndCurves(const Eigen::Ref<const Eigen::VectorXd>& x, double dt, double cutoff_hz);
  /// Their k-th derivative.
  Eigen::VectorXd derivative(int k) const;
};

/// The signal with its odd reflections at both ends, over up to 2 s, less the line through the
/// first and last of all these samples, and zeros up to a length that transforms fast: continuous
/// around the circle.
struct Padded {
  Eigen::VectorXd values;
  Eigen::Index pad = 0;             ///< samples of either reflection
  double level = 0.0, slope = 0.0;  ///< of the line, at the signal's first sample and per sample
};
Padded pad_oddly(const Eigen::Ref<const Eigen::VectorXd>& x, double dt);

}  // namespace dcnn
