// SPDX-License-Identifier: Apache-2.0
#include "import/list_cells.h"

#include <algorithm>
#include <array>

#include "import/text_cells.h"
#include "import/text_layout.h"

namespace dcnn {
namespace {

constexpr std::string_view kOfList = "0123456789+-.eE, \tnaNif[]\n";  // nested ones too

constexpr std::array<bool, 256> characters_of_lists() {
  std::array<bool, 256> table{};
  for (const char c : kOfList) table[static_cast<unsigned char>(c)] = true;
  return table;
}

bool is_of_list(char c) {
  static constexpr std::array<bool, 256> kTable = characters_of_lists();
  return kTable[static_cast<unsigned char>(c)];
}

bool begins_cell(std::string_view line, std::size_t at) {
  while (at > 0 && (line[at - 1] == ' ' || line[at - 1] == '"')) --at;
  return at == 0 || std::string_view(",;\t").find(line[at - 1]) != std::string_view::npos;
}

/// Where the list that begins at `begin` ends, behind its bracket; beyond the line's size where it
/// goes on in the next; `begin` where it is none, or longer than any that is read.
std::size_t list_end(std::string_view line, std::size_t begin) {
  if (begin >= line.size() || line[begin] != '[' || !begins_cell(line, begin)) return begin;
  const std::size_t last = std::min(line.size(), begin + ListCells::kLongest);
  int depth = 0;
  for (std::size_t k = begin; k < last; ++k) {
    if (!is_of_list(line[k])) return begin;
    depth += line[k] == '[' ? 1 : line[k] == ']' ? -1 : 0;
    if (depth == 0) return k + 1;
  }
  return last == line.size() ? last + 1 : begin;
}

std::vector<std::string> elements(std::string_view list) {
  std::vector<std::string> found(1);
  for (const char c : list) {
    if (std::string_view("[], \t\n").find(c) == std::string_view::npos) {
      found.back() += c;
    } else if (!found.back().empty()) {
      found.emplace_back();
    }
  }
  if (found.back().empty()) found.pop_back();
  return found;
}

/// "[N]" is a unit.
bool holds_values(const std::string& list) {
  const std::vector<std::string> all = elements(list);
  return std::none_of(all.begin(), all.end(), [](const std::string& element) {
    double value = 0.0;
    return read_cell(element, '.', &value) == CellKind::kText;
  });
}

/// A cell of a line: a list, or as it is written.
struct Cell {
  std::string_view text;
  bool is_list = false;
};

std::vector<Cell> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  for (std::size_t at = 0;;) {
    std::size_t begin = at;
    while (begin < line.size() && (line[begin] == ' ' || line[begin] == '"')) ++begin;
    const std::size_t end = list_end(line, begin);
    std::size_t next = at;
    if (end > begin && end <= line.size()) {
      cells.push_back({line.substr(begin, end - begin), true});
      next = std::min(line.find(separator, end), line.size());
    } else {
      bool quoted = false;
      for (; next < line.size() && (quoted || line[next] != separator); ++next) {
        if (line[next] == '"') quoted = !quoted;
      }
      cells.push_back({line.substr(at, next - at)});
    }
    if (next >= line.size()) return cells;
    at = next + 1;
  }
}

}  // namespace

std::size_t ListCells::open_from(std::string_view line, std::size_t from) {
  for (std::size_t k = from; k < line.size(); ++k) {
    const std::size_t end = list_end(line, k);
    if (end > line.size()) return k;
    if (end > k) k = end - 1;
  }
  return std::string_view::npos;
}

ListCells::ListCells(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    if (is_aside(line)) continue;
    for (std::size_t k = 0; k < line.size(); ++k) {
      const std::size_t end = list_end(line, k);
      if (end <= k || end > line.size()) continue;
      if (!holds_values(line.substr(k, end - k))) continue;
      // What stands behind a list, or before it, separates cells.
      std::size_t mark = line.find_first_not_of("\" ", end);
      if (mark == std::string::npos && k > 0) mark = line.find_last_not_of("\" ", k - 1);
      if (mark != std::string::npos) separator_ = line[mark];
      for (const Cell& cell : cells_of(line, separator_)) {
        sizes_.push_back(cell.is_list ? elements(cell.text).size() : 0);
      }
      return;
    }
  }
}

std::string ListCells::spread(std::string_view line) const {
  const std::vector<Cell> cells = cells_of(line, separator_);
  const bool whole = cells.size() == sizes_.size();
  std::string text;
  bool first = true;
  const auto add = [&](std::string_view cell) {
    if (!first) text += separator_;
    first = false;
    text += cell;
  };
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (cells[k].is_list) {
      for (const std::string& element : elements(cells[k].text)) add(element);
    } else if (whole && sizes_[k] > 0) {  // a name, or a word for what is missing
      const std::string_view name = bare(cells[k].text);
      double value = 0.0;
      const bool is_name = read_cell(name, '.', &value) == CellKind::kText;
      for (std::size_t i = 0; i < sizes_[k]; ++i) {
        add(is_name ? std::string(name) + "[" + std::to_string(i) + "]" : std::string(name));
      }
    } else {
      add(cells[k].text);
    }
  }
  return text;
}

}  // namespace dcnn
