// SPDX-License-Identifier: Apache-2.0
#include "import/said_streams.h"

#include <algorithm>
#include <optional>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/core/excerpt.h"
#include "import/candidates.h"

namespace dcnn {
namespace {

/// "slow[0]", "slow{1}", "slow.t" and "slow" are columns of the array or group `slow`.
bool is_column_of(const std::string& channel, const std::string& group) {
  if (!channel.starts_with(group)) return false;
  return channel.size() == group.size() ||
         std::string_view("[.{").find(channel[group.size()]) != std::string_view::npos;
}

/// Names of the streams that a word of --use means.
std::vector<std::string> streams_called(const ForeignLog& log, const std::string& word) {
  std::vector<std::string> by_columns;
  for (const LogStream& stream : log.streams) {
    if (stream.name == word) return {word};
    if (stream.type != "array") continue;
    const bool found =
        std::any_of(stream.channels.begin(), stream.channels.end(),
                    [&](const LogChannel& channel) { return is_column_of(channel.name, word); });
    if (found) by_columns.push_back(stream.name);
  }
  return by_columns;
}

/// "t, q[0] to q[6], force" of channels; those that are counted on are a range.
std::string columns_in_short(const LogStream& stream) {
  std::vector<std::string> parts;
  std::string first;              // of the range that the last part is
  std::optional<Counted> before;  // the channel before
  for (const LogChannel& channel : stream.channels) {
    const auto name = counted(channel.name);
    const bool follows = name && before && name->before == before->before &&
                         name->after == before->after && name->number == before->number + 1;
    if (follows) {
      parts.back() = first + " to " + channel.name;
    } else {
      parts.push_back(first = channel.name);
    }
    before = name;
  }
  std::string words;
  for (const std::string& part : parts) words += (words.empty() ? "" : ", ") + part;
  return words;
}

/// "arrays1 (t, q[0] to q[6]); arrays2 (force)".
std::string streams_with_columns(const ForeignLog& log) {
  constexpr std::size_t kMostShown = 12, kLongestName = 80, kLongestList = 160;  // streams; bytes
  std::string all;
  for (std::size_t k = 0; k < log.streams.size() && k < kMostShown; ++k) {
    all += (all.empty() ? "" : "; ") + excerpt(log.streams[k].name, kLongestName) + " (" +
           excerpt(columns_in_short(log.streams[k]), kLongestList) + ")";
  }
  if (log.streams.size() <= kMostShown) return all;
  return all + "; and " + std::to_string(log.streams.size() - kMostShown) + " more";
}

}  // namespace

ImportWishes resolved_wishes(const ForeignLog& log, ImportWishes wishes) {
  std::vector<std::string> use;
  for (const std::string& word : wishes.use) {
    const std::vector<std::string> names = streams_called(log, word);
    require(!names.empty(), Exit::kUsage, log.file, ": --use ", shown(word),
            " is no stream of it, nor what an array's columns begin with; name one of: ",
            names.empty() ? streams_with_columns(log) : "");
    use.insert(use.end(), names.begin(), names.end());
  }
  wishes.use = std::move(use);
  if (const auto said = wishes.map.extract("t")) wishes.clock.push_back(said.mapped());
  return wishes;
}

}  // namespace dcnn
