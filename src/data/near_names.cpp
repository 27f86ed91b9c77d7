// SPDX-License-Identifier: Apache-2.0
#include "data/near_names.h"

#include <algorithm>
#include <cctype>

#include "data/known_columns.h"
#include "data/text.h"
#include "dcnn/core/error.h"

namespace dcnn {
namespace {

/// Letters and digits alone, in lower case; what is in brackets is a unit.
std::string folded(const std::string& name) {
  std::string text;
  for (const char c : name.substr(0, name.find_first_of("[("))) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) text += static_cast<char>(std::tolower(byte));
  }
  return text;
}

bool is_near(const std::string& name, const std::string& known) {
  const std::string text = folded(name);
  return text == folded(known) ||
         (known == "t" && (text == "time" || text == "times" || text == "timestamp"));
}

}  // namespace

void refuse_near_names(const std::vector<std::string>& columns, const System& system,
                       const std::string& file) {
  const auto is_there = [&](const std::string& name) {
    return std::find(columns.begin(), columns.end(), name) != columns.end();
  };
  std::vector<std::string> known = known_columns(system);
  known.emplace_back("t");
  if (system.kind == System::Kind::kWrist) {
    known.insert(known.end(), {"x", "y", "z", "alpha", "beta", "gamma", "qw", "qx", "qy", "qz"});
  }
  for (const std::string& column : columns) {
    if (std::find(known.begin(), known.end(), column) != known.end()) continue;
    for (const std::string& name : known) {
      if (name.empty() || is_there(name) || !is_near(column, name)) continue;
      fail(
          Exit::kData, file, ":1: column ", shown(column), ": did you mean ", name,
          "? read the log with dcnn-import, which turns units; or rename it, if it is in SI units");
    }
  }
}

}  // namespace dcnn
