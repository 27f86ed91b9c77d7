// SPDX-License-Identifier: Apache-2.0
// A recording with some of its rows left out.
#pragma once

#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// Leaves the rows for which `kept` is true, one entry a row; segments without any go.
void keep_rows(Recording& recording, const std::vector<bool>& kept);
/// The same of a recording with a clock, in which the others count as lost: it is split at gaps,
/// and what is too short between two of them goes.
void lose_rows(Recording& recording, const std::vector<bool>& kept);

}  // namespace dcnn
