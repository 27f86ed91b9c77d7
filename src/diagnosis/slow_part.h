// SPDX-License-Identifier: Apache-2.0
// Noise that grows towards low frequencies, below the band in which the floor is read.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/noise_floor.h"

namespace dcnn {

/// What is added to a floor: noise of density 1/f^p or a first-order Gauss-Markov process.
struct SlowPart {
  double power = 0.0, slope = 1.0;       ///< density at 1 Hz, and p
  double markov = 0.0, corner_hz = 1.0;  ///< density at 0 Hz, and the corner

  void add_to(Floor& floor) const;
  int numbers() const { return (power > 0.0) * (1 + (slope != 1.0)) + 2 * (markov > 0.0); }
};

/// The likeliest (Whittle) for what is left below 10 Hz beside these floors, by channel, of one
/// form in all unless the channels speak against that, within the bounds of priors.h. None of
/// recordings too short to tell.
std::optional<std::vector<SlowPart>> slow_parts(const Case& study, const Signals& left,
                                                const std::vector<Floor>& floors);

}  // namespace dcnn
