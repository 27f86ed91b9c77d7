// SPDX-License-Identifier: Apache-2.0
// Four estimators: first and second derivatives of sampled signals, length
// preserved.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/core/options.h"
#include "dcnn/data/recording.h"

namespace dcnn {

struct DerivativeSpec {
  enum class Kind { kSavitzkyGolay, kCausalSavitzkyGolay, kCentral, kSpline, kSpectral };
  Kind kind = Kind::kSavitzkyGolay;
  double window_s = 0.1;
  int order = 3;            ///< degree of the local polynomial (sg: 3, sg_causal: 2 by default)
  double cutoff_hz = 11.0;  ///< spectral: |H| = W(f)/(1 + (f/cutoff)^8), zero phase
  /// spectral: 0 for W = 1; else W is the Wiener gain of every column's own spectrum, its noise
  /// taken this many times.
  double subtraction = 0.0;
  /// spectral: how many times its noise a column holds beyond the cut-off at most, in each hertz
  /// from 0 on (the last also above); more is motion and passes. Empty: nothing passes.
  std::vector<double> most_noise = {};
  double fastest_hz = 25.0;  ///< spectral: up to which motion beyond the cut-off passes

  /// Number of samples in the window: 2·round(window_s/(2·dt)) + 1, at least order + 4 (odd).
  int window(double dt) const;
  /// Rows between two gaps that it needs at least.
  int fewest_rows(double dt) const;
};

/// The estimator of everything that runs online: a causal parabola over 0.1 s.
inline DerivativeSpec causal_derivative() {
  DerivativeSpec spec;
  spec.kind = DerivativeSpec::Kind::kCausalSavitzkyGolay;
  spec.order = 2;
  return spec;
}

/// Keys: kind (sg|sg_causal|central|spline|spectral), window_s, order, cutoff_hz, subtraction,
/// most_noise (a number or a list), fastest_hz.
DerivativeSpec parse_derivative(Options options);
Json to_json(const DerivativeSpec& spec);

/// Weights w so that the derivative of the given order (0, 1, 2) at offset `at` (samples from the
/// window's first) of the least-squares polynomial through `window` samples is sum w_k·x_k /
/// dt^derivative.
Eigen::VectorXd savitzky_golay_weights(int window, int order, int derivative, double at);

struct Derivatives {
  Eigen::MatrixXd first, second;  ///< (T, columns), per second and per second squared
  Eigen::MatrixXd
      value;  ///< (T, columns) the signals as the estimator sees them: smoothed by `spectral`
  /// Motion beyond the cut-off has passed, but for half a second at either end of a segment, where
  /// it passes in part.
  bool is_fast = false;
};

/// Derivatives of every column, segment by segment. Rows that a segment lacks (steps of two to five
/// dt) are bridged by a cubic spline first. A segment shorter than the window is an Error(kData)
/// that names the recording, the rows and the remedy.
Derivatives differentiate(Eigen::MatrixXd signals, const Recording& recording,
                          const DerivativeSpec& spec);

}  // namespace dcnn
