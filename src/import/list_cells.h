// Cells that hold a list of numbers, as NumPy and pandas write them: "[0.1 0.2 0.3]".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

class ListCells {
 public:
  /// Whether a list that begins in this line does not end in it: it goes on in the next one.
  static bool is_open(std::string_view line);

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
