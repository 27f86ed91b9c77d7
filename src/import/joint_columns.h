// SPDX-License-Identifier: Apache-2.0
// The columns of an arm's joints in a log.
#pragma once

#include <string>
#include <vector>

#include "dcnn/import/assemble.h"

namespace dcnn {

/// Joint angles, rates and torques beside the columns that are `taken`: by their names, in the
/// streams `use` (empty: in all), and those that are counted on from one that was said:
/// tau:1=Joint_1 says what Joint_2 is. Adds questions and notes to `proposal`.
std::vector<ColumnRule> find_joints(const ForeignLog& log, const std::vector<ColumnRule>& taken,
                                    const std::vector<std::string>& use, Proposal* proposal);

}  // namespace dcnn
