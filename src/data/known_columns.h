// SPDX-License-Identifier: Apache-2.0
// Columns that have a meaning.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/system.h"

namespace dcnn {

/// Those that this system gives a meaning to, but for time and pose, which have tests of their own.
std::vector<std::string> known_columns(const System& system);

}  // namespace dcnn
