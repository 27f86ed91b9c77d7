// SPDX-License-Identifier: Apache-2.0
// What the cells of a plan came to, whoever ran them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/cells/plan.h"

namespace dcnn {

struct MergedCells {
  std::string table;  ///< JSON Lines in the order of keys: name, settings, columns, digests
  std::vector<std::string> missing;   ///< names of cells without a result
  std::vector<std::string> failed;    ///< "NAME: exit 3: COMMAND: last words"
  std::vector<std::string> warnings;  ///< broken packs, cells whose runs contradict each other
};

/// The table is a function of plan and results: no time, engine, order or host is in it.
MergedCells merge_cells(const std::filesystem::path& folder);

/// Whether a file is such a table.
bool is_merged_table(const std::filesystem::path& file);

/// INTO/NAME/FILE for every result, and INTO/NAME/run.json with exit code and times. Files that
/// are there with these bytes are not touched. Error(kUsage) where other bytes are there, unless
/// `replace`.
void unpack_cells(const std::filesystem::path& folder, const std::filesystem::path& into,
                  bool replace);

/// Numbers of cells done, running, failed and not begun; the failed with their command and log;
/// seconds that the rest takes as things go.
Json cells_status(const std::filesystem::path& folder);

}  // namespace dcnn
