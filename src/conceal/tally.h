// SPDX-License-Identifier: Apache-2.0
// Counting: rates with Wilson intervals, medians and quantiles.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn::conceal {

/// {"k","n","rate","low","high"}: Wilson's 95 % interval (1927); null rates where n is 0.
Json wilson(int k, int n);

/// Numbers under names.
class Tally {
 public:
  void count(const std::string& name, bool yes);
  void add(const std::string& name, double value);
  /// Rates, and {"n","median","p90","p95","max"} of what was added.
  Json summary() const;

 private:
  std::map<std::string, std::pair<int, int>> rates_;
  std::map<std::string, std::vector<double>> values_;
};

constexpr double kWithin = 1.05;  ///< of the true law's held-out error: predicts as well as it

/// How often names were right beside how often they said so: {"n", "said", "right", "brier",
/// "bins": [{"from", "to", "n", "said", "right", "low", "high"}]}; null where no name has a
/// probability.
Json confidence_table(const Json& scenarios);

/// Adds one scored scenario, or one effect of it.
void add_scenario(const Json& scored, Tally& tally);
void add_effect(const Json& effect, Tally& tally);
/// Held-out error before, after, and the estimated floor, each over the true law's.
void add_holdout(const Json& scored, Tally& tally);

}  // namespace dcnn::conceal
