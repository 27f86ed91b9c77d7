// The text of JSON: parsed and printed by nlohmann-json, which no other file names.
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "dcnn/core/file.h"
#include "dcnn/core/json.h"

namespace dcnn {
namespace {

using Text = nlohmann::ordered_json;

constexpr int kMaxDepth =
    64;  // the library parses any depth, but its destructor and dump() recurse

/// Refuses what the library would take silently: a key given twice, or nesting that exhausts the
/// stack.
class Strictness {
 public:
  Strictness(const std::string& where, Exit exit) : where_(where), exit_(exit) {}

  bool operator()(int depth, Text::parse_event_t event, Text& parsed) {
    using Event = Text::parse_event_t;
    require(depth <= kMaxDepth, exit_, where_, ": nested deeper than ", kMaxDepth, " levels");
    if (event == Event::object_start) keys_.emplace_back();
    if (event == Event::object_end) keys_.pop_back();
    if (event == Event::key) {
      const auto key = parsed.get<std::string>();
      require(keys_.back().insert(key).second, exit_, where_, ": key '", key,
              "' is given twice; keep one of them");
    }
    return true;
  }

 private:
  std::string where_;
  Exit exit_;
  std::vector<std::set<std::string>> keys_;
};

/// "line 3, column 7: …" from the library's "[json.exception.parse_error.101] parse error at line
/// 3, …".
std::string short_reason(const std::string& what) {
  const auto bracket = what.find("] ");
  return bracket == std::string::npos ? what : what.substr(bracket + 2);
}

Json from_text(const Text& text) {
  switch (text.type()) {
    case Text::value_t::boolean:
      return text.get<bool>();
    case Text::value_t::number_integer:
      return text.get<std::int64_t>();
    case Text::value_t::number_unsigned:
      return text.get<std::uint64_t>();
    case Text::value_t::number_float:
      return text.get<double>();
    case Text::value_t::string:
      return text.get<std::string>();
    case Text::value_t::array: {
      Json list = Json::array();
      for (const Text& item : text) list.push_back(from_text(item));
      return list;
    }
    case Text::value_t::object: {
      Json object = Json::object();
      auto& members = object.items();  // keys are single: no search for each
      for (const auto& [key, item] : text.items()) members.emplace_back(key, from_text(item));
      return object;
    }
    default:
      return nullptr;
  }
}

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

std::string Json::dump(int indent) const {
  try {
    return to_text(*this).dump(indent);
  } catch (const Text::exception& error) {
    throw exception(short_reason(error.what()));
  }
}

Json Json::parse(std::string_view text) {
  try {
    return from_text(Text::parse(text));
  } catch (const Text::exception& error) {
    throw exception(short_reason(error.what()));
  }
}

std::ostream& operator<<(std::ostream& out, const Json& json) { return out << json.dump(); }

Json parse_json(std::string_view text, const std::string& where, Exit exit) {
  // The library takes a NUL for the end of the text and would ignore what follows.
  require(text.find('\0') == text.npos, exit, where, ": has a NUL byte; it is not a JSON text");
  try {
    return from_text(Text::parse(text.begin(), text.end(), Strictness(where, exit)));
  } catch (const Text::exception& error) {
    fail(exit, where, ": ", short_reason(error.what()));
  }
}

Json read_json(const std::filesystem::path& path, Exit exit) {
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
  return parse_json(read_file(path, kMaxBytes, exit), path.string(), exit);
}

}  // namespace dcnn
