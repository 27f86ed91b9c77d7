// SPDX-License-Identifier: Apache-2.0
// Where a simulator and recordings differ, before anything is named.
#pragma once

#include "dcnn/core/json.h"
#include "diagnosis/search.h"

namespace dcnn {

/// `where` of the report: axes, segments, regimes, bands of what the simulator as given leaves.
Json locate(const Case& study, const Signals& left, const std::vector<Floor>& floors);

}  // namespace dcnn
