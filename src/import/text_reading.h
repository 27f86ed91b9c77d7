// SPDX-License-Identifier: Apache-2.0
// How the rows of a text are split into cells: found from the rows themselves.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dcnn/import/log.h"

namespace dcnn {

/// One way to read the lines, and how many cells become numbers by it.
struct TextReading {
  char separator = ',', decimal = '.';
  std::size_t cells = 0;
  double numbers = -1e300;  ///< per line: numbers minus twice what is neither number nor missing
  bool pure = false, point = false;
};

/// Cells of a row; an empty one behind the last separator is none, unless it makes `wanted` cells.
std::vector<std::string_view> row_cells(std::string_view line, char separator,
                                        std::size_t wanted = 0);

/// The last lines with digits that are no comments, without what may be a header or is cut off.
std::vector<std::string_view> judged_lines(const std::vector<std::string>& lines);

/// The reading by which most cells are numbers. The Error(kData) of lines without numbers, or of
/// such that may be read in two ways.
TextReading best_reading(const std::vector<std::string>& lines, const TextDialect& given,
                         const std::string& file);

}  // namespace dcnn
