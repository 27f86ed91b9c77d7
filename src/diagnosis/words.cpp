// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/words.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect_words.h"

namespace dcnn {
namespace {

std::string place(const std::string& axis) { return axis.empty() ? "" : " " + words_of_axis(axis); }

/// ", at y = -35 mm, z = 158 mm from the sensor's origin", where torques tell of it.
std::string lever(const Json& parameters) {
  std::string at;
  for (const auto& [name, number] : parameters.items()) {
    if (!name.starts_with("lever_") || number["ci95"][0] == number["ci95"][1]) continue;
    at += (at.empty() ? ", at " : ", ") + name.substr(6, 1) + " = " +
          in_thousandths(number["value"].get<double>(), "mm");
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
std::string driven_in_words(const Member& member, const Json& parameters) {
  const auto& [signal, low, high] = *member.driver;
  return driven_words(*member.kind, place(member.axis),
                      {signal, unit_text(unit_of_parameter(member.kind->strength)), low, high,
                       member.amplitudes(0), member.amplitudes(1), parameters["lag_s"]["value"]});
}

std::string effect_in_words(const Member& member, const Json& parameters) {
  const EffectKind& kind = *member.kind;
  const std::string what = kind.words ? kind.words(found_numbers(parameters, false)) : kind.meaning;
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

FoundNumbers found_numbers(const Json& parameters, bool on_machine) {
  const auto end_of = [](const Json& interval, std::size_t k) {
    return interval[k].is_number() ? interval[k].get<double>()
                                   : std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<FoundNumber> found;
  for (const auto& [name, number] : parameters.items()) {
    found.push_back({on_machine ? name : stem_of_parameter(name),
                     unit_text(number["unit"].get<std::string>()), number["value"].get<double>(),
                     end_of(number["ci95"], 0), end_of(number["ci95"], 1), is_told(number)});
  }
  return {std::move(found), on_machine};
}

std::string in_words(const Member& member, const Json& parameters) {
  return (member.driver ? driven_in_words(member, parameters)
                        : effect_in_words(member, parameters)) +
         lever(parameters);
}

}  // namespace dcnn
