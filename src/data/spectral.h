// SPDX-License-Identifier: Apache-2.0
// Zero-phase smoothing and differentiation in the frequency domain.
#pragma once

#include "dcnn/data/derivative.h"

namespace dcnn {

/// A zero-phase filter |H| = W(f)/(1 + (f/cutoff)^8). W = 1, or with `subtraction` > 0 the Wiener
/// gain S/(S + cN) (Wiener 1949): c = subtraction, N the noise's power, the median of the
/// signal's own spectrum, averaged over half a hertz, in the upper half of the band, and S what
/// stands above cN, at least what chance hides there; the variance of what it leaves is W N. What
/// moves in several bands, a hand that moves slowly and trembles fast, passes; what lies between
/// them does not. With `most_noise` motion near the cut-off and beyond, up to `fastest_hz`, passes
/// too, with its Wiener gain: what exceeds that many times N, given for each hertz from 0 on (the
/// last value also above), by more than chance (1e-6). A cut-off that was chosen on one recording,
/// beyond which that one reaches so much, then serves one that trembles.
struct LowPass {
  double cutoff_hz = 11.0;
  double subtraction = 0.0;
  std::vector<double> most_noise = {};
  double fastest_hz = 25.0;
};

/// Flank of the taper at either end of a signal [s], within which fast motion passes in part.
constexpr double kFlankSeconds = 0.5;

/// The most that x holds in each hertz from 0 on or anywhere above, up to `fastest_hz`, in units of
/// its noise's power; below 0.7 of the cut-off, where it moves, what it holds from there on.
std::vector<double> most_noise(const Eigen::Ref<const Eigen::VectorXd>& x, double dt,
                               const LowPass& filter);

/// Value, first and second derivative of x behind the filter, which leaves the motion's band as it
/// is: what a causal or a local polynomial fit cannot do. The signal is mirrored oddly through its
/// ends over up to 2 s.
struct Smoothed {
  Eigen::VectorXd value, first, second;
  bool is_fast = false;  ///< motion beyond the cut-off has passed, tapered over kFlankSeconds
};
Smoothed smooth(const Eigen::Ref<const Eigen::VectorXd>& x, double dt, const LowPass& filter);

/// The filter's gain for x at frequencies 0 … half the rate, in so many even steps.
Eigen::VectorXd gain_of(const Eigen::Ref<const Eigen::VectorXd>& x, double dt,
                        const LowPass& filter, Index steps);

}  // namespace dcnn
