// SPDX-License-Identifier: Apache-2.0
// Logs in JSON: one record a line, a list of records, or lists of numbers by name.
#include "import/json_log.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include "data/line_reader.h"
#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/core/json.h"
#include "import/bytes.h"
#include "import/number_arrays.h"
#include "import/text_cells.h"

namespace dcnn {
namespace {

constexpr std::uint64_t kMostDocument = std::uint64_t{64} << 20;  // as read_json()
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

std::string joined(const std::string& before, const std::string& name) {
  return before.empty() ? name : before + "." + name;
}

/// NaN and Infinity, which Python writes although JSON has none, as null; nothing within quotes.
std::string without_nan(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  bool quoted = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::string_view rest = text.substr(k);
    const std::size_t sign = rest[0] == '-' ? 1 : 0;
    const std::size_t length = rest.substr(sign).starts_with("Infinity") ? sign + 8
                               : rest.starts_with("NaN")                 ? 3
                                                                         : 0;
    if (!quoted && length > 0) {
      clean += "null";
      k += length - 1;
      continue;
    }
    if (quoted && text[k] == '\\' && k + 1 < text.size()) clean += text[k++];
    if (text[k] == '"') quoted = !quoted;
    clean += text[k];
  }
  return clean;
}

Json parsed(std::string_view text, const std::string& place) {
  const bool clean = text.find("NaN") == text.npos && text.find("Infinity") == text.npos;
  return parse_json(clean ? text : std::string_view(without_nan(text)), place, Exit::kData);
}

/// A number, a truth, a missing value, or a text that is a number or a date; none for other texts.
std::optional<double> number_in(const Json& value) {
  if (value.is_null()) return kNoNumber;
  if (value.is_boolean()) return value.get<bool>() ? 1.0 : 0.0;
  if (value.is_number()) return value.get<double>();
  double number = 0.0;
  if (value.is_string() && read_cell(value.get<std::string>(), '.', &number) != CellKind::kText) {
    return number;
  }
  return std::nullopt;
}

/// A record as names and numbers: "wrench.force.x", "position[0]". Texts are left out.
struct Fields {
  std::vector<std::string> names;
  std::vector<double> values;

  void add(const std::string& name, const Json& value) {
    if (value.is_object()) {
      for (const auto& [key, item] : value.items()) add(joined(name, key), item);
    } else if (value.is_array()) {
      for (std::size_t k = 0; k < value.size(); ++k) {
        add(name + "[" + std::to_string(k) + "]", value[k]);
      }
    } else if (const auto number = number_in(value)) {
      names.push_back(name);
      values.push_back(*number);
    }
  }
};

/// Records by the names of their fields: those of one set are one stream.
class Records {
 public:
  explicit Records(std::string name) : name_(std::move(name)) {}

  void add(const Json& record) {
    Fields fields;
    fields.add("", record);
    if (fields.names.empty()) return;
    NumberArray& array = array_of(fields);
    for (std::size_t k = 0; k < fields.values.size(); ++k) {
      array.columns[k].push_back(fields.values[k]);
    }
    ++array.rows;
  }

  void give(LogBuilder& builder) const {
    for (std::size_t k = 0; k < arrays_.size(); ++k) {
      const std::string number = arrays_.size() > 1 ? std::to_string(k + 1) : "";
      add_number_arrays({arrays_[k]}, builder.file_prefix() + name_ + number, builder);
    }
  }

 private:
  NumberArray& array_of(const Fields& fields) {
    const auto [found, is_new] = places_.try_emplace(fields.names, arrays_.size());
    if (is_new) {
      arrays_.push_back({fields.names, std::vector<std::vector<double>>(fields.names.size()), 0});
    }
    return arrays_[found->second];
  }

