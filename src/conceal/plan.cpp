// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "conceal/draws.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/conceal/scenario.h"
#include "dcnn/core/error.h"

namespace dcnn::conceal {
namespace {

const std::vector<Share>& shares() {
  static const std::vector<std::string> foreign{"coulomb_friction", "contact", "hysteresis",
                                                "lugre_friction"};
  static const std::vector<Share> all{
      {"null",
       0.15,
       {"white", "ar1", "heteroscedastic", "heavy", "quantised", "flicker", "pose"},
       {"none"}},
      {"faint", 0.05, {"0.003"}, listed_effects()},
      {"single", 0.35, {"0.1", "0.2", "0.5", "1", "2"}, listed_effects()},
      {"foreign", 0.05, {"0.5", "1", "2"}, foreign},
      {"poor", 0.05, {"0.5", "2"}, listed_effects()},
      {"double", 0.12, {"0.5", "1", "2"}, {"any"}},
      {"triple", 0.07, {"1", "2"}, {"any"}},
      {"collinear", 0.06, {"0.5", "1", "2"}, {"any"}},
      {"unlisted", 0.06, {"0.5", "1", "2"}, unlisted_effects()},
      {"mixed", 0.04, {"1", "2"}, unlisted_effects()}};
  return all;
}

/// Whole numbers in proportion to the shares (largest remainders).
std::vector<int> counts(const std::vector<Share>& shares, int scenarios) {
  std::vector<int> count;
  std::vector<std::pair<double, std::size_t>> rest;
  for (const Share& s : shares) {
    const double wanted = s.part * scenarios;
    rest.emplace_back(std::floor(wanted) - wanted, count.size());
    count.push_back(static_cast<int>(wanted));
  }
  std::stable_sort(rest.begin(), rest.end());
  const int left = scenarios - std::accumulate(count.begin(), count.end(), 0);
  for (int k = 0; k < left; ++k) ++count[rest[static_cast<std::size_t>(k)].second];
  return count;
}

template <class T>
std::vector<T> shuffled(const std::vector<T>& all, Rng& rng) {
  std::vector<T> out;
  for (const auto k : permutation(static_cast<std::int64_t>(all.size()), rng)) {
    out.push_back(all[static_cast<std::size_t>(k)]);
  }
  return out;
}

/// Values that cannot be had with an effect: its strength is the motion's, or too small to clip.
bool impossible(const Share& share, const std::string& effect) {
  return share.group == "faint" && has("inertial_terms saturation quantisation", effect);
}

}  // namespace

std::vector<std::string> plan_of(const std::vector<Share>& shares, int scenarios, Rng& rng) {
  require(scenarios > 0 && scenarios <= 9999, Exit::kUsage,
          "a challenge has 1 to 9999 scenarios, not ", scenarios);
  std::vector<std::string> ids;
  const std::vector<int> count = counts(shares, scenarios);
  for (std::size_t g = 0; g < count.size(); ++g) {
    const Share& share = shares[g];
    std::vector<std::string> effects = shuffled(share.effects, rng);
    std::erase_if(effects, [&](const std::string& e) { return impossible(share, e); });
    const std::vector<std::string> values = shuffled(share.values, rng);
    for (int k = 0; k < count[g]; ++k) {
      const auto n = static_cast<std::size_t>(k);
      const std::size_t turn = n / effects.size();  // each round begins at another value
      ids.push_back(share.group + ":" + values[(n + turn) % values.size()] + "/" +
                    effects[n % effects.size()] + "/" + std::to_string(k));
    }
  }
  return shuffled(ids, rng);
}

std::vector<std::string> plan(int scenarios, std::uint64_t seed) {
  Rng rng({seed, 2});
  return plan_of(shares(), scenarios, rng);
}

std::vector<std::string> rates_plan(int rounds, std::uint64_t seed) {
  require(rounds > 0 && rounds <= 50, Exit::kUsage, "a table of rates has 1 to 50 rounds, not ",
          rounds);
  Rng rng({seed, 3});
  std::vector<std::string> ids;
  const auto add = [&](const std::string& group, const std::string& value,
                       const std::string& effect, int number) {
    ids.push_back(group + ":" + value + "/" + effect + "/" + std::to_string(number));
  };
  for (int round = 0; round < rounds; ++round) {
    for (const Share& share : shares()) {
      const auto turn = static_cast<std::size_t>(round);
      const std::vector<std::string>& values = share.values;
      if (share.group == "null") {
        constexpr int kNulls = 75;
        for (int k = 0; k < kNulls; ++k) {
          const int number = round * kNulls + k;
          add("null", values[static_cast<std::size_t>(number) % values.size()], "none", number);
        }
      } else if (share.group == "single") {
        for (const std::string& effect : share.effects) {
          for (const char* amplitude : {"1", "0.3", turn % 2 == 0 ? "0.1" : "0.05"}) {
            add("single", amplitude, effect, round);
          }
        }
      } else {
        constexpr std::size_t kOthers = 8;
        const std::size_t several = share.effects.size() > 1 ? share.effects.size() : kOthers;
        const std::size_t count = std::min(kOthers, several);
        for (std::size_t k = 0; k < count; ++k) {
          const std::string& effect = share.effects[(turn * count + k) % share.effects.size()];
          if (!impossible(share, effect)) {
            add(share.group, values[(turn + k) % values.size()], effect,
                round * static_cast<int>(count) + static_cast<int>(k));
          }
        }
      }
    }
  }
  return shuffled(ids, rng);
}

namespace {

/// In place of a listed effect one of the hardware's, in turns.
std::string with_hardware(const std::string& id, std::size_t turn) {
  const auto colon = id.find(':'), first = id.find('/'), second = id.rfind('/');
  if (!has("faint single poor", id.substr(0, colon))) return id;
  const auto& effects = hardware_effects();
  return id.substr(0, first + 1) + effects[turn % effects.size()] + id.substr(second);
}

}  // namespace

std::vector<std::string> in_family(std::vector<std::string> ids, const std::string& family) {
  const auto& known = families();
  const bool all = family == "all";
  require(all || std::find(known.begin(), known.end(), family) != known.end(), Exit::kUsage,
          "no family is called ", family,
          "; there are plain, tremor, load, clock, field, hardware, wrench and all");
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const std::string& one = all ? known[k % known.size()] : family;
    if (one == "hardware") ids[k] = with_hardware(ids[k], all ? k / known.size() : k);
    if (one != "plain") ids[k] = one + "+" + ids[k];
  }
  return ids;
}

}  // namespace dcnn::conceal
