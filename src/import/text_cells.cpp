// SPDX-License-Identifier: Apache-2.0
#include "import/text_cells.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>

namespace dcnn {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Where the cell that begins at `begin` ends: the next separator outside quotes.
std::size_t cell_end(std::string_view line, std::size_t begin, char separator) {
  bool quoted = false;
  for (std::size_t k = begin; k < line.size(); ++k) {
    if (line[k] == '"') quoted = !quoted;
    if (quoted) continue;
    if (separator == ' ' ? is_blank(line[k]) : line[k] == separator) return k;
  }
  return line.size();
}

bool is_missing_word(std::string_view text) {
  std::string word(text);
  std::transform(word.begin(), word.end(), word.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.erase(0, 1);
  constexpr std::array<std::string_view, 11> kWords = {
      "", "nan", "nan(ind)", "nan(snan)", "1.#ind", "1.#qnan", "na", "n/a", "#n/a", "null", "none"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

bool whole_number(std::string_view text, double* value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(*value);
}

/// With a decimal comma: exactly one, between digits.
bool comma_number(std::string_view text, double* value) {
  constexpr std::size_t kLongest = 64;
  if (text.size() > kLongest || text.find('.') != std::string_view::npos) return false;
  std::array<char, kLongest> digits{};
  std::copy(text.begin(), text.end(), digits.begin());
  if (const std::size_t comma = text.find(','); comma != std::string_view::npos) {
    const auto digit = [&](std::size_t k) {
      return k < text.size() && text[k] >= '0' && text[k] <= '9';
    };
    if (comma == 0 || !digit(comma - 1) || !digit(comma + 1)) return false;
    digits[comma] = '.';
  }
  return whole_number({digits.data(), text.size()}, value);
}

/// `count` digits at the beginning of `text`, which loses them; -1 where they are none.
int take_digits(std::string_view* text, std::size_t count) {
  if (text->size() < count) return -1;
  int value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + count, value);
  if (error != std::errc() || end != text->data() + count || value < 0) return -1;
  text->remove_prefix(count);
  return value;
}

bool take(std::string_view* text, char c) {
  if (text->empty() || text->front() != c) return false;
  text->remove_prefix(1);
  return true;
}

/// Days since 1970 of "2023-04-01", "2023/04/01", "01.04.2023" or "01/04/2023" (the day before the
/// month where both may be) and the mark behind, which it loses.
std::optional<double> take_date(std::string_view* text) {
  constexpr std::size_t kDate = 10;  // characters
  if (text->size() < kDate + 6) return std::nullopt;
  const bool year_first = std::string_view("-/.").find((*text)[4]) != std::string_view::npos;
  const char mark = (*text)[year_first ? 4 : 2];
  if (std::string_view("-/.").find(mark) == std::string_view::npos) return std::nullopt;
  const int first = take_digits(text, year_first ? 4 : 2);
  const int second = take(text, mark) ? take_digits(text, 2) : -1;
  const int third = take(text, mark) ? take_digits(text, year_first ? 2 : 4) : -1;
  if (!take(text, 'T') && !take(text, ' ')) return std::nullopt;
  int year = year_first ? first : third, day = year_first ? third : first, month = second;
  if (!year_first && month > 12) std::swap(day, month);
  if (year < 1 || month < 1 || day < 1) return std::nullopt;
  const auto date = std::chrono::year(year) / month / day;
  if (!date.ok()) return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

/// Seconds east of UTC of "Z", "+02:00", "+0200" or nothing.
std::optional<int> zone_seconds(std::string_view text) {
  if (text.empty() || text == "Z" || text == "z" || text == " UTC") return 0;
  const int sign = text[0] == '-' ? -1 : 1;
  if (text[0] != '+' && text[0] != '-') return std::nullopt;
  text.remove_prefix(1);
  const int hours = take_digits(&text, 2);
  take(&text, ':');
  const int minutes = text.empty() ? 0 : take_digits(&text, 2);
  if (hours < 0 || minutes < 0 || !text.empty()) return std::nullopt;
  return sign * (hours * 3600 + minutes * 60);
}

}  // namespace

void split_cells(std::string_view line, char separator, std::vector<std::string_view>* cells) {
  cells->clear();
  if (separator != ';') {
    const std::size_t last = line.find_last_not_of(" \t\r");
    if (last != line.npos && line[last] == ';') line = line.substr(0, last);
  }
  for (std::size_t begin = 0;;) {
    if (separator == ' ') {
      while (begin < line.size() && is_blank(line[begin])) ++begin;
      if (begin == line.size()) return;
    }
    const std::size_t end = cell_end(line, begin, separator);
    cells->push_back(line.substr(begin, end - begin));
    if (end == line.size()) return;
    begin = end + 1;
  }
}

std::string_view bare(std::string_view cell) {
  const auto strip = [&](auto drop) {
    while (!cell.empty() && drop(cell.front())) cell.remove_prefix(1);
    while (!cell.empty() && drop(cell.back())) cell.remove_suffix(1);
  };
  strip(is_blank);
  strip([](char c) { return c == '"' || c == '\''; });
  strip(is_blank);
  return cell;
}

std::optional<double> clock_seconds(std::string_view text) {
  std::optional<double> days = 0.0;  // since 1970
  if (text.size() < 3) return std::nullopt;
  if (text[2] != ':' && text[1] != ':') days = take_date(&text);
  if (!days) return std::nullopt;
  const int hour = take_digits(&text, text.size() > 1 && text[1] == ':' ? 1 : 2);
  const int minute = take(&text, ':') ? take_digits(&text, 2) : -1;
  double seconds = 0.0;
  // "10:30" alone may be a ratio.
  if (*days == 0.0 && (text.empty() || text.front() != ':')) return std::nullopt;
  if (take(&text, ':')) {
    const std::size_t size = std::min(text.find_first_not_of("0123456789.,"), text.size());
    if (!comma_number(text.substr(0, size), &seconds) &&
        !whole_number(text.substr(0, size), &seconds)) {
      return std::nullopt;
    }
    text.remove_prefix(size);
  }
  const auto zone = zone_seconds(text);
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59 || !(seconds < 61.0) || !zone) {
    return std::nullopt;
  }
  return *days * 86400.0 + hour * 3600.0 + minute * 60.0 + seconds - *zone;
}

CellKind read_cell(std::string_view cell, char decimal, double* value) {
  const std::string_view text = bare(cell);
  if (decimal == '.' ? whole_number(text, value) : comma_number(text, value)) {
    return CellKind::kNumber;
  }
  *value = kMissing;
  if (is_missing_word(text)) return CellKind::kMissing;
  const std::string_view digits = text.substr(!text.empty() && (text[0] == '-' || text[0] == '+'));
  if (digits == "inf" || digits == "Inf" || digits == "INF") return CellKind::kMissing;
  if (const auto seconds = clock_seconds(text)) {
    *value = *seconds;
    return CellKind::kNumber;
  }
  return CellKind::kText;
}

}  // namespace dcnn
