// SPDX-License-Identifier: Apache-2.0
// The sensor's noise, from the band above the motion, and the noise that smoothed poses carry.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/chain.h"
#include "diagnosis/periodograms.h"

namespace dcnn {

/// A mode of the tool along one channel: its force is 1 + fraction (H - 1) of the rigid one's.
struct Mode {
  double hz, zeta, fraction;
};

/// Noise of one channel: white plus AR(1) or flicker, per sample, in the target's unit squared.
struct Floor {
  double white = 0.0, coloured = 0.0;  ///< variances
  double rho = 0.0;                    ///< coefficient of the coloured part
  /// Behind a second-order Butterworth filter of the maker: density at 0 Hz, cut-off [Hz].
  double filtered = 0.0, filter_hz = 1.0;
  double flicker = 0.0;  ///< density [per sample] times frequency [Hz]
  /// Slow part of density 1/f^slope: that at 1 Hz.
  double power = 0.0, slope = 1.0;
  /// Slow first-order Gauss-Markov part: its density at 0 Hz and its corner [Hz].
  double markov = 0.0, corner_hz = 1.0;
  double lines = 0.0;  ///< variance of lines above the motion's band, part of no density
  /// Variance of rounding to a step beyond what the density holds of it: the error of a reading
  /// that moves slowly is as slow, and no part of a spectrum above the motion.
  double rounding = 0.0;
  /// Spectral density of what the pose's noise adds through accelerations and gravity:
  /// (static_part + moving_part·w^4)·|H|, per sample, with |H| the gain of the pose's filter in
  /// even steps up to half the rate. Behind a Wiener filter that is the variance of its error.
  double static_part = 0.0, moving_part = 0.0;
  std::vector<double> pose_gain = {};     ///< empty: no pose is differentiated
  std::vector<Mode> modes = {};           ///< in which motion that the pose does not show rings
  std::string source = {};                ///< in words
  double lowpass_hz = 0.0;                ///< of the filter that the noise has passed; 0: none
  double dt = 0.0;                        ///< s, between samples
  std::vector<double> interpolated = {};  ///< as Recording::interpolated, by which it is seen

  /// Frequency and factor, at most 1, of octaves in which the residual is below what was fitted
  /// above the motion: no noise exceeds what the model leaves.
  std::vector<std::pair<double, double>> bounds = {};

  /// Makes all parts of the density, and the lines, so many times as large.
  void amplify(double factor);
  double deviation() const;                                        ///< of the sensor alone
  bool is_slow() const { return flicker + power + markov > 0.0; }  ///< denser at lower frequencies
  /// Density at `hz`, scaled so that white noise of variance s^2 has density s^2.
  double density(double hz) const;
  /// Standard deviation with what the pose's noise adds.
  double whole_deviation() const;
  /// Relative standard deviation of the mean square of a recording of so many seconds: of slow
  /// noise it has few periods.
  double power_deviation(double seconds) const;
  /// Variance that the pose's noise adds.
  double pose_variance() const;
  /// What the pose's noise adds to the density.
  double pose_density(double hz) const;
};

/// Lowest frequency that is free of motion in these recordings.
double quiet_band(const Case& study);

/// Whittle fit of white, AR(1) + white, filtered + white or flicker + white noise to the residual
/// above the motion's band, divided by the noise's relative level (of noise_level()), by channel:
/// over the whole band an effect would raise its own floor. Medians exclude lines and impacts.
/// Colour needs a likelihood gain above 12.
std::vector<Floor> noise_floor(const Case& study, const Signals& residual, const Signals& levels);

/// The same, of all that a model leaves, as if it were nothing but noise: none where the band above
/// the motion refutes such noise (its own likeliest is likelier by more than chance, 99.9 %). What
/// lies far below that band it hardly tells. What the pose's noise adds to the density is that of
/// the `known` floors.
std::optional<std::vector<Floor>> noise_of_all(const Case& study, const Signals& residual,
                                               const Signals& levels,
                                               const std::vector<Floor>& known);

/// The mean density above the motion's band, without lines, by channel; 0 where too few bins are.
std::vector<double> quiet_density(const Case& study, const Signals& residual,
                                  const Signals& levels);

/// Whether a floor exceeds the density of a residual (of periodograms() and slow_bins()) in some
/// octave by more than its sampling error (99.9 %).
bool exceeds(const Floor& floor, const Periodograms& p, const Eigen::VectorXd& density,
             const std::vector<SlowBin>& slow);

/// Lowers the floors to the residual's spectrum in octaves where they exceed it by more than its
/// sampling error (99.9 %).
void bound_by_residual(const Case& study, const Signals& residual, const Signals& levels,
                       std::vector<Floor>& floors);

/// Of poses at rest: what a free matrix on the direction of gravity and an offset leave, which
/// holds every linear fault of tool and sensor. Error(kData) for fewer than 7 poses.
std::vector<Floor> floor_at_rest(const Case& study, const Signals& residual);

/// Completes floors of readings that are rounded to a step q: as deviates a reading, q^2/12 beside
/// the noise before it.
void add_rounding(const Case& study, std::vector<Floor>& floors);

/// Adds what the pose's own noise, read from the raw pose above the motion's band, puts into the
/// prediction: through accelerations (mass and lever) and through gravity.
void add_pose_noise(const Case& study, std::vector<Floor>& floors);

/// Of an axis: whether an effect makes noise of the position a part of the prediction.
bool brings_position_noise(const Case& study, const Member& member);

/// Of an axis: adds what the noise of the position or rate that is differentiated puts into the
/// prediction. It is drawn with the density of the band above the motion, passed through filter,
/// simulator and inertias among `members`, and read off as a spectrum; in no octave more than that
/// of what is `left`.
void add_position_noise(const Case& study, const std::vector<Member>& members, const Signals& left,
                        std::vector<Floor>& floors);

/// Density, at `hz`, of what motion as large as that noise would make of an axis' prediction if no
/// filter took it off; 0 for a tool.
double unseen_motion(const Case& study, const std::vector<Member>& members, double hz);

/// Correlation of the channels' noise (channels, channels), positive definite: of the second
/// differences of a residual, where it exceeds what chance makes of independent ones.
Eigen::MatrixXd noise_correlation(const Case& study, const Signals& residual,
                                  const Signals& levels);

/// Relative level of each channel's noise over time, (T, channels) per recording, of mean square 1
/// where a machine does not rest:
/// the logarithm of the mean absolute second difference of the residual over 0.5 s, linear in the
/// force that is predicted beside a burst of its own, both shrunk by how well they are known (the
/// empirical Bayes estimate of James and Stein 1961), so that noise of one level has level 1.
Signals noise_level(const Case& study, const Signals& residual);

}  // namespace dcnn
