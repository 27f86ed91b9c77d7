// SPDX-License-Identifier: Apache-2.0
// The simulator's own numbers against what was found one by one, on what was held out.
#pragma once

#include "diagnosis/holdout.h"

namespace dcnn {

/// Of a tool whose simulator's own numbers alone (mass, centre, tilt of gravity, offset) explain
/// nearly all of what was missing in what was held out, and more than all that was found: takes
/// them. Of several laws that each fit a little of what they leave, none needs to be true, and that
/// they leave something refutes none of them. Returns what it refutes on the way, as
/// leave_refuted() does.
Json take_own_numbers(Search& search, const HoldOut& holdout);

}  // namespace dcnn
