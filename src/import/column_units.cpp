// SPDX-License-Identifier: Apache-2.0
#include "import/column_units.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/units.h"

namespace dcnn {
namespace {

constexpr double kFarthest = 20.0;        // m: no arm reaches as far
constexpr double kStrongest = 1e5;        // N, N m: beyond any wrist sensor
constexpr double kLargestCount = 2048.0;  // whole numbers beyond: a converter's counts
constexpr double kPi = std::numbers::pi;

struct Source {
  const LogStream* stream = nullptr;
  const LogChannel* channel = nullptr;
};

Source source_of(const ForeignLog& log, const ColumnRule& rule) {
  for (const LogStream& stream : log.streams) {
    if (stream.name != rule.stream) continue;
    const Index at = stream.find(rule.channel);
    if (at >= 0) return {&stream, &stream.channels[static_cast<std::size_t>(at)]};
  }
  fail(Exit::kData, log.file, ": has no channel ", shown(rule.stream + ":" + rule.channel));
}

/// Whether an option's key names this column: fx, q:1 or q_1, or the channel that it is made of.
bool is_key_of(const std::string& key, const ColumnRule& rule) {
  if (key == rule.to || key == rule.channel || key == rule.stream + ":" + rule.channel) return true;
  std::string plain = rule.to;
  std::replace(plain.begin(), plain.end(), ':', '_');
  return key == plain;
}

template <class Value>
const Value* said_for(const std::map<std::string, Value>& from, const ColumnRule& rule) {
  for (const auto& [key, value] : from) {
    if (is_key_of(key, rule)) return &value;
  }
  return nullptr;
}

void take_number(const std::map<std::string, double>& from, const ColumnRule& rule, double* value) {
  if (const double* said = said_for(from, rule)) *value = *said;
}

/// Every key of an option names a column, or a clock.
template <class Value>
void demand_keys(const char* option, const std::map<std::string, Value>& said,
                 const Recipe& recipe) {
  for (const auto& [key, value] : said) {
    const auto column = [&, name = key](const ColumnRule& rule) { return is_key_of(name, rule); };
    const auto clock = [&, name = key](const ClockRule& rule) {
      return name == "t" || name == rule.channel;
    };
    if (std::any_of(recipe.columns.begin(), recipe.columns.end(), column)) continue;
    if (std::string_view(option) == "--unit" &&
        std::any_of(recipe.clocks.begin(), recipe.clocks.end(), clock)) {
      continue;
    }
    std::string all;
    for (const ColumnRule& rule : recipe.columns) all += (all.empty() ? "" : ", ") + rule.to;
    fail(Exit::kUsage, option, " ", key,
         "=…: no column of the recording is called so or made of such a channel; there ",
         all.empty() ? "are none" : "are " + all, "; see --map and --also");
  }
}

/// What cannot be the quantity in SI is of another unit; which one is a guess.
void guess_column_unit(const LogChannel& channel, ColumnRule* rule) {
  const std::string quantity = quantity_of_column(rule->to);
  const double size = channel.sizes.usual();
  std::ostringstream words;
  words << "largest " << size;
  rule->why = words.str();
  if (rule->gain != 1.0) return;
  const bool joint = rule->to.starts_with("q:");
  // Angles of an orientation are wrapped at pi or unwrapped within a turn; joints turn more often.
  if (quantity == "angle" && size > (joint ? 8.0 : 2.5) * kPi) rule->unit = "deg";
  if (quantity == "length" && size > kFarthest) rule->unit = "mm";
  const bool load = quantity == "force" || quantity == "torque";
  if (load && ((channel.whole && size > kLargestCount) || size > kStrongest)) rule->unit = "counts";
  rule->assumed = !rule->unit.empty();
}

/// A unit that is one of geometry or mechanics: what a converter gives may be gained to anything.
bool has_dimension(const std::string& quantity) {
  return quantity != "counts" && quantity != "number" && quantity != "voltage" &&
         quantity != "current";
}

/// Of a joint: ", of one that slides: m, mm, …".
std::string units_if_it_slides(const std::string& to) {
  for (const char* quantity : {"length", "velocity", "force"}) {
    if (is_of_sliding_axis(to, quantity)) return ", of one that slides: " + units_of(quantity);
  }
  return "";
}

void propose_unit(const ForeignLog& log, const ImportWishes& wishes, ColumnRule* rule) {
  const Source source = source_of(log, *rule);
  const std::string quantity = quantity_of_column(rule->to);
  take_number(wishes.gains, *rule, &rule->gain);
  take_number(wishes.offsets, *rule, &rule->offset);
  take_number(wishes.wraps, *rule, &rule->wrap);
  if (const std::string* said = said_for(wishes.units, *rule)) {
    rule->unit = *said;
    rule->why = "as said";
    const auto unit = find_unit(rule->unit);
    require(unit.has_value(), Exit::kUsage, "--unit ", rule->to, "=", rule->unit,
            ": is no unit that is known here", quantity.empty() ? "" : " of " + quantity,
            "; there are ", units_of(quantity), units_if_it_slides(rule->to));
    const bool other = !quantity.empty() && has_dimension(unit->quantity) &&
                       unit->quantity != quantity && rule->gain == 1.0 &&
                       !is_of_sliding_axis(rule->to, unit->quantity);
    require(!other, Exit::kUsage, "--unit ", rule->to, "=", rule->unit, ": is a unit of ",
            unit->quantity, ", and ", rule->to, " is one of ", quantity, ": ", units_of(quantity),
            units_if_it_slides(rule->to));
    return;
  }
  const auto stated = find_unit(source.channel->unit);
  if (stated && (quantity.empty() || stated->quantity == quantity ||
                 is_of_sliding_axis(rule->to, stated->quantity))) {
    rule->unit = source.channel->unit;
    rule->why = "its name";
  } else if (stated && stated->quantity != "number" && rule->gain != 1.0) {
    rule->why = "its gain, per " + source.channel->unit;
  } else if (stated && stated->quantity != "number") {
    rule->unit = source.channel->unit;
    rule->why = "its name, which is no unit of " + quantity;
    rule->assumed = true;
  } else if (source.stream->si) {
    rule->why = "type of the message";
  } else if (const std::string unit = unknown_unit_of_name(rule->channel);
             !unit.empty() && rule->gain == 1.0) {
    rule->why = "its name, which is not understood";
    rule->assumed = true;
  } else {
    guess_column_unit(*source.channel, rule);
  }
}

}  // namespace

bool is_of_sliding_axis(const std::string& to, const std::string& quantity) {
  return (to.starts_with("tau:") && quantity == "force") ||
         (to.starts_with("q:") && quantity == "length") ||
         (to.starts_with("qd:") && quantity == "velocity");
}

std::string quantity_of_column(const std::string& to) {
  const char first = to.empty() ? ' ' : to[0];
  const auto begins = [&](const char* stem) { return to.starts_with(stem); };
  if (to == "temperature") return "temperature";
  if (to == "x" || to == "y" || to == "z") return "length";
  if (to == "alpha" || to == "beta" || to == "gamma") return "angle";
  if (begins("rot") || begins("rv") || begins("q:")) return "angle";
  if (begins("tau:")) return "torque";
  if (begins("qd:")) return "rate";
  if (begins("dw")) return "angular acceleration";
  const bool vector = to.size() == 2 || to.ends_with("_sim");
  if (!vector) return "";
  if (first == 'f') return "force";
  if (first == 't') return "torque";
  if (first == 'v') return "velocity";
  if (first == 'w') return "rate";
  return first == 'a' ? "acceleration" : "";
}

void propose_units(const ForeignLog& log, const ImportWishes& wishes, Proposal* proposal) {
  std::map<std::pair<std::string, std::string>, std::string> guessed;  // by unit and quantity
  for (ColumnRule& rule : proposal->recipe.columns) {
    propose_unit(log, wishes, &rule);
    if (!rule.assumed) continue;
    if (const std::string unit = unknown_unit_of_name(rule.channel);
        !unit.empty() && rule.unit.empty()) {
      proposal->guesses.push_back(shown(unit) + " behind the name of " + rule.to +
                                  " is no unit that is known here: say --unit " + rule.to +
                                  "=UNIT, one of " + units_of(quantity_of_column(rule.to)) +
                                  ", or --gain " + rule.to + "=NUMBER, what one of it is in SI");
      continue;
    }
    if (rule.why.find("no unit of") != std::string::npos) {
      proposal->guesses.push_back(rule.to + " is in " + rule.unit + " by the name of " +
                                  shown(rule.channel) + ": say --gain " + rule.to +
                                  "=NUMBER, what one " + rule.unit + " is in SI");
      continue;
    }
    std::string& list = guessed[{rule.unit, quantity_of_column(rule.to)}];
    list += (list.empty() ? "" : ",") + rule.to;
  }
  if (proposal->questions.empty()) {
    demand_keys("--unit", wishes.units, proposal->recipe);
    demand_keys("--gain", wishes.gains, proposal->recipe);
    demand_keys("--offset", wishes.offsets, proposal->recipe);
    demand_keys("--wrap", wishes.wraps, proposal->recipe);
  }
  for (const auto& [kind, columns] : guessed) {
    const auto& [unit, quantity] = kind;
    const std::string ask = unit == "counts"
                                ? columns + " look like counts (large whole numbers): say --gain " +
                                      columns + "=SI_PER_COUNT, or --unit " + columns + "=" +
                                      (quantity == "torque" ? "mNm" : "mN")
                                : columns + " look like " + unit + " by their size: say --unit " +
                                      columns + "=" + unit +
                                      (columns.starts_with("q:")
                                           ? ", or =rad of shafts that turn on (and --gain, where "
                                             "these are motors behind a gear), or =mm of an axis "
                                             "that slides"
                                           : "");
    proposal->guesses.push_back(ask);
  }
}

}  // namespace dcnn
