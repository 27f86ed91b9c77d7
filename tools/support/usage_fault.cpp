// SPDX-License-Identifier: Apache-2.0
#include "support/usage_fault.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace dcnn {
namespace {

const OptionRow* row_of(const std::string& name, const std::deque<OptionRow>& rows) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const OptionRow& row) {
    return std::find(row.names.begin(), row.names.end(), name) != row.names.end();
  });
  return found == rows.end() ? nullptr : &*found;
}

/// "--data: At least 2 required but received 1" and "--data: 1 required TEXT missing".
std::string wrong_count(const std::string& words, const std::deque<OptionRow>& rows) {
  const std::string name = words.substr(0, words.find(':'));
  const OptionRow* row = row_of(name, rows);
  if (!row) return words;
  const auto received = words.rfind("received ");
  const std::string given = received == words.npos ? "0" : words.substr(received + 9);
  if (row->count > 1) {
    return name + " takes " + std::to_string(row->count) + " " + row->counted + ", and got " +
           (given == "0" ? "none" : given);
  }
  if (received == words.npos) return name + " needs a value: " + row->usage();
  return name + " is given " + given + " times, and takes one value: " + row->usage();
}

/// "Could not convert: --seed = 1.5".
std::string wrong_number(const std::string& words, const std::deque<OptionRow>& rows) {
  const auto begin = words.find(": "), equal = words.find(" = ");
  if (begin == words.npos || equal == words.npos || equal < begin) return words;
  const std::string name = words.substr(begin + 2, equal - begin - 2);
  const OptionRow* row = row_of(name, rows);
  const bool whole = row && row->value == "N";
  return name + ": '" + words.substr(equal + 3) + "' is " +
         (whole                   ? "not a whole number"
          : row && row->count > 1 ? "not " + std::to_string(row->count) + " " + row->counted
                                  : "not a number");
}

}  // namespace

std::string usage_fault(const CLI::ParseError& error, const std::deque<OptionRow>& rows) {
  const std::string words = error.what();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return wrong_count(words, rows);
  if (dynamic_cast<const CLI::ConversionError*>(&error)) return wrong_number(words, rows);
  const auto between = [&](const std::string& verb) {
    const auto at = words.find(verb);
    return at == words.npos ? std::pair<std::string, std::string>()
                            : std::pair(words.substr(0, at), words.substr(at + verb.size()));
  };
  if (const auto [name, rest] = between(" is required"); !name.empty()) {
    const OptionRow* row = row_of(name, rows);
    return (row ? row->usage() : name) + " is missing";
  }
  if (const auto [one, other] = between(" excludes "); !other.empty()) {
    return one + " and " + other + " exclude one another; give one of them";
  }
  if (const auto [one, other] = between(" requires "); !other.empty()) {
    return one + " needs " + other + " beside it";
  }
  return words;
}

}  // namespace dcnn
