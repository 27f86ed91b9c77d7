// SPDX-License-Identifier: Apache-2.0
// Numbers of an evaluation's table, in text and on the page.
#pragma once

#include <string>
#include <vector>

#include "dcnn/experiment/evaluate.h"

namespace dcnn {

/// Decimals of each target's column and, last, of the mean over targets: three digits of the least.
std::vector<int> column_decimals(const Evaluation& evaluation);

/// "0.116 ± 0.002"; one draw has no spread.
std::string with_spread(const Spread& spread, int runs, int decimals);

}  // namespace dcnn
