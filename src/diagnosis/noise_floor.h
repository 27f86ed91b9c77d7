// The sensor's noise, from the band above the motion, and the noise that smoothed poses carry.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/chain.h"

namespace dcnn {

/// Noise of one channel: white plus AR(1), per sample, in the target's unit squared.
struct Floor {
  double white = 0.0, coloured = 0.0;  ///< variances
  double rho = 0.0;                    ///< coefficient of the coloured part
  /// Spectral density of what the pose's noise adds through accelerations and gravity:
  /// static_part·|H| + moving_part·w^4·|H|, per sample.
  double static_part = 0.0, moving_part = 0.0;
  std::string source;  ///< in words
  double lowpass_hz = 0.0, dt = 0.0;  ///< the filter that the noise has passed; 0: none

  double deviation() const;  ///< of the sensor alone
  /// Density at `hz`, scaled so that white noise of variance s^2 has density s^2.
  double density(double hz, double dt) const;
  /// What the pose's noise adds to it behind a smoother that cuts at `cutoff_hz` (0: none).
  double pose_density(double hz, double cutoff_hz) const;
};

/// Lowest frequency that is free of motion in these recordings.
double quiet_band(const Case& study);

/// Whittle fit of white or AR(1) + white noise to the residual above the motion's band, by channel
/// (lessons of concealed data: over the whole band an effect would raise its own floor). Lines and
/// knocks are kept out by medians. Colour needs a likelihood gain above 12.
std::vector<Floor> noise_floor(const Case& study, const Signals& residual);

/// Adds what the pose's own noise, read from the raw pose above the motion's band, puts into the
/// prediction: through accelerations (mass and lever) and through gravity.
void add_pose_noise(const Case& study, std::vector<Floor>& floors);

/// Relative level of the noise over time, (T) per recording, from the second differences of the
/// residual over 1 s; ones where it hardly varies.
std::vector<Eigen::VectorXd> noise_level(const Case& study, const Signals& residual);

}  // namespace dcnn
