// SPDX-License-Identifier: Apache-2.0
// Cells that hold a list of numbers, as NumPy and pandas write them: "[0.1 0.2 0.3]".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

class ListCells {
 public:
  static constexpr std::size_t kLongest = std::size_t{1} << 14;  ///< bytes of one list
  /// Where the first list at `from` or behind it begins that does not end in this line, but goes on
  /// in the next one; npos without one.
  static std::size_t open_from(std::string_view line, std::size_t from = 0);

  /// From the first lines of a text; without a list in them it does nothing.
  explicit ListCells(const std::vector<std::string>& lines);

  bool found() const { return !sizes_.empty(); }
  /// The line with each element of its lists as a cell of its own; of names with as many: name[0],
  /// name[1], …
  std::string spread(std::string_view line) const;

 private:
  char separator_ = ',';
  std::vector<std::size_t> sizes_;  // elements by cell of a line, 0 of one that is no list
};

}  // namespace dcnn
