// SPDX-License-Identifier: Apache-2.0
// Clocks that no name tells.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "data/text.h"
#include "import/clocks.h"
#include "import/rate_clock.h"
#include "import/roles.h"

namespace dcnn {
namespace {

constexpr double kEven = 0.01;      // of a step: more is no clock that was computed
constexpr double kSlowest = 0.2;    // s: of steps above it the unit is not told either
constexpr std::size_t kFewest = 5;  // rows

/// Whether a column that is not known by its name grows by one step from row to row, which is no
/// counter's.
bool grows_evenly(const LogStream& stream, const LogChannel& channel) {
  const std::vector<double>& x = channel.values;
  if (channel.whole || x.size() < kFewest || !role_of(stream, channel.name).empty()) return false;
  const double step = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
  if (!(step > 0.0) || step > kSlowest) return false;
  for (std::size_t k = 1; k < x.size(); ++k) {
    if (!(std::abs(x[k] - x[k - 1] - step) < kEven * step)) return false;
  }
  return true;
}

/// Whether the steps from row to row go on as they were, as those of a curve do and those between
/// poses that were taken up in turn do not: second differences are smaller than first ones.
bool is_curve(const std::vector<double>& x, std::size_t stride) {
  constexpr std::size_t kFewestSteps = 50;
  constexpr double kSmooth = 0.5;  // 2 of independent steps, 3 of independent values
  if (x.size() < kFewestSteps * stride) return false;
  double first = 0.0, second = 0.0;
  for (std::size_t k = 2 * stride; k < x.size(); k += stride) {
    const double now = x[k] - x[k - stride], before = x[k - stride] - x[k - 2 * stride];
    if (!std::isfinite(now) || !std::isfinite(before)) continue;
    first += now * now;
    second += (now - before) * (now - before);
  }
  return first > 0.0 && second < kSmooth * first;
}

bool tells_motion(const std::string& to) {
  return to.starts_with("q") || to.starts_with("rot") || to.starts_with("rv") || to == "x" ||
         to == "y" || to == "z" || to == "alpha" || to == "beta" || to == "gamma";
}

}  // namespace

void ask_for_clock(const ForeignLog& log, Proposal* proposal) {
  const auto& clocks = proposal->recipe.clocks;
  if (std::any_of(clocks.begin(), clocks.end(),
                  [](const ClockRule& c) { return c.kind != "none"; }))
    return;
  for (const ColumnRule& rule : proposal->recipe.columns) {
    if (!tells_motion(rule.to)) continue;
    for (const LogStream& stream : log.streams) {
      const Index at = stream.name == rule.stream ? stream.find(rule.channel) : -1;
      if (at < 0) continue;
      const auto& x = stream.channels[static_cast<std::size_t>(at)].values;
      if (!is_curve(x, 1) && !is_curve(x, 4) && !is_curve(x, 16)) continue;
      proposal->guesses.push_back("no clock, and " + shown(rule.channel) +
                                  " moves smoothly from row to row: say --rate HZ or --clock "
                                  "CHANNEL (these are poses at rest otherwise)");
      return;
    }
  }
}

void ask_for_stamps(const ForeignLog& log, const ImportWishes& wishes, Proposal* proposal) {
  const auto& clocks = proposal->recipe.clocks;
  if (wishes.stamps != "header" || clocks.size() < 2) return;
  const auto span_of = [&](const ClockRule& clock, bool receipt) {
    for (const LogStream& stream : log.streams) {
      if (stream.name != clock.stream) continue;
      ClockRule rule = clock;
      if (receipt) rule.kind = stream.received.empty() ? "none" : "receive";
      return ends_of(clock_times(stream, rule, log.file));
    }
    return std::pair(0.0, 0.0);
  };
  const auto apart = [&](const ClockRule& a, const ClockRule& b, bool receipt) {
    const auto s = span_of(a, receipt), t = span_of(b, receipt);
    if (s.first == s.second || t.first == t.second) return 0.0;
    return std::max({0.0, t.first - s.second, s.first - t.second});
  };
  for (std::size_t k = 1; k < clocks.size(); ++k) {
    const double far = apart(clocks[0], clocks[k], false);
    if (far <= 0.0 || apart(clocks[0], clocks[k], true) > 0.0) continue;
    std::ostringstream words;
    words
        << "the stamps of " << clocks[0].stream << " and " << clocks[k].stream << " are " << far
        << " s apart, the times of their receipt are not: say --stamps receive, or --clock-offset "
        << clocks[k].stream << "=SECONDS";
    proposal->questions.push_back(words.str());
    return;
  }
}

std::optional<ClockRule> lone_clock(const ForeignLog& log, const std::vector<ClockRule>& clocks,
                                    const ImportWishes& wishes, std::vector<std::string>* guesses) {
  std::set<std::string> used;
  std::set<Index> clockless;  // their rows
  for (const ClockRule& clock : clocks) used.insert(clock.stream);
  for (const LogStream& stream : log.streams) {
    const auto without = [&](const ClockRule& clock) {
      return clock.stream == stream.name && clock.kind == "none";
    };
    if (std::any_of(clocks.begin(), clocks.end(), without)) clockless.insert(stream.rows);
  }
  for (const LogStream& stream : log.streams) {
    if (used.contains(stream.name) || !clockless.contains(stream.rows)) continue;
    std::vector<std::string> guessed;
    const ClockRule rule = propose_clock(stream, wishes, &guessed);
    if (rule.kind != "column") continue;
    guesses->insert(guesses->end(), guessed.begin(), guessed.end());
    return rule;
  }
  return std::nullopt;
}

void propose_unnamed(const LogStream& stream, ClockRule* rule, std::vector<std::string>* guesses) {
  if (rule->kind != "none" || stream.channels.empty()) return;
  if (const LogChannel& first = stream.channels.front(); grows_evenly(stream, first)) {
    rule->kind = "column";
    rule->channel = first.name;
    rule->why = "it grows evenly";
    rule->assumed = true;
    guesses->push_back("no clock by its name, and " + shown(first.name) +
                       " grows evenly: say --clock " + shown(first.name) + ", or --rate");
    return;
  }
  const auto seconds = seconds_by_rates(stream, {});
  if (!seconds) return;
  const double hz = 1.0 / *seconds;
  double digit = 1.0;
  while (hz >= 1000.0 * digit) digit *= 10.0;
  while (hz < 100.0 * digit) digit /= 10.0;
  rule->kind = "rate";
  rule->hz = digit * std::round(hz / digit);
  rule->assumed = true;
  std::ostringstream words;
  words << rule->hz;
  rule->why = "the logged rates";
  guesses->push_back("no clock, and the logged rates fit " + words.str() +
                     " rows a second: say --rate " + words.str());
}

}  // namespace dcnn
