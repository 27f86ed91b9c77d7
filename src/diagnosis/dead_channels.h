// SPDX-License-Identifier: Apache-2.0
// Channels that read one number whatever the machine does: no law explains them.
#pragma once

#include "diagnosis/case.h"

namespace dcnn {

/// Error(kData) that names the recording and the column where a measured channel is one and the
/// same number in every row while what is simulated for it, or an axis, moves.
void refuse_dead_channels(const Case& study);

}  // namespace dcnn
