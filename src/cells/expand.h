// SPDX-License-Identifier: Apache-2.0
// A description of cells, written out.
#pragma once

#include <string>
#include <vector>

#include "dcnn/cells/plan.h"

namespace dcnn {

/// Every cell of "commands" with "grid" and "list", or of "cells", without key and inputs' digests
/// (those of "inputs" and of `in/…` are keys of Cell::inputs, their values empty).
std::vector<Cell> expand_cells(const Json& description, const std::string& where,
                               const std::filesystem::path& root);

}  // namespace dcnn
