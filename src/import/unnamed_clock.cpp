// Clocks that no name tells.
#include <algorithm>
#include <cmath>
#include <sstream>

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

}  // namespace

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
