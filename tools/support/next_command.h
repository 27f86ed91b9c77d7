// SPDX-License-Identifier: Apache-2.0
// The command that goes on from recordings that were imported.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/data/csv.h"

namespace dcnn {

/// Of a tool's recording.
std::string next_of_tool(const Table& table, const std::filesystem::path& recording);

/// Of a machine's axes: of several recordings the last decides nothing.
std::string next_of_axes(const std::filesystem::path& system,
                         const std::vector<std::filesystem::path>& recordings);

}  // namespace dcnn
