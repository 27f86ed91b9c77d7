#include "dcnn/core/json.h"

#include <set>
#include <vector>

#include "dcnn/core/file.h"

namespace dcnn {
namespace {

constexpr int kMaxDepth =
    64;  // the library parses any depth, but its destructor and dump() recurse

/// Refuses what the library would take silently: a key given twice, or nesting that exhausts the
/// stack.
class Strictness {
 public:
  Strictness(const std::string& where, Exit exit) : where_(where), exit_(exit) {}

  bool operator()(int depth, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
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

}  // namespace

Json parse_json(std::string_view text, const std::string& where, Exit exit) {
  // The library takes a NUL for the end of the text and would ignore what follows.
  require(text.find('\0') == text.npos, exit, where, ": has a NUL byte; it is not a JSON text");
  try {
    return Json::parse(text.begin(), text.end(), Strictness(where, exit));
  } catch (const Json::exception& error) {
    fail(exit, where, ": ", short_reason(error.what()));
  }
}

Json read_json(const std::filesystem::path& path, Exit exit) {
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
  return parse_json(read_file(path, kMaxBytes, exit), path.string(), exit);
}

}  // namespace dcnn
