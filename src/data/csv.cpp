// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/csv.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <string_view>

#include "data/line_reader.h"
#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/core/parallel.h"

namespace dcnn {
namespace {

constexpr std::size_t kMaxColumns = 100000;

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(line.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return cells;
    begin = comma + 1;
  }
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// A decimal number that fills the whole text.
bool parse_number(std::string_view text, double* value) {
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
  return error == std::errc() && rest == text.data() + text.size() && std::isfinite(*value);
}

/// As above, with spaces around and a leading '+' allowed.
bool parse_kindly(std::string_view text, double* value) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return parse_number(text, value);
}

/// What no text encoding or CSV dialect of ours begins with.
void check_encoding(std::string_view line, const std::string& place) {
  const auto reject = [&](std::string_view bytes, const char* fault) {
    require(line.substr(0, bytes.size()) != bytes, Exit::kData, place, ": ", fault);
  };
  reject("\xFF\xFE", "is UTF-16 text; save as UTF-8");
  reject("\xFE\xFF", "is UTF-16 text; save as UTF-8");
  reject("\x1F\x8B", "is gzip-compressed; unpack it first");
  for (const std::string_view other : {"\x89MCAP", "#ROSBAG", "SQLite format 3", "\x93NUMPY",
                                       "MATLAB 5.0", "\x89HDF", "PK\x03\x04"}) {
    reject(other, "is a log of another format; dcnn-import makes recordings of it");
  }
  require(line.find('\0') == std::string_view::npos, Exit::kData, place,
          ": contains a NUL byte; save as plain UTF-8 text (this is UTF-16 or a binary file)");
  require(is_utf8(line), Exit::kData, place, ": is not UTF-8 text; save as UTF-8");
}

// Other dialects of text are read by dcnn-import.
constexpr const char* kToImport = "; dcnn-import makes a recording of such a text";

void check_separator(std::string_view line, const std::string& place) {
  const bool comma = contains(line, ",");
  require(comma || !contains(line, ";"), Exit::kData, place, ": columns are separated by ';'",
          kToImport);
  require(comma || !contains(line, "\t"), Exit::kData, place, ": columns are separated by tabs",
          kToImport);
  require(comma || !contains(trimmed(line), " "), Exit::kData, place,
          ": columns are separated by spaces", kToImport);
  require(!contains(line, "\""), Exit::kData, place, ": quotes are not accepted", kToImport);
  require(!contains(line, "\r"), Exit::kData, place,
          ": carriage return inside the line; end lines with \\n or \\r\\n");
}

std::vector<std::string> parse_header(std::string_view line, const std::string& place) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of UTF-8, as spreadsheets write
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  check_encoding(line, place);
  require(!trimmed(line).empty(), Exit::kData, place,
          ": the first line is blank; begin with a header row of column names");
  check_separator(line, place);
  const auto cells = split(line);
  require(cells.size() <= kMaxColumns, Exit::kData, place, ": more than ", kMaxColumns, " columns");
  std::vector<std::string> names;
  std::set<std::string_view> seen;
  bool numbers = true;
  for (const std::string_view cell : cells) {
    const std::string_view name = trimmed(cell);
    const std::size_t number = names.size() + 1;
    require(!name.empty(), Exit::kData, place, ": column ", number, " has no name; give it one");
    require(seen.insert(name).second, Exit::kData, place, ": column ", shown(name), " (number ",
            number, ") is there twice; rename or remove one");
    double ignored = 0.0;
    numbers = numbers && parse_kindly(name, &ignored);
    names.emplace_back(name);
  }
  require(!numbers, Exit::kData, place,
          ": there is no header row, only numbers; put the column names in the first line, or give "
          "them to dcnn-import --columns");
  return names;
}

/// Why the cell is no number, and what to do.
std::string fault_of(std::string_view cell) {
  const std::string_view text = trimmed(cell);
  if (text.empty()) return "is empty; write a number or remove the row";
  const std::string found = ": " + shown(text);
  if (contains(text, std::string_view("\0", 1))) return "contains a NUL byte; the file is damaged";
  if (contains(text, "\"") || contains(text, "'")) return "is quoted" + found + kToImport;
  if (contains(text, ";")) return "contains ';'" + found + kToImport;
  if (contains(text, "\t")) return "contains a tab" + found + kToImport;
  double value = 0.0;
  const std::string_view digits =
      text[0] == '+' && text.substr(0, 2) != "+-" ? text.substr(1) : text;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = rest == digits.data() + digits.size() && error != std::errc::invalid_argument;
  const bool has_digit = text.find_first_of("0123456789") != std::string_view::npos;
  if (whole && has_digit && !contains(text, "(")) {
    return "is out of range" + found + "; a number must lie within those of double precision";
  }
  if (rest != digits.data() && !has_digit) {
    return "is not finite" + found + "; remove the row or repair the log";
  }
  if (contains(text, "0x") || contains(text, "0X")) {
    return "is hexadecimal" + found + "; write it as a decimal number";
  }
  return "is not a number" + found + "; write a decimal number such as -1.5e-3";
}

