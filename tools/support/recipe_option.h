// SPDX-License-Identifier: Apache-2.0
// --recipe of a tool that reads recordings as they are otherwise.
#pragma once

#include "support/tool.h"

namespace dcnn {

Option add_recipe_option(Tool& tool, std::optional<std::filesystem::path>& recipe);

/// Every recording of this process is a log that the recipe turns into one.
void read_by_recipe(const std::filesystem::path& file);

}  // namespace dcnn
