// SPDX-License-Identifier: Apache-2.0
// Stretches of a recording in which far more is left than anywhere else.
#pragma once

#include <vector>

#include "diagnosis/search.h"

namespace dcnn {

/// A collision, a hand on the machine, a controller that oscillates: half seconds whose mean square
/// of the whitened residual `left` is larger than a log-normal distribution with the median and the
/// median deviation of all half seconds makes in one recording of a hundred. Each with half a
/// second on either side; none of a recording of which they are more than a fifth: that shows other
/// motion. Rows in `held_out` are not looked at.
std::vector<Span> outlying(const Setting& setting, const Signals& left,
                           const std::vector<Span>& held_out);

}  // namespace dcnn
