// SPDX-License-Identifier: Apache-2.0
// The dialect of a text of numbers, found from its first lines.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dcnn/import/log.h"

namespace dcnn {

struct TextLayout {
  char separator = ',', decimal = '.';  ///< ' ': runs of blanks
  std::vector<std::string> names;       ///< of every cell of a line, unique
  std::vector<std::string> units;       ///< from a line of units, empty where there is none
  std::vector<char> numeric;            ///< whether a cell holds numbers; others are left out
  Index first_row = 1;                  ///< line of the first row of numbers, from 1
  bool headed = true;                   ///< false: names are c1, c2, …
  std::vector<std::string> notes;

  /// "text, separated by ';', decimal comma".
  std::string words() const;
};

/// A line that holds no row: blank or a comment (#, %, //).
bool is_aside(std::string_view line);

/// The names of a text's `count` columns where those that are given are of several texts in their
/// order; empty where too few are left.
using NextColumns = std::function<std::vector<std::string>(std::size_t count)>;

/// From the first lines of a file (without line ends, byte order mark removed). What two dialects
/// could have written is an Error(kData) that asks.
TextLayout find_layout(const std::vector<std::string>& lines, const TextDialect& given,
                       const std::string& file, const NextColumns& next);

}  // namespace dcnn
