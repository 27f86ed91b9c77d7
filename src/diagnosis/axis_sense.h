// SPDX-License-Identifier: Apache-2.0
// Whether what is measured on an axis drives it, or is the reaction to that.
#pragma once

#include <vector>

#include "dcnn/data/recording.h"
#include "dcnn/data/system.h"

namespace dcnn {

/// 1 for a drive, -1 for its reaction. A drive moves inertia along its acceleration and friction
/// along its velocity; a log of the reaction shows the opposite. The more significant of the two
/// decides, beside an offset and a spring, at the delay between motion and reading that is
/// likeliest beside none.
double sense_of(const std::vector<Recording>& recordings, const System& system, const Axis& axis,
                const DerivativeSpec& derivative);

}  // namespace dcnn
