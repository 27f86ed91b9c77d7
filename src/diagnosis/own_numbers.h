// The simulator's own numbers against what was found one by one, on what was held out.
#pragma once

#include "diagnosis/holdout.h"

namespace dcnn {

/// Of a tool whose simulator's own numbers alone (mass, centre, tilt of gravity, offset) predict
/// what was held out better than all that was found: searches again beside them, and keeps what
/// the held-out data bear out better. Of several laws that each fit a little of what they leave,
/// none needs to be true. What it refutes on the way: names as leave_refuted() has them.
Json begin_with_own_numbers(Search& search, const HoldOut& holdout);

}  // namespace dcnn
