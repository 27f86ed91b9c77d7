#include "import/candidates.h"

#include <algorithm>

#include "data/text.h"
#include "import/roles.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostDigits = 6;

std::size_t common_beginning(const std::string& a, const std::string& b) {
  const auto ends = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<std::size_t>(ends.first - a.begin());
}

/// The element of the stream's array that is `steps` after `channel`; empty where that is no
/// element of an array, or there is no such one.
std::string element_after(const LogStream& stream, const std::string& channel, Index steps) {
  const auto from = counted(channel);
  if (!from || !from->before.ends_with('[') || from->after != "]") return "";
  const std::string name = from->before + std::to_string(from->number + steps) + from->after;
  const Index at = stream.find(name);
  return at >= 0 && stream.channels[static_cast<std::size_t>(at)].finite > 0 ? name : "";
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
    const std::string element = element_after(stream, rule.channel, place(column) - from);
    const auto taken = [&](const ColumnRule& other) { return other.channel == element; };
    if (element.empty() || std::any_of(said.begin(), said.end(), taken)) continue;
    return ColumnRule{.to = column, .stream = stream.name, .channel = element};
  }
  return std::nullopt;
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
