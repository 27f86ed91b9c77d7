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
  double ratio;       ///< of its power to the floor's
  double prominence;  ///< of its power to the level beside it
};
std::vector<Peak> spectral_lines(const Case& study, const Signals& left,
                                 const std::vector<Floor>& floors, double from_hz, double to_hz,
                                 Index channel, int most);

}  // namespace dcnn
