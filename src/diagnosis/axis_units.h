// SPDX-License-Identifier: Apache-2.0
// Units of an axis of a machine, which may be of any size.
#pragma once

#include "diagnosis/case.h"

namespace dcnn {

/// Sets axis_length and axis_seconds from amplitudes of position and rate, as those of sines of the
/// same deviation. Without a position the length is what is passed in a second.
void set_axis_units(Case& study);

}  // namespace dcnn
