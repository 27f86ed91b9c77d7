// SPDX-License-Identifier: Apache-2.0
// Spectra of windows of a signal, and their density.
#pragma once

#include "diagnosis/chain.h"

namespace dcnn {

/// Periodograms of windows of one signal, (bins, windows), scaled so that white noise of variance
/// s^2 has mean s^2. Windows never cross a gap.
struct Periodograms {
  Eigen::MatrixXd power;
  Eigen::VectorXd hz;
};
Periodograms periodograms(const Case& study, const Signals& signals, Index channel);

/// Means over `half` samples to either side, within each segment.
Eigen::MatrixXd moving_mean(const Eigen::MatrixXd& x, const std::vector<Segment>& segments,
                            Index half);

/// A residual over the relative level L of its noise (noise_level()). The motion's band and what is
/// slower, s, is divided by a mean level that varies no faster than a window: (r - s)/L + s/rms(L).
/// (What a law leaves, a constant above all, times the steps of 1/L would pass for noise of the
/// quiet band.) Where a machine rests, s is divided by 1: what its laws err by is no quieter there.
Signals evened(const Case& study, const Signals& residual, const Signals& levels);

/// The periodograms of whole segments below the windows' third bin, scaled alike.
struct SlowBin {
  double hz, power;
};
std::vector<SlowBin> slow_bins(const Case& study, const Signals& signals, Index channel);

/// Median over windows of each bin, as an estimate of the density: the upper middle of n values of
/// an exponential distribution is on the average sum_{i=0}^{n/2} 1/(n-i) of its mean (ln 2 for
/// many).
/// `uneven`: the mean, for noise of which most windows hold less than all do together, as that of
/// readings on a coarse lattice, noisy near the middle between two values and still elsewhere.
Eigen::VectorXd density_of(const Periodograms& p, bool uneven = false);

}  // namespace dcnn
