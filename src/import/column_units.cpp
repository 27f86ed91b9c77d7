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

void take_number(const std::map<std::string, double>& from, const std::string& to, double* value) {
  if (const auto found = from.find(to); found != from.end()) *value = found->second;
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

/// An axis may slide: then it has a force, a length and a velocity.
bool is_of_sliding_axis(const std::string& to, const std::string& quantity) {
  return (to.starts_with("tau:") && quantity == "force") ||
         (to.starts_with("q:") && quantity == "length") ||
         (to.starts_with("qd:") && quantity == "velocity");
}

void propose_unit(const ForeignLog& log, const ImportWishes& wishes, ColumnRule* rule) {
  const Source source = source_of(log, *rule);
  const std::string quantity = quantity_of_column(rule->to);
  take_number(wishes.gains, rule->to, &rule->gain);
  take_number(wishes.offsets, rule->to, &rule->offset);
  take_number(wishes.wraps, rule->to, &rule->wrap);
  if (const auto said = wishes.units.find(rule->to); said != wishes.units.end()) {
    rule->unit = said->second;
    rule->why = "as said";
    require(find_unit(rule->unit).has_value(), Exit::kUsage, "--unit ", rule->to, "=", rule->unit,
            ": is no unit that is known here");
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
  std::map<std::string, std::string> guessed;
  for (ColumnRule& rule : proposal->recipe.columns) {
    propose_unit(log, wishes, &rule);
    if (!rule.assumed) continue;
    if (const std::string unit = unknown_unit_of_name(rule.channel);
        !unit.empty() && rule.unit.empty()) {
      proposal->guesses.push_back(shown(unit) + " behind the name of " + rule.to +
                                  " is no unit that is known here: say --unit " + rule.to +
                                  "=N, or what it is");
      continue;
    }
    if (rule.why.find("no unit of") != std::string::npos) {
      proposal->guesses.push_back(rule.to + " is in " + rule.unit + " by the name of " +
                                  shown(rule.channel) + ": say --gain " + rule.to +
                                  "=NUMBER, what one " + rule.unit + " is in SI");
      continue;
    }
    std::string& list = guessed[rule.unit];
    list += (list.empty() ? "" : ",") + rule.to;
  }
  for (const auto& [unit, columns] : guessed) {
    const std::string ask = unit == "counts"
                                ? columns + " look like counts (large whole numbers): say --gain " +
                                      columns + "=NEWTONS_PER_COUNT, or --unit " + columns + "=mN"
                                : columns + " look like " + unit + " by their size: say --unit " +
                                      columns + "=" + unit +
                                      (columns.starts_with("q:")
                                           ? ", or =rad of shafts that turn on (and --gain, where "
                                             "these are motors behind a gear)"
                                           : "");
    proposal->guesses.push_back(ask);
  }
}

}  // namespace dcnn
