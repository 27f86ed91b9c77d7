// JSON as this project reads and writes it: keys keep their order, input is parsed strictly.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "dcnn/core/error.h"

// Compiled once, in src/core/json_instance.cpp: instantiated in every file that touches JSON they
// were a third of the library's object code and of the time to compile it.
extern template class std::vector<nlohmann::ordered_json>;
extern template class nlohmann::basic_json<nlohmann::ordered_map>;
extern template class nlohmann::detail::serializer<nlohmann::ordered_json>;

namespace dcnn {

using Json = nlohmann::ordered_json;

/// Parses one JSON document. Duplicate keys, comments, nesting beyond 64 levels, invalid UTF-8 and
/// trailing text are errors with code `exit`, named by `where` with line and column.
Json parse_json(std::string_view text, const std::string& where, Exit exit);

/// Reads and parses a file of at most 64 MB; a missing or unreadable file is an error with code
/// `exit`.
Json read_json(const std::filesystem::path& path, Exit exit);

}  // namespace dcnn
