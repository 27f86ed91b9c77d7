// SPDX-License-Identifier: Apache-2.0
// Where read_recording() gets the columns of a file from.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dcnn/data/csv.h"

namespace dcnn {

/// Columns in SI as a recording has them, and what was changed on the way, for every report.
struct SourceTable {
  Table table;
  std::vector<std::string> notes;
  bool zeroed = false;  ///< as Recording::zeroed
};

using TableReader = std::function<SourceTable(const std::filesystem::path&)>;

/// From now on every recording of this process is read so (--recipe); empty: by read_csv(). To be
/// called before any recording is read.
void set_table_reader(TableReader reader);

SourceTable read_table(const std::filesystem::path& path);

}  // namespace dcnn
