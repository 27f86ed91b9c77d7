// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>

#include "data/text.h"
#include "dcnn/core/file.h"
#include "dcnn/core/parallel.h"
#include "dcnn/data/csv.h"

namespace dcnn {

void write_csv(const std::filesystem::path& path, const Table& table) {
  constexpr std::size_t kLongest = 25;  // of the shortest round-trip decimals, with the separator
  std::string text;
  for (const std::string& name : table.columns) (text += name) += ',';
  if (!text.empty()) text.back() = '\n';
  for (Index row = 0; row < table.values.rows(); ++row) {
    const std::size_t before = text.size();
    text.resize(before + kLongest * table.columns.size());
    char* out = text.data() + before;
    for (Index column = 0; column < table.values.cols(); ++column) {
      const double value = table.values(row, column);
      if (!std::isfinite(value)) {  // words are made for a message only
        fail(Exit::kFailure, path.string(), ": column ",
             shown(table.columns[static_cast<std::size_t>(column)]), " is not finite in row ",
             row + 1);
      }
      out = std::to_chars(out, out + kLongest, value).ptr;
      *out++ = ',';
    }
    out[-1] = '\n';
    text.resize(static_cast<std::size_t>(out - text.data()));
  }
  write_file(path, text);
}

}  // namespace dcnn
