// SPDX-License-Identifier: Apache-2.0
// The text of JSON: parsed and printed by nlohmann-json, which no other file names.
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "dcnn/core/excerpt.h"
#include "dcnn/core/file.h"
#include "dcnn/core/json.h"

namespace dcnn {
namespace {

using Text = nlohmann::ordered_json;

constexpr std::size_t kMaxDepth = 64;  // destructors and dump() recurse

/// "line 3, column 7: …" from the library's "[json.exception.parse_error.101] parse error at line
/// 3, …".
std::string short_reason(const std::string& what) {
  const auto bracket = what.find("] ");
  return bracket == std::string::npos ? what : what.substr(bracket + 2);
}

/// Builds a document from the library's events, and refuses what its own tree would take silently:
/// a key given twice, and nesting that exhausts the stack. Linear in the text, where that tree
/// searches all members for each key and all items after each list.
class Builder {
 public:
  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(std::int64_t value) { return add(value); }
  bool number_unsigned(std::uint64_t value) { return add(value); }
  bool number_float(double value, const std::string& /*text*/) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(Text::binary_t& /*value*/) { return false; }  // not in a text

  bool start_object(std::size_t /*unknown*/) {
    keys_.emplace_back();
    return open(Json::object());
  }
  bool key(std::string& key) {
    if (!keys_.back().insert(key).second) {
      throw Json::exception("key '" + excerpt(key) + "' is given twice; keep one of them");
    }
    key_ = std::move(key);
    return true;
  }
  bool end_object() {
    keys_.pop_back();
    return end_array();
  }
  bool start_array(std::size_t /*unknown*/) { return open(Json::array()); }
  bool end_array() {
    open_.pop_back();
    return true;
  }
  bool parse_error(std::size_t /*place*/, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) {
    throw Json::exception(excerpt(short_reason(error.what()), 300));
  }

  Json take() { return std::move(root_); }

 private:
  bool add(Json value) {
    place(std::move(value));
    return true;
  }
  bool open(Json value) {
    if (open_.size() == kMaxDepth) {
      throw Json::exception("nested deeper than " + std::to_string(kMaxDepth) + " levels");
    }
    open_.push_back(&place(std::move(value)));
    return true;
  }
  /// Only the innermost list or object grows: pointers to those around it stay valid.
  Json& place(Json value) {
    if (open_.empty()) return root_ = std::move(value);
    Json& parent = *open_.back();
    if (parent.is_object()) {
      return parent.items().emplace_back(std::move(key_), std::move(value)).second;
    }
    parent.push_back(std::move(value));
    return parent.back();
  }

  Json root_;
  std::vector<Json*> open_;
  std::vector<std::set<std::string>> keys_;  // of the objects among them
  std::string key_;
};

Text to_text(const Json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  if (json.is_array()) {
    Text list = Text::array();
    for (const Json& item : json) list.push_back(to_text(item));
    return list;
  }
  if (!json.is_object()) return nullptr;
  Text::object_t members;
  members.reserve(json.size());
  for (const auto& [key, item] : json.items()) {
    static_cast<Text::object_t::Container&>(members).emplace_back(key, to_text(item));
  }
  return members;
}

}  // namespace

/// Names of files may hold any bytes: those that are not UTF-8 become U+FFFD.
std::string Json::dump(int indent) const {
  return to_text(*this).dump(indent, ' ', false, Text::error_handler_t::replace);
}

Json Json::parse(std::string_view text) {
  Builder builder;
  Text::sax_parse(text.begin(), text.end(), &builder);
  return builder.take();
}

std::ostream& operator<<(std::ostream& out, const Json& json) { return out << json.dump(); }

Json parse_json(std::string_view text, const std::string& where, Exit exit) {
  // The library takes a NUL for the end of the text and would ignore what follows.
  require(text.find('\0') == text.npos, exit, where, ": has a NUL byte; it is not a JSON text");
  require(text.find_first_not_of(" \t\r\n") != text.npos, exit, where,
          ": is empty; a JSON document is needed");
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    fail(exit, where, ": ", error.what());
  }
}

Json read_json(const std::filesystem::path& path, Exit exit) {
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
  return parse_json(read_file(path, kMaxBytes, exit), path.string(), exit);
}

}  // namespace dcnn
