#include "diagnosis/words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect_words.h"
#include "physics/found_numbers.h"

namespace dcnn {
namespace {

using Estimates = std::vector<Estimate>;

double value_of(const Estimates& numbers, const std::string& name) {
  for (const Estimate& e : numbers) {
    if (e.name == name) return e.value;
  }
  return 0.0;
}

std::string place(const std::string& axis) { return axis.empty() ? "" : " " + words_of_axis(axis); }

/// ", at y = -35 mm, z = 158 mm from the sensor's origin", where torques tell of it.
std::string lever(const Estimates& n) {
  std::string at;
  for (const Estimate& e : n) {
    if (!e.name.starts_with("lever_") || e.low == e.high) continue;
    at +=
        (at.empty() ? ", at " : ", ") + e.name.substr(6, 1) + " = " + in_thousandths(e.value, "mm");
  }
  return at.empty() ? at : at + " from the sensor's origin";
}

std::string seconds(double t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", t);
  return text;
}

/// " from 12.3 to 14.0 s of fit.csv"; nothing for what acts all the time.
std::string when(const Member& member) {
  if (!member.interval_s) return "";
  const auto [begin, end] = *member.interval_s;
  const bool onset = member.kind->interval == IntervalRule::kOnset;
  return (onset ? " at " + seconds(begin) : " from " + seconds(begin) + " to " + seconds(end)) +
         " s" + (member.recording.empty() ? "" : " of " + member.recording);
}

/// Of a law that a logged signal drives.
std::string driven_in_words(const Member& member, const Estimates& n) {
  const auto& [signal, low, high] = *member.driver;
  return driven_words(*member.kind, place(member.axis),
                      {signal, unit_text(unit_of_parameter(member.kind->strength)), low, high,
                       member.amplitudes(0), member.amplitudes(1), value_of(n, "lag_s")});
}

FoundNumbers found_numbers(const Estimates& numbers) {
  std::vector<FoundNumber> found;
  for (const Estimate& e : numbers) {
    found.push_back({stem_of_parameter(e.name), unit_text(e.unit), e.value, e.low, e.high,
                     is_told({{"ci95", {e.low, e.high}}})});
  }
  return {std::move(found), false};
}

std::string effect_in_words(const Member& member, const Estimates& numbers) {
  const EffectKind& kind = *member.kind;
  const std::string what = kind.words ? kind.words(found_numbers(numbers)) : kind.meaning;
  return what + place(member.axis) + when(member);
}

}  // namespace

std::string driven_words(const EffectKind& kind, const std::string& place, const Following& law) {
  const auto at = [&](double strength, double value) {
    return brief(strength) + (law.unit.empty() ? "" : " " + law.unit) + " at " + brief(value);
  };
  const bool offset = kind.stage == Stage::kOffset;
  std::string text = (offset ? "offset" : kind.meaning) + place + " that follows " + law.signal +
                     ", " + at(law.at_low, law.low) + " and " + at(law.at_high, law.high);
  if (law.lag == 0.0) return text;
  const std::string away = in_thousandths(std::abs(law.lag), "ms");
  return text + ", " + away + (law.lag > 0.0 ? " after it" : " before it");
}

std::string per_signal(const std::string& unit, const Json& driven_by) {
  return (unit.empty() ? "1" : unit) + " per unit of " + driven_by["value"].get<std::string>();
}

std::string in_words(const Member& member, const Estimates& n) {
  return (member.driver ? driven_in_words(member, n) : effect_in_words(member, n)) + lever(n);
}

}  // namespace dcnn
