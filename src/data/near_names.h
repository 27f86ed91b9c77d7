// SPDX-License-Identifier: Apache-2.0
// Columns that are known under another spelling.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// Error(kData) where a known column is not there, but one that differs from it by case, signs
/// between the letters or a unit in brackets alone ("Fx", "F_x [N]"; "time" for t): what is not
/// recognised would be left out of every result.
void refuse_near_names(const std::vector<std::string>& columns, const System& system,
                       const std::string& file);

}  // namespace dcnn
