// SPDX-License-Identifier: Apache-2.0
// From a log and a recipe to a recording.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/csv.h"
#include "dcnn/import/clock_offset.h"
#include "dcnn/import/recipe.h"

namespace dcnn {

struct Imported {
  Table table;                     ///< columns of a recording, SI
  std::vector<std::string> notes;  ///< rows left out, streams joined, conversions
};

/// Applies `recipe`; what is not as it says is an Error(kData).
Imported assemble(const ForeignLog& log, const Recipe& recipe);

/// Whether every channel that the recipe names was kept when the log was read.
bool holds(const ForeignLog& log, const Recipe& recipe);

/// Of a pose's clock against that of the force, where the two are streams of their own.
struct StreamOffset {
  std::string stream;  ///< whose times would be moved; empty: there is nothing to estimate
  ClockOffset offset;
};
StreamOffset estimate_offset(const ForeignLog& log, const Recipe& recipe, double most_s);

/// "clock of /pose against /wrench: -12.3 ms (95 %: -12.9 to -11.7 ms)".
std::string words_of(const StreamOffset& offset);
/// What a rigid tool leaves of the force at each offset, as an SVG picture.
std::string picture_of(const StreamOffset& offset);

/// Reads and assembles one recording. `path` may name several files, joined by '+', where the
/// recipe is of several.
Imported import_recording(const std::filesystem::path& path, const Recipe& recipe,
                          const ReadLogOptions& options);

/// The paths of "a.csv+b.csv"; a file that exists under the whole name is one path.
std::vector<std::filesystem::path> split_paths(const std::filesystem::path& path);

}  // namespace dcnn
