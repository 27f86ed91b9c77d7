// SPDX-License-Identifier: Apache-2.0
// What to type where no channel of a log is known by its name.
#include <algorithm>
#include <map>
#include <vector>

#include "dcnn/import/summary.h"
#include "import/candidates.h"
#include "import/roles.h"

namespace dcnn {
namespace {

using Names = std::vector<std::string>;

bool varies(const LogChannel& channel) { return channel.finite > 1 && channel.high > channel.low; }

/// Whether a column may be meant: no clock, and nothing that was wanted or simulated.
bool may_be_meant(const LogChannel& channel, const std::string& clock) {
  return channel.name != clock && !is_no_measurement(words_of_name(channel.name));
}

/// Columns that are called alike but for their last number, in the order of the log.
std::vector<Names> groups_of(const LogStream& stream, const std::string& clock) {
  std::vector<Names> groups;
  std::map<std::string, std::size_t> known;
  for (const LogChannel& channel : stream.channels) {
    if (!may_be_meant(channel, clock) || channel.finite == 0) continue;
    const auto name = counted(channel.name);
    const std::string key = name ? name->before + "#" + name->after : channel.name;
    const auto [at, fresh] = known.emplace(key, groups.size());
    if (fresh) groups.emplace_back();
    groups[at->second].push_back(channel.name);
  }
  return groups;
}

std::string map_of(const std::string& column, const std::string& channel) {
  return " --map " + quoted_argument(column + "=" + channel);
}

/// Of counted columns: a wrench and its pose where they are threes, else an arm's positions and
/// torques, the first two groups of one size.
std::string by_groups(const std::vector<Names>& groups) {
  std::vector<const Names*> threes, fours, more;
  for (const Names& group : groups) {
    if (group.size() == 3) threes.push_back(&group);
    if (group.size() == 4) fours.push_back(&group);
    if (group.size() == groups[0].size() && group.size() > 1) more.push_back(&group);
  }
  std::string words;
  if (threes.size() >= 2) {
    const char* const firsts[] = {"fx", "tx", "x"};
    const bool torque = threes.size() > 2;
    words += map_of("fx", threes[0]->front());
    if (torque) words += map_of(firsts[1], threes[1]->front());
    words += map_of(firsts[2], threes[torque ? 2 : 1]->front());
    if (!fours.empty()) words += map_of("qw", fours[0]->front());
    return words;
  }
  if (more.size() < 2) return "";
  return map_of("q:1", more[0]->front()) + map_of("tau:1", more.back()->front());
}

/// Whether a command line has this option, as a word of its own or with "=VALUE".
bool is_given(const std::string& command, const std::string& option) {
  const std::string padded = command + " ";
  return padded.find(" " + option + " ") != std::string::npos ||
         padded.find(" " + option + "=") != std::string::npos;
}

}  // namespace

std::string quoted_argument(const std::string& word) {
  if (!word.empty() && word.find_first_of(" \t'\"$\\`*?&;()<>|[]{}#~!") == std::string::npos) {
    return word;
  }
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string how_to_name(const ForeignLog& log) {
  const std::string begin =
      "no channel is known by its name: say which is which with --map (those that are counted on "
      "follow), or --columns with a name for each column, in their order";
  const LogStream* longest = nullptr;
  for (const LogStream& stream : log.streams) {
    if (longest == nullptr || stream.channels.size() > longest->channels.size()) longest = &stream;
  }
  if (longest == nullptr) return begin;
  std::string clock;
  for (const LogChannel& channel : longest->channels) {
    if (clock.empty() && clock_rank(channel.name) > 0) clock = channel.name;
  }
  const std::vector<Names> groups = groups_of(*longest, clock);
  std::string maps = groups.empty() ? "" : by_groups(groups);
  if (maps.empty()) {
    Names moving;
    for (const LogChannel& channel : longest->channels) {
      if (may_be_meant(channel, clock) && varies(channel)) moving.push_back(channel.name);
    }
    if (moving.size() < 2) return begin;
    maps = map_of("q:1", moving.front()) + map_of("tau:1", moving.back());
  }
  const std::string command =
      log.command.empty() ? "dcnn-import " + quoted_argument(log.file) : log.command;
  std::string more = maps;
  if (!is_given(command, "--clock") && !is_given(command, "--rate")) {
    more += clock.empty() ? " --rate HZ" : " --clock " + quoted_argument(clock);
  }
  if (!is_given(command, "--out")) more += " --out imported";
  return begin + "; such as: " + command + more +
         " (q, qd, tau: an arm's joints; fx, tx, x, qw: a wrench and its pose)";
}

}  // namespace dcnn
