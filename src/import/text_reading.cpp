// SPDX-License-Identifier: Apache-2.0
#include "import/text_reading.h"

#include <algorithm>
#include <map>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/text_cells.h"
#include "import/text_layout.h"

namespace dcnn {
namespace {

using RowCells = std::vector<std::string_view>;

constexpr std::size_t kJudgedLines = 100;

char separator_of(const std::string& word) {
  if (word == "tab") return '\t';
  if (word == "space") return ' ';
  return word.empty() ? '\0' : word[0];
}

TextReading read_as(const std::vector<std::string_view>& rows, char separator, char decimal) {
  TextReading reading{separator, decimal};
  // Behind a last separator an empty cell is none, unless other rows have a number there.
  std::size_t widest = 0;
  for (const std::string_view row : rows) {
    widest = std::max(widest, row_cells(row, separator).size());
  }
  std::map<std::size_t, std::size_t> counts;
  double score = 0.0;
  std::size_t texts = 0;
  for (const std::string_view row : rows) {
    const RowCells cells = row_cells(row, separator, widest);
    ++counts[cells.size()];
    for (const std::string_view cell : cells) {
      double value = 0.0;
      const CellKind kind = read_cell(cell, decimal, &value);
      texts += kind == CellKind::kText;
      reading.point = reading.point || cell.find('.') != std::string_view::npos;
      score += kind == CellKind::kNumber ? 1.0 : kind == CellKind::kText ? -2.0 : 0.0;
    }
  }
  for (const auto& [cells, count] : counts) {
    if (2 * count >= rows.size()) reading.cells = cells;
  }
  reading.pure = texts == 0 && counts.size() == 1;
  if (reading.cells > 0) reading.numbers = score / static_cast<double>(rows.size());
  return reading;
}

/// Cells of what names the columns: of the first line that is no comment or, where that is a row of
/// numbers already, of the last comment above it.
std::size_t named_cells(const std::vector<std::string>& lines, const TextReading& reading) {
  std::string_view comment;
  for (const std::string& line : lines) {
    if (is_aside(line)) {
      if (!bare(line).empty()) comment = line;
      continue;
    }
    const RowCells cells = row_cells(line, reading.separator);
    const bool row = std::any_of(cells.begin(), cells.end(), [&](std::string_view cell) {
      double value = 0.0;
      return read_cell(cell, reading.decimal, &value) == CellKind::kNumber;
    });
    return row && !comment.empty() ? row_cells(comment, reading.separator).size() : cells.size();
  }
  return 0;
}

/// "1,5" may be two whole numbers or one number with a decimal comma.
void refuse_ambiguous(const TextReading& best, const std::vector<TextReading>& all,
                      std::size_t named, const std::string& file) {
  if (best.separator != ',' || best.point || best.cells == named) return;
  for (const TextReading& other : all) {
    if (other.decimal != ',' || !other.pure || other.cells >= best.cells) continue;
    fail(Exit::kData, file, ": reads as ", best.cells, " columns separated by ',' and as ",
         other.cells, " with decimal commas; say which: --separator , or --decimal ,");
  }
}

}  // namespace

std::vector<std::string_view> row_cells(std::string_view line, char separator, std::size_t wanted) {
  RowCells cells;
  split_cells(line, separator, &cells);
  if (cells.size() > 1 && bare(cells.back()).empty() && cells.size() != wanted) cells.pop_back();
  return cells;
}

std::vector<std::string_view> judged_lines(const std::vector<std::string>& lines) {
  std::vector<std::string_view> rows;
  for (auto line = lines.rbegin(); line != lines.rend() && rows.size() < kJudgedLines; ++line) {
    const bool digits = line->find_first_of("0123456789") != std::string::npos;
    if (digits && !is_aside(*line)) rows.push_back(*line);
  }
  // The first line of a file may be a header.
  if (rows.size() > 1) rows.pop_back();
  if (rows.size() > 2) rows.erase(rows.begin());  // the last may be cut off
  return rows;
}

TextReading best_reading(const std::vector<std::string>& lines, const TextDialect& given,
                         const std::string& file) {
  const auto rows = judged_lines(lines);
  require(!rows.empty(), Exit::kData, file, ": holds no rows of numbers");
  std::vector<TextReading> all;
  for (const char separator : {'\t', ';', ',', '|', ' '}) {
    if (!given.separator.empty() && separator != separator_of(given.separator)) continue;
    for (const char decimal : {'.', ','}) {
      if (decimal == separator && given.decimal.empty()) continue;
      if (!given.decimal.empty() && decimal != given.decimal[0]) continue;
      all.push_back(read_as(rows, separator, decimal));
    }
  }
  const auto best = std::max_element(
      all.begin(), all.end(),
      [](const TextReading& a, const TextReading& b) { return a.numbers < b.numbers; });
  require(best != all.end() && best->numbers > 0.0, Exit::kData, file,
          ": is no text of numbers that is known here: line ", lines.size(), " is ",
          shown(lines.back()), "; see --separator, --decimal and --columns");
  if (given.separator.empty() && given.decimal.empty()) {
    refuse_ambiguous(
        *best, all, given.columns.empty() ? named_cells(lines, *best) : given.columns.size(), file);
  }
  return *best;
}

}  // namespace dcnn
