// SPDX-License-Identifier: Apache-2.0
// Lines in the spectrum of what is left.
#pragma once

#include <vector>

#include "diagnosis/chain.h"
#include "diagnosis/noise_floor.h"

namespace dcnn {

/// The periodogram of x less its mean under a Hann window, scaled so that white noise of variance
/// s^2 has mean s^2; zeros behind x fill it up to `length`.
Eigen::VectorXd hann_power(const Eigen::VectorXd& x, Index length);

/// The strongest lines of what is left, in the whole band of the log: frequency [Hz] and how often
/// its power is the floor's, strongest first.
struct Peak {
  double hz;
  double ratio;
};
std::vector<Peak> spectral_lines(const Case& study, const Signals& left,
                                 const std::vector<Floor>& floors, double from_hz, double to_hz,
                                 Index channel, int most);

/// A line of all channels and recordings together, a sum of so many independent `terms`.
struct CommonLine {
  double hz;
  double ratio;   ///< of its power to the floor's
  double excess;  ///< of its power, in units of the mean level beside it, over `terms`
  double terms;
  double beside;  ///< the mean level beside it, over the floor's
  /// More than one of 1e8 bins of noise: a line stands out of what is beside it, whatever the floor
  /// may be there.
  bool stands_out() const;
};
/// The strongest, that first.
std::vector<CommonLine> common_lines(const Case& study, const Signals& left,
                                     const std::vector<Floor>& floors, double from_hz, double to_hz,
                                     int most);

}  // namespace dcnn
