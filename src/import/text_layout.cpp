// SPDX-License-Identifier: Apache-2.0
#include "import/text_layout.h"

#include <algorithm>
#include <map>
#include <set>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/roles.h"
#include "import/text_cells.h"

namespace dcnn {
namespace {

using Lines = std::vector<std::string>;
using Cells = std::vector<std::string_view>;

constexpr std::size_t kJudgedLines = 100;

/// One way to read the lines, and how many cells become numbers by it.
struct Reading {
  char separator = ',', decimal = '.';
  std::size_t cells = 0;
  double numbers = -1e300;  ///< per line: numbers minus twice what is neither number nor missing
  bool pure = false, point = false;
};

char separator_of(const std::string& word) {
  if (word == "tab") return '\t';
  if (word == "space") return ' ';
  return word.empty() ? '\0' : word[0];
}

/// Cells of a row; an empty one behind the last separator is none.
Cells row_cells(std::string_view line, char separator, std::size_t wanted = 0) {
  Cells cells;
  split_cells(line, separator, &cells);
  if (cells.size() > 1 && bare(cells.back()).empty() && cells.size() != wanted) cells.pop_back();
  return cells;
}

std::vector<std::string_view> judged(const Lines& lines) {
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

Reading read_as(const std::vector<std::string_view>& rows, char separator, char decimal) {
  Reading reading{separator, decimal};
  // Behind a last separator an empty cell is none, unless other rows have a number there.
  std::size_t widest = 0;
  for (const std::string_view row : rows) {
    widest = std::max(widest, row_cells(row, separator).size());
  }
  std::map<std::size_t, std::size_t> counts;
  double score = 0.0;
  std::size_t texts = 0;
  for (const std::string_view row : rows) {
    const Cells cells = row_cells(row, separator, widest);
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

std::string separator_words(char separator) {
  if (separator == '\t') return "tabs";
  if (separator == ' ') return "blanks";
  return std::string("'") + separator + "'";
}

/// "1,5" may be two whole numbers or one number with a decimal comma.
void refuse_ambiguous(const Reading& best, const std::vector<Reading>& all, std::size_t named,
                      const std::string& file) {
  if (best.separator != ',' || best.point || best.cells == named) return;
  for (const Reading& other : all) {
    if (other.decimal != ',' || !other.pure || other.cells >= best.cells) continue;
    fail(Exit::kData, file, ": reads as ", best.cells, " columns separated by ',' and as ",
         other.cells, " with decimal commas; say which: --separator , or --decimal ,");
  }
}

Reading best_reading(const Lines& lines, const TextDialect& given, const std::string& file) {
  const auto rows = judged(lines);
  require(!rows.empty(), Exit::kData, file, ": holds no rows of numbers");
  std::vector<Reading> all;
  for (const char separator : {'\t', ';', ',', '|', ' '}) {
    if (!given.separator.empty() && separator != separator_of(given.separator)) continue;
    for (const char decimal : {'.', ','}) {
      if (decimal == separator && given.decimal.empty()) continue;
      if (!given.decimal.empty() && decimal != given.decimal[0]) continue;
      all.push_back(read_as(rows, separator, decimal));
    }
  }
  const auto best =
      std::max_element(all.begin(), all.end(),
                       [](const Reading& a, const Reading& b) { return a.numbers < b.numbers; });
  require(best != all.end() && best->numbers > 0.0, Exit::kData, file,
          ": is no text of numbers that is known here: line ", lines.size(), " is ",
          shown(lines.back()), "; see --separator, --decimal and --columns");
  const Cells first = row_cells(lines.front(), best->separator);
  if (given.separator.empty() && given.decimal.empty()) {
    refuse_ambiguous(*best, all, given.columns.empty() ? first.size() : given.columns.size(), file);
  }
  return *best;
}

/// The cells of a line where none of them is a number; a leading comment mark is no part of them.
Cells words_of(std::string_view line, const Reading& reading, std::size_t wanted) {
  while (!line.empty() && (line[0] == '#' || line[0] == '%' || line[0] == ' ')) {
    line.remove_prefix(1);
  }
  for (const char separator : {reading.separator, ',', ';', '\t', ' '}) {
    const Cells cells = row_cells(line, separator, wanted);
    const bool words = std::all_of(cells.begin(), cells.end(), [&](std::string_view cell) {
      double value = 0.0;
      return read_cell(cell, reading.decimal, &value) != CellKind::kNumber;
    });
    if (cells.size() == wanted && words) return cells;
  }
  return {};
}

std::string unit_in(std::string_view cell) {
  cell = bare(cell);
  if (cell.size() > 1 && (cell.front() == '[' || cell.front() == '(')) {
    cell = cell.substr(1, cell.size() - 2);
  }
  return std::string(cell);
}

/// Columns that hold numbers: a cell that is neither number nor missing in half of the judged rows
/// holds text.
std::vector<char> numeric_columns(const Lines& lines, const Reading& reading) {
  std::vector<std::size_t> texts(reading.cells, 0);
  const auto rows = judged(lines);
  for (const std::string_view row : rows) {
    const Cells cells = row_cells(row, reading.separator, reading.cells);
    for (std::size_t k = 0; k < std::min(cells.size(), texts.size()); ++k) {
      double value = 0.0;
      texts[k] += read_cell(cells[k], reading.decimal, &value) == CellKind::kText;
    }
  }
  std::vector<char> numeric;
  for (const std::size_t count : texts) numeric.push_back(2 * count < rows.size());
  return numeric;
}

/// Whether a line above which no row was met is one: it holds numbers, and words in less than half
/// of the columns of numbers. Instruments write settings above their table, `Interval,0.0005`,
/// mostly in fewer cells than that has.
bool is_row(std::string_view line, const Reading& reading, const std::vector<char>& numeric) {
  const Cells cells = row_cells(line, reading.separator, reading.cells);
  std::size_t numbers = 0, texts = 0, columns = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    double value = 0.0;
    const CellKind kind = read_cell(cells[k], reading.decimal, &value);
    const bool of_numbers = cells.size() != numeric.size() || numeric[k] != 0;
    numbers += kind == CellKind::kNumber;
    columns += of_numbers;
    texts += of_numbers && kind == CellKind::kText;
  }
  return numbers > 0 && 2 * texts < columns;
}

/// Whether a line of numbers that has another number of cells than the table stands above it: names
/// of the table's columns come between it and the first row of that many cells.
bool is_setting(const Lines& lines, std::size_t at, const Reading& reading,
                const std::vector<char>& numeric) {
  const auto cells_of = [&](const std::string& line) {
    return row_cells(line, reading.separator, reading.cells).size();
  };
  if (cells_of(lines[at]) == reading.cells) return false;
  for (std::size_t next = at + 1; next < lines.size(); ++next) {
    if (is_aside(lines[next])) continue;
    if (!words_of(lines[next], reading, reading.cells).empty()) return true;
    if (cells_of(lines[next]) == reading.cells && is_row(lines[next], reading, numeric)) break;
  }
  return false;
}

/// How many cells are names of channels that are known.
std::size_t known_names(const Cells& cells) {
  return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [](auto cell) {
    const std::string name(bare(cell));
    return clock_rank(name) > 0 || !role_of({}, name).empty();
  }));
}

/// Names are what stands above the rows: a line without numbers, of several the first of those with
/// most known names, or the last such comment; the last one below it holds units.
void read_heading(const Lines& lines, const Reading& reading, TextLayout* layout) {
  layout->numeric = numeric_columns(lines, reading);

  Cells names, below, comment;
  std::size_t at = 0;
  for (; at < lines.size(); ++at) {
    if (!is_aside(lines[at]) && is_row(lines[at], reading, layout->numeric)) {
      if (!is_setting(lines, at, reading, layout->numeric)) break;
      continue;
    }
    const Cells words = words_of(lines[at], reading, reading.cells);
    if (words.empty()) continue;
    if (is_aside(lines[at])) {
      comment = words;
    } else if (names.empty() || known_names(words) > known_names(names)) {
      names = words;
      below.clear();
    } else {
      below = words;
    }
  }
  layout->first_row = static_cast<Index>(at) + 1;
  if (names.empty()) names = comment;
  layout->headed = !names.empty();
  for (const std::string_view name : names) layout->names.emplace_back(bare(name));
  for (const std::string_view unit : below) layout->units.push_back(unit_in(unit));
}

void make_unique(TextLayout* layout) {
  std::set<std::string> seen;
  for (std::size_t k = 0; k < layout->names.size(); ++k) {
    std::string& name = layout->names[k];
    if (name.empty()) name = "c" + std::to_string(k + 1);
    if (seen.insert(name).second) continue;
    const std::string old = name;
    for (int copy = 2; !seen.insert(name).second; ++copy) name = old + "#" + std::to_string(copy);
    layout->notes.push_back("column " + std::to_string(k + 1) + " is a second " + shown(old) +
                            ": named " + shown(name));
  }
}

void say_what_holds_text(TextLayout* layout) {
  for (std::size_t k = 0; k < layout->names.size(); ++k) {
    if (layout->numeric[k] != 0) continue;
    layout->notes.push_back("column " + shown(layout->names[k]) + " holds text: left out");
  }
}

}  // namespace

std::string TextLayout::words() const {
  return "text, separated by " + separator_words(separator) +
         (decimal == ',' ? ", decimal comma" : "");
}

bool is_aside(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return true;
  line.remove_prefix(first);
  return line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//";
}

TextLayout find_layout(const Lines& lines, const TextDialect& given, const std::string& file,
                       const NextColumns& next) {
  const Reading reading = best_reading(lines, given, file);
  TextLayout layout;
  layout.separator = reading.separator;
  layout.decimal = reading.decimal;
  read_heading(lines, reading, &layout);
  if (!given.columns.empty()) {
    const bool one = given.columns.size() == reading.cells;
    layout.names = one ? given.columns : next(reading.cells);
    require(!layout.names.empty(), Exit::kData, file, ": ", given.columns.size(),
            " names are given for ", reading.cells, " columns (", layout.words(), ")");
    layout.headed = true;
  }
  if (!layout.headed) {
    for (std::size_t k = 1; k <= reading.cells; ++k) {
      layout.names.push_back("c" + std::to_string(k));
    }
    layout.notes.push_back("no line of names above " + std::to_string(reading.cells) +
                           " columns: name them with --columns");
  }
  make_unique(&layout);
  say_what_holds_text(&layout);
  return layout;
}

}  // namespace dcnn