/// The way of nearly every cell: a plain decimal whose digits and power of ten are exact doubles,
/// so that one division rounds correctly (Clinger 1990). Gives where it ends, or null for any other
/// cell.
const char* plain_decimal(const char* p, const char* end, double* value) {
  static constexpr double kPowers[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                       1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  constexpr std::ptrdiff_t kDigits = 15;  // below 2^53
  const bool negative = p != end && *p == '-';
  p += negative;
  const char* const first = p;
  std::uint64_t digits = 0;
  const auto take_digits = [&] {
    for (; p != end && *p >= '0' && *p <= '9'; ++p) {
      digits = 10 * digits + static_cast<std::uint64_t>(*p - '0');
    }
  };
  take_digits();
  const char* const point = p;
  if (p == first || p - first > kDigits) return nullptr;
  if (p != end && *p == '.') ++p, take_digits();
  if (p - first > kDigits + 1 || (p != end && *p != ',')) return nullptr;
  const std::ptrdiff_t decimals = p == point ? 0 : p - point - 1;
  const double magnitude = static_cast<double>(digits) / kPowers[decimals];
  *value = negative ? -magnitude : magnitude;
  return p;
}

/// Reads the rows of one file into blocks of rows, which never move and are turned into columns
/// while the cache holds them.
class Rows {
 public:
  Rows(const LineReader& reader, const std::vector<std::string>& columns)
      : reader_(reader), columns_(columns) {}

  void add(std::string_view line) {
    const Index row = count_++ % kBlockRows;
    if (row == 0) {
      blocks_.emplace_back(new double[static_cast<std::size_t>(kBlockRows) * columns_.size()]);
    }
    double* cell = blocks_.back().get() + static_cast<std::size_t>(row) * columns_.size();
    const char* begin = line.data();
    const char* const end = begin + line.size();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const char* next = plain_decimal(begin, end, &cell[k]);
      if (next == nullptr) next = any_cell(line, begin, k, &cell[k]);
      const bool last = k + 1 == columns_.size();
      if ((next == end) != last) fail_ragged(line);
      begin = next + 1;
    }
  }

  Eigen::MatrixXd values() const {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto columns = static_cast<Index>(columns_.size());
    Eigen::MatrixXd values(count_, columns);
    for (Index begin = 0; begin < count_; begin += kBlockRows) {
      const Index rows = std::min(kBlockRows, count_ - begin);
      const double* block = blocks_[static_cast<std::size_t>(begin / kBlockRows)].get();
      values.middleRows(begin, rows) = Eigen::Map<const RowMajor>(block, rows, columns);
    }
    return values;
  }
  bool empty() const { return count_ == 0; }

 private:
  /// The cell from `begin` on where it is no plain decimal: exponents, spaces and '+', or an error.
  const char* any_cell(std::string_view line, const char* begin, std::size_t k,
                       double* value) const {
    const std::string_view rest = line.substr(static_cast<std::size_t>(begin - line.data()));
    const std::string_view cell = rest.substr(0, rest.find(','));
    if (!parse_number(cell, value) && !parse_kindly(cell, value)) {
      check_count(line);
      fail(Exit::kData, reader_.place(), ": column ", shown(columns_[k]), " ", fault_of(cell),
           " (column ", k + 1, " of ", columns_.size(), ")");
    }
    return begin + cell.size();
  }

  void check_count(std::string_view line) const {
    const std::size_t count = split(line).size();
    const std::size_t wanted = columns_.size();
    if (count == wanted) return;
    if (count == 1 && contains(line, ";")) check_separator(line, reader_.place());
    if (count == 1 && contains(line, "\t")) check_separator(line, reader_.place());
    const bool commas = count == 2 * wanted || count == 2 * wanted - 1;  // t may be a whole number
    fail(Exit::kData, reader_.place(), ": ", count, " cells where the header has ", wanted,
         " columns",
         commas ? "; decimal commas? write decimals with '.', or read the log with dcnn-import"
                : "; repair or remove this row");
  }
  [[noreturn]] void fail_ragged(std::string_view line) const {
    check_count(line);
    fail(Exit::kFailure, reader_.place(), ": cannot count the cells of this row");
  }

  const LineReader& reader_;
  const std::vector<std::string>& columns_;
  static constexpr Index kBlockRows = 512;
  Index count_ = 0;
  std::vector<std::unique_ptr<double[]>> blocks_;
};

}  // namespace

Table read_csv(const std::filesystem::path& path) {
  LineReader reader(path);
  std::string_view line;
  require(reader.next(&line), Exit::kData, reader.name(),
          ": is empty; a recording is a header row and one row per sample");
  Table table;
  table.columns = parse_header(line, reader.place());
  Rows rows(reader, table.columns);
  Index blank = 0;  // blank lines are accepted at the end only
  while (reader.next(&line)) {
    if (trimmed(line).empty()) {
      if (blank == 0) blank = reader.number();
      continue;
    }
    if (blank != 0) {
      fail(Exit::kData, reader.place(blank), ": blank line between rows; remove it");
    }
    rows.add(line);
  }
  require(!rows.empty(), Exit::kData, reader.name(), ": has a header row but no samples");
  table.values = rows.values();
  return table;
}

}  // namespace dcnn