  std::string name_;
  std::vector<NumberArray> arrays_;
  std::map<std::vector<std::string>, std::size_t> places_;
};

/// A list of numbers, or of lists of numbers of one length; none where it holds anything else.
std::optional<NumberArray> array_in(const std::string& name, const Json& list) {
  const Index width = list[0].is_array() ? static_cast<Index>(list[0].size()) : 1;
  NumberArray array;
  array.rows = static_cast<Index>(list.size());
  array.columns.resize(static_cast<std::size_t>(width));
  for (Index j = 0; j < width; ++j) array.channels.push_back(element_name(name, j, width));
  for (const Json& row : list) {
    const bool is_list = row.is_array();
    if (is_list != list[0].is_array()) return std::nullopt;
    if (is_list && static_cast<Index>(row.size()) != width) return std::nullopt;
    for (std::size_t j = 0; j < array.columns.size(); ++j) {
      const Json& cell = is_list ? row[j] : row;
      const auto number = cell.is_array() || cell.is_object() ? std::nullopt : number_in(cell);
      if (!number) return std::nullopt;
      array.columns[j].push_back(*number);
    }
  }
  return array;
}

/// All lists of a document, at any depth, by their keys.
class Lists {
 public:
  explicit Lists(LogBuilder& builder) : builder_(builder) {}

  void add(const std::string& name, const Json& value) {
    if (value.is_object()) {
      for (const auto& [key, item] : value.items()) add(joined(name, key), item);
    }
    if (!value.is_array() || value.size() < 2) return;
    if (value[0].is_object()) {
      Records& records = records_.emplace_back(name.empty() ? "records" : name);
      for (const Json& record : value) records.add(record);
    } else if (auto array = array_in(name.empty() ? "c" : name, value)) {
      arrays_.push_back(std::move(*array));
    } else {
      builder_.log().notes.push_back(shown(name.empty() ? "the list" : name) +
                                     " holds not only numbers: left out");
    }
  }

  void give() const {
    for (const Records& records : records_) records.give(builder_);
    add_number_arrays(arrays_, "", builder_);
  }

 private:
  LogBuilder& builder_;
  std::vector<Records> records_;
  std::vector<NumberArray> arrays_;
};

/// Whether the first line is a document of its own and another follows.
bool is_lines(const std::filesystem::path& path) {
  constexpr std::uint64_t kLongestRecord = std::uint64_t{1} << 20;  // as LineReader reads
  ByteFile file(path);
  const std::string_view begin = file.take(std::min(file.size(), kLongestRecord));
  const std::size_t end = begin.find('\n');
  if (end == begin.npos) return false;
  const std::string_view rest = begin.substr(end);
  const std::size_t next = rest.find_first_not_of(" \t\r\n");
  if (next == rest.npos || rest[next] != '{') return false;
  try {
    parsed(begin.substr(0, end), file.name());
    return true;
  } catch (const Error&) {
    return false;
  }
}

void read_lines(const std::filesystem::path& path, LogBuilder& builder) {
  LineReader lines(path);
  Records records("records");
  std::string_view line;
  std::optional<std::string> cut;  // what is wrong with a line: of the last one, that it is cut off
  while (lines.next(&line)) {
    if (bare(line).empty()) continue;
    if (cut) fail(Exit::kData, *cut);
    try {
      records.add(parsed(line, lines.place()));
    } catch (const Error& error) {
      cut = error.what();
    }
  }
  if (cut) builder.log().notes.push_back("the last line is cut off: left out");
  records.give(builder);
  builder.log().format = "JSON, a record a line";
}

}  // namespace

bool is_json(std::string_view begin) {
  const auto next = [&] {
    const std::size_t at = begin.find_first_not_of(" \t\r\n");
    if (at == begin.npos) return '\0';
    const char found = begin[at];
    begin.remove_prefix(at + 1);
    return found;
  };
  if (begin.starts_with("\xEF\xBB\xBF")) begin.remove_prefix(3);
  const char first = next();
  if (first == '{') return true;
  if (first != '[') return false;
  const char second = next();
  return second == '{' || second == '[';
}

void read_json_log(const std::filesystem::path& path, LogBuilder& builder) {
  if (is_lines(path)) return read_lines(path, builder);
  ByteFile file(path);
  require(file.size() <= kMostDocument, Exit::kData, file.name(),
          ": is a JSON document of more than 64 MB; write one record a line, or CSV");
  std::string_view text = file.take(file.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Lists lists(builder);
  lists.add("", parsed(text, file.name()));
  lists.give();
  builder.log().format = "JSON";
}

}  // namespace dcnn
