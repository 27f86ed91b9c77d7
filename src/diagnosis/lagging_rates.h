// SPDX-License-Identifier: Apache-2.0
// Rates that were logged later than the positions they belong to.
#pragma once

#include <vector>

#include "dcnn/data/recording.h"
#include "dcnn/data/system.h"

namespace dcnn {

/// Lag [s] of a logged rate behind the derivative of its position, both below `hz`: least squares
/// of v = q'(t - lag) to first order. 0 where that explains less than half of the power of v - q',
/// or this is within the error of any law (kModelError): what differs is noise then, or another
/// rate; and where it is less than a difference of neighbouring rows is late.
double rate_lag(const std::vector<Recording>& recordings, const Axis& axis, double hz);

/// Leaves lagging rates out of the description of the axes, so that they are derived of the
/// positions, and says so in the notes of the first recording. A driver that divides differences by
/// the clock's step, or filters, is late by some rows, in which dry friction has the wrong sign.
void leave_lagging_rates(std::vector<Recording>& recordings, System& system,
                         const std::vector<double>& motion_hz);

}  // namespace dcnn
