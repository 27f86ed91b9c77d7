// SPDX-License-Identifier: Apache-2.0
// Rates that were logged later than the positions they belong to.
#pragma once

#include <vector>

#include "dcnn/data/recording.h"
#include "dcnn/data/system.h"

namespace dcnn {

/// Sums over rows below some frequency, of which least squares of v = q'(t - lag) to first order is
/// made; all are 0 where nothing can be told.
struct RateSums {
  double difference = 0.0;  ///< of (v - q')^2
  double match = 0.0;       ///< of -(v - q') q''
  double turning = 0.0;     ///< of q''^2
  double power = 0.0;       ///< of q'^2
};
RateSums rate_sums(const std::vector<Recording>& recordings, const Axis& axis, double hz);

/// Lag [s] that the rates of some axes share behind the derivatives of their positions, each axis
/// weighed by its own difference. 0 where it explains less than half of the power of v - q', or
/// this is within the error of any law (kModelError): what differs is noise then, or another rate;
/// and where it is less than a difference of neighbouring rows (`step` [s] apart) is late.
double rate_lag(const std::vector<RateSums>& axes, double step);

/// Leaves lagging rates out of the description of the axes, so that they are derived of the
/// positions, and says so in the notes of the first recording. A driver that divides differences by
/// the clock's step, or filters, is late by some rows, in which dry friction has the wrong sign. It
/// does so to all axes: all rates are left that lag together, else those that lag alone.
void leave_lagging_rates(std::vector<Recording>& recordings, System& system,
                         const std::vector<double>& motion_hz);

}  // namespace dcnn
