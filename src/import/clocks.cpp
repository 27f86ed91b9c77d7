// SPDX-License-Identifier: Apache-2.0
#include "import/clocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "data/clock.h"
#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/rate_clock.h"
#include "import/roles.h"
#include "import/units.h"

namespace dcnn {
namespace {

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
constexpr double kOffStep = 0.2;  // as in recordings

/// Years 1990 to 2100 since 1970, s: a number in this range in exactly one of four units is a date.
constexpr double kYear1990 = 6.3e8, kYear2100 = 4.1e9;

/// Below 5 Hz a log is a list of poses or is not counted in seconds: the two look alike.
constexpr double kSlowStep = 0.2;

double median_of(std::vector<double> steps) {
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::vector<double> steps_of(const std::vector<double>& times) {
  std::vector<double> steps;
  steps.reserve(times.size());
  double last = kNoTime;
  for (const double t : times) {
    if (std::isnan(t)) continue;
    if (!std::isnan(last)) steps.push_back(t - last);
    last = t;
  }
  return steps;
}

std::vector<double> numbers_in(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return values;
}

const struct {
  const char* unit;
  double factor;
} kTimeUnits[] = {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};

/// A field of a message whose values are seconds since 1970.
bool is_date(const LogChannel& channel) {
  const double middle = median_of(numbers_in(channel.values));
  return middle > kYear1990 && middle < kYear2100;
}

/// The channel of --clock that this stream has; empty where there is none.
std::string said_clock(const LogStream& stream, const ImportWishes& wishes) {
  for (const std::string& said : wishes.clock) {
    if (stream.find(said) >= 0) return said;
    if (said.starts_with(stream.name + ":")) return said.substr(stream.name.size() + 1);
  }
  return "";
}

/// The unit of a clock that states none, by its size, or by what rates in the log say.
void guess_unit(const LogStream& stream, const LogChannel& channel, ClockRule* rule) {
  constexpr double kFits = 1.5;  // of a rate's scale, where units are a thousand apart
  const double middle = median_of(numbers_in(channel.values));
  for (const auto& choice : kTimeUnits) {
    const double seconds = middle * choice.factor;
    if (seconds < kYear1990 || seconds > kYear2100) continue;
    rule->unit = choice.unit;
    rule->why = "a date since 1970";
    return;
  }
  const double step = median_of(steps_of(channel.values));
  std::ostringstream words;
  if (const auto seconds = seconds_by_rates(stream, channel.values)) {
    for (const auto& choice : kTimeUnits) {
      if (*seconds > kFits * choice.factor || choice.factor > kFits * *seconds) continue;
      rule->unit = choice.unit;
      words << "the logged rates, and steps of " << step;
      rule->why = words.str();
      return;
    }
  }
  if (step < kSlowStep) {
    words << "steps of " << step;
    rule->why = words.str();
    return;
  }
  rule->assumed = true;
  rule->unit = step < 1e3 ? "ms" : step < 1e5 ? "us" : "ns";
  words << "steps of " << step << ": as seconds " << (channel.high - channel.low) / 3600.0 << " h";
  rule->why = words.str();
}

/// A channel by the letter of time and another word (t_ADC) is a clock where its values increase:
/// it may be a temperature.
bool may_count_time(const LogChannel& channel) {
  if (words_of_name(channel.name).size() == 1 || clock_rank(channel.name) > 1) return true;
  const auto falls = [](double a, double b) { return !(b > a); };
  return channel.values.size() > 1 &&
         std::adjacent_find(channel.values.begin(), channel.values.end(), falls) ==
             channel.values.end();
}

const LogChannel* best_clock(const LogStream& stream) {
  const LogChannel* best = nullptr;
  int rank = 0;
  for (const LogChannel& channel : stream.channels) {
    if (channel.finite == 0 || clock_rank(channel.name) <= rank || !may_count_time(channel))
      continue;
    best = &channel;
    rank = clock_rank(channel.name);
  }
  return best;
}

/// secs and nsecs of one stamp; the same name but for its last word.
bool find_pair(const LogStream& stream, ClockRule* rule) {
  for (std::size_t k = 0; k + 1 < stream.channels.size(); ++k) {
    if (stamp_part(stream.channels[k].name) != 1) continue;
    if (stamp_part(stream.channels[k + 1].name) != 2) continue;
    rule->kind = "column";
    rule->channel = stream.channels[k].name;
    rule->nanoseconds = stream.channels[k + 1].name;
    rule->why = "whole seconds and nanoseconds";
    return true;
  }
  return false;
}

bool usable_stamps(const LogStream& stream) {
  if (static_cast<Index>(stream.stamped.size()) != stream.rows || stream.rows == 0) return false;
  const auto [low, high] = std::minmax_element(stream.stamped.begin(), stream.stamped.end());
  return *low > 0.0 && (*high > *low || stream.rows == 1);
}

void take_column(const LogStream& stream, const std::string& name, const ImportWishes& wishes,
                 ClockRule* rule) {
  const Index at = stream.find(name);
  require(at >= 0, Exit::kUsage, "--clock ", stream.name, ":", name, ": has no such channel");
  const LogChannel& channel = stream.channels[static_cast<std::size_t>(at)];
  rule->kind = "column";
  rule->channel = name;
  const std::string stated = channel.unit;
  std::string said = wishes.clock_unit;
  for (const std::string& key : {std::string("t"), name}) {
    if (const auto found = wishes.units.find(key); found != wishes.units.end() && said.empty()) {
      said = found->second;
    }
  }
  if (!said.empty()) {
    rule->unit = said;
    rule->why = "as said";
  } else if (const auto unit = find_unit(stated); unit && unit->quantity == "time") {
    rule->unit = stated;
    rule->why = "its name";
  } else {
    guess_unit(stream, channel, rule);
  }
}

const std::vector<double>& values_of(const LogStream& stream, const std::string& name,
                                     const std::string& file) {
  const Index at = stream.find(name);
  require(at >= 0, Exit::kData, file, ": ", shown(stream.name), " has no channel ", shown(name),
          ", which is to be its clock");
  return stream.channels[static_cast<std::size_t>(at)].values;
}

}  // namespace

ClockRule propose_clock(const LogStream& stream, const ImportWishes& wishes,
                        std::vector<std::string>* guesses) {
  ClockRule rule;
  rule.stream = stream.name;
  if (const auto offset = wishes.clock_offsets.find(stream.name);
      offset != wishes.clock_offsets.end()) {
    rule.offset = offset->second;
  }
  const std::string said = said_clock(stream, wishes);
  const LogChannel* stamp = stream.received.empty() ? nullptr : best_clock(stream);
  if (!said.empty()) {
    take_column(stream, said, wishes, &rule);
  } else if (wishes.rate_hz > 0.0) {
    rule.kind = "rate";
    rule.hz = wishes.rate_hz;
    rule.why = "as said";
  } else if (usable_stamps(stream) && (wishes.stamps == "header" || stream.received.empty())) {
    rule.kind = "header";
    rule.why = "stamps of the messages";
  } else if (wishes.stamps == "header" && stamp != nullptr && is_date(*stamp)) {
    take_column(stream, stamp->name, wishes, &rule);
  } else if (!stream.received.empty()) {
    rule.kind = "receive";
    rule.why = wishes.stamps == "header" ? "no stamps in the messages" : "as said";
  } else if (!find_pair(stream, &rule)) {
    if (const LogChannel* channel = best_clock(stream)) {
      take_column(stream, channel->name, wishes, &rule);
    }
  }
  if (rule.assumed) {
    guesses->push_back("the clock " + shown(rule.channel) + " has " + rule.why +
                       ": say --clock-unit " + rule.unit + " (or s)");
  }
  return rule;
}

std::vector<double> clock_times(const LogStream& stream, const ClockRule& rule,
                                const std::string& file) {
  std::vector<double> times;
  if (rule.kind == "header") times = stream.stamped;
  if (rule.kind == "receive") times = stream.received;
  if (rule.kind == "rate") {
    for (Index k = 0; k < stream.rows; ++k) times.push_back(static_cast<double>(k) / rule.hz);
  }
  if (rule.kind == "column") {
    times = values_of(stream, rule.channel, file);
    const auto unit = find_unit(rule.unit);
    require(unit && unit->quantity == "time", Exit::kData, file, ": ", shown(rule.unit),
            " is no unit of time");
    for (double& t : times) t *= unit->factor;
    if (!rule.nanoseconds.empty()) {
      const std::vector<double>& parts = values_of(stream, rule.nanoseconds, file);
      for (std::size_t k = 0; k < times.size(); ++k) times[k] += 1e-9 * parts[k];
    }
  }
  require(rule.kind == "none" || static_cast<Index>(times.size()) == stream.rows, Exit::kData, file,
          ": ", shown(stream.name), " has no times of kind ", shown(rule.kind));
  for (double& t : times) t += rule.offset;
  return times;
}

std::pair<double, double> ends_of(const std::vector<double>& times) {
  const auto finite = [](double t) { return std::isfinite(t); };
  const auto first = std::find_if(times.begin(), times.end(), finite);
  if (first == times.end()) return {0.0, 0.0};
  return {*first, *std::find_if(times.rbegin(), times.rend(), finite)};
}

ClockFigures clock_figures(const std::vector<double>& times) {
  ClockFigures figures;
  const std::vector<double> steps = steps_of(times);
  if (steps.empty()) return figures;
  const double median = median_of(steps);
  // The slope of a line over the rows is a mean of their steps: where all of these are as near to
  // the median, they are within 20 % of the slope as well, and no clock of few digits.
  constexpr double kNearMedian = 0.09;
  const bool even = std::all_of(steps.begin(), steps.end(), [&](double step) {
    return std::abs(step - median) <= kNearMedian * median;
  });
  std::optional<double> rounded;
  if (!even && std::all_of(times.begin(), times.end(), [](double t) { return std::isfinite(t); })) {
    rounded = step_of_rounded(Eigen::VectorXd::Map(times.data(), Index(times.size())));
  }
  figures.step = rounded.value_or(median);
  Index off = 0;
  for (const double step : steps) {
    if (rounded) break;  // even, but for the digits
    figures.gaps += is_gap(step, figures.step);
    figures.repeats += step == 0.0;
    figures.backward += step < 0.0;
    off += std::abs(step - figures.step) > kOffStep * figures.step;
  }
  figures.off = static_cast<double>(off) / static_cast<double>(steps.size());
  std::tie(figures.begin, figures.end) = ends_of(times);
  return figures;
}

}  // namespace dcnn
