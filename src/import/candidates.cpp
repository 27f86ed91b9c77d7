// SPDX-License-Identifier: Apache-2.0
#include "import/candidates.h"

#include <algorithm>
#include <cctype>

#include "data/text.h"
#include "import/roles.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostDigits = 6;

std::size_t common_beginning(const std::string& a, const std::string& b) {
  const auto ends = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<std::size_t>(ends.first - a.begin());
}

bool holds_numbers(const LogStream& stream, const std::string& channel) {
  const Index at = stream.find(channel);
  return at >= 0 && stream.channels[static_cast<std::size_t>(at)].finite > 0;
}

/// The channel that is called like `channel` but for a letter or the last number, `steps` further
/// on: y after x, b after a, 4 after 3; of four components w, x, y, z. Empty where there is none.
std::string channel_after(const LogStream& stream, const std::string& channel, Index steps,
                          std::size_t components) {
  const auto from = counted(channel);
  if (from) {
    const std::string name = from->before + std::to_string(from->number + steps) + from->after;
    if (from->number + steps >= 0 && holds_numbers(stream, name)) return name;
  }
  for (const std::string letters : {components == 4 ? "wxyz" : "xyz", "abc"}) {
    for (std::size_t k = channel.size(); k-- > 0;) {
      const char c = channel[k], small = static_cast<char>(std::tolower(c));
      const std::size_t at = letters.find(small);
      if (at == std::string::npos) continue;
      const Index to = static_cast<Index>(at) + steps;
      if (to < 0 || to >= std::ssize(letters)) continue;
      std::string name = channel;
      const char letter = letters[static_cast<std::size_t>(to)];
      name[k] = c == small ? letter : static_cast<char>(std::toupper(letter));
      if (holds_numbers(stream, name)) return name;
    }
  }
  return "";
}

}  // namespace

std::optional<std::size_t> nearest_to_said(const std::vector<std::string>& candidates,
                                           const std::vector<std::string>& said) {
  std::optional<std::size_t> nearest;
  std::size_t longest = 0;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    std::size_t length = 0;
    for (const std::string& name : said) {
      length = std::max(length, common_beginning(candidates[k], name));
    }
    if (length == longest) nearest.reset();
    if (length > longest) longest = length, nearest = k;
  }
  return nearest;
}

std::optional<Counted> counted(const std::string& name) {
  const std::size_t last = name.find_last_of("0123456789");
  if (last == std::string::npos) return std::nullopt;
  const std::size_t before = name.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  if (last + 1 - first > kMostDigits) return std::nullopt;
  return Counted{name.substr(0, first), name.substr(last + 1),
                 std::stoi(name.substr(first, last + 1 - first))};
}

std::optional<ColumnRule> in_said_array(const LogStream& stream,
                                        const std::vector<std::string>& columns,
                                        const std::string& column,
                                        const std::vector<ColumnRule>& said) {
  const auto place = [&](const std::string& to) {
    return std::find(columns.begin(), columns.end(), to) - columns.begin();
  };
  for (const ColumnRule& rule : said) {
    const auto from = place(rule.to);
    if (rule.stream != stream.name || from == std::ssize(columns)) continue;
    const std::string element =
        channel_after(stream, rule.channel, place(column) - from, columns.size());
    const auto taken = [&](const ColumnRule& other) { return other.channel == element; };
    if (element.empty() || std::any_of(said.begin(), said.end(), taken)) continue;
    return ColumnRule{.to = column, .stream = stream.name, .channel = element};
  }
  return std::nullopt;
}

bool may_follow(const std::string& said, const std::string& channel) {
  const auto a = counted(said), b = counted(channel);
  if (a && b && a->before == b->before && a->after == b->after) return true;
  if (said.size() != channel.size()) return false;
  std::size_t other = 0;
  for (std::size_t k = 0; k < said.size(); ++k) other += said[k] != channel[k] ? 1 : 0;
  return other == 1;
}

std::string question_between(const std::string& column, const std::string& stream,
                             const std::vector<std::string>& candidates) {
  return "both " + shown(stream + ":" + candidates[0]) + " and " +
         shown(stream + ":" + candidates[1]) + " may be " + column + ": say --map " + column +
         "=…; columns of the same beginning follow";
}

bool is_trajectory(const LogStream& stream) {
  bool translation = false, other = false;
  for (const LogChannel& channel : stream.channels) {
    const std::string role = role_of(stream, channel.name);
    translation = translation || role == "tx";
    other = other || role == "fx" || role == "x";
  }
  return translation && !other;
}

}  // namespace dcnn
