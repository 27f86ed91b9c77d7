// SPDX-License-Identifier: Apache-2.0
#include "import/text_layout.h"

#include <algorithm>
#include <set>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/roles.h"
#include "import/text_cells.h"
#include "import/text_reading.h"
#include "import/units.h"

namespace dcnn {
namespace {

using Lines = std::vector<std::string>;
using Cells = std::vector<std::string_view>;

std::string separator_words(char separator) {
  if (separator == '\t') return "tabs";
  if (separator == ' ') return "blanks";
  return std::string("'") + separator + "'";
}

/// The cells of a line where none of them is a number; a leading comment mark is no part of them.
Cells words_of(std::string_view line, const TextReading& reading, std::size_t wanted) {
  while (!line.empty() && (line[0] == '#' || line[0] == '%' || line[0] == ' ')) {
    line.remove_prefix(1);
  }
  if (line.starts_with("//")) line.remove_prefix(2);
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
std::vector<char> numeric_columns(const Lines& lines, const TextReading& reading) {
  std::vector<std::size_t> texts(reading.cells, 0);
  const auto rows = judged_lines(lines);
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
bool is_row(std::string_view line, const TextReading& reading, const std::vector<char>& numeric) {
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
bool is_setting(const Lines& lines, std::size_t at, const TextReading& reading,
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

/// Names of columns, and the line below them that may hold their units.
struct Heading {
  Cells names, below;
};

/// Whether each cell that is not empty is a unit.
bool are_units(const Cells& cells) {
  return std::all_of(cells.begin(), cells.end(), [](std::string_view cell) {
    return bare(cell).empty() || find_unit(unit_in(cell)).has_value();
  });
}

/// Of several comments the last of those with most known names has the names, units below them set
/// apart; others are remarks.
void read_comment(const Cells& words, Heading* heading) {
  const bool first = heading->names.empty();
  if (!first && are_units(words) && !are_units(heading->names)) {
    heading->below = words;
  } else if (first || known_names(words) >= known_names(heading->names)) {
    *heading = {words, {}};
  }
}

/// Names are what stands above the rows: a line without numbers, of several the first of those with
/// most known names, or such a comment; the last one below it holds units.
void read_heading(const Lines& lines, const TextReading& reading, TextLayout* layout) {
  layout->numeric = numeric_columns(lines, reading);
  Heading heading, comment;
  std::size_t at = 0;
  for (; at < lines.size(); ++at) {
    if (!is_aside(lines[at]) && is_row(lines[at], reading, layout->numeric)) {
      if (!is_setting(lines, at, reading, layout->numeric)) break;
      continue;
    }
    const Cells words = words_of(lines[at], reading, reading.cells);
    if (words.empty()) continue;
    if (is_aside(lines[at])) {
      read_comment(words, &comment);
    } else if (heading.names.empty() || known_names(words) > known_names(heading.names)) {
      heading = {words, {}};
    } else {
      heading.below = words;
    }
  }
  layout->first_row = static_cast<Index>(at) + 1;
  if (heading.names.empty()) heading = comment;
  layout->headed = !heading.names.empty();
  for (const std::string_view name : heading.names) layout->names.emplace_back(bare(name));
  for (const std::string_view unit : heading.below) layout->units.push_back(unit_in(unit));
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
  const TextReading reading = best_reading(lines, given, file);
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
