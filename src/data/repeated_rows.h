// SPDX-License-Identifier: Apache-2.0
// Single rows in which a reading did not arrive in time, and the one before was written again.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// Leaves out the rows in which all these columns, two at least, repeat the row before, and notes
/// so, where chance makes few of them: channels apart repeat by the steps of their rounding, all at
/// once as often as the product of their shares says, in each stretch of 64 rows. What is left out
/// counts as lost; more than half of a recording stays.
void leave_out_repeats(Recording& recording, const std::vector<std::string>& columns);

}  // namespace dcnn
