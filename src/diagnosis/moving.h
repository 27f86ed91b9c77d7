// SPDX-License-Identifier: Apache-2.0
// Whether an axis moves, or its encoder is all that does.
#pragma once

#include "diagnosis/case.h"

namespace dcnn {

/// Whether the axis' position varies by more than ten deviations of its noise within the motion's
/// band: else its rate is noise. The noise is read above that band, and of second differences,
/// whichever is less: motion may fill all of a slow recording's band, and a position may jump.
bool moves(const Case& study);

}  // namespace dcnn
