// SPDX-License-Identifier: Apache-2.0
#include "check/combined.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "check/kind.h"
#include "check/priors.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr double kAsLikely = 0.99;  // the same reading, but for rounding, or a better one

using Chain = std::vector<Reading>;  // empty: as declared

/// Every choice of at most one variant of each kind that combines.
std::vector<Chain> chains_of(const Log& log, const Reading& declared) {
  std::vector<Chain> chains{{}};
  for (const FaultKind* kind : fault_kinds()) {
    if (!kind->combines) continue;
    const std::size_t before = chains.size();
    for (std::size_t k = 0; k < before; ++k) {
      Reading from = chains[k].empty() ? declared : chains[k].back();
      say_nothing(from);
      std::vector<Reading> variants;
      kind->readings(log, from, variants);
      for (Reading& variant : variants) {
        variant.fault = kind->id;
        variant.prior = from.prior * kFaultPrior / static_cast<double>(variants.size());
        chains.push_back(chains[k]);
        chains.back().push_back(std::move(variant));
      }
    }
  }
  return chains;
}

bool has(const Chain& chain, const std::string& fault) {
  return std::any_of(chain.begin(), chain.end(),
                     [&](const Reading& part) { return part.fault == fault; });
}

}  // namespace

Combined combine(const Log& log, const Sampled& rows, const Reading& declared,
                 const Reading& rival) {
  std::map<double, Kinematics> motions;  // by the unit of angles; the orientation is one
  const std::vector<Chain> chains = chains_of(log, declared);
  const Kinematics own = kinematics(log, rows, rival);
  std::vector<double> weights;
  for (const Chain& chain : chains) {
    Reading reading = chain.empty() ? declared : chain.back();
    if (has(chain, "position_unit")) reading.fault = "position_unit";
    if (!motions.contains(reading.angle)) {
      motions.emplace(reading.angle, kinematics(log, rows, reading));
    }
    weights.push_back(finite_log_weight(log, rows, &motions.at(reading.angle), reading));
  }
  weights.push_back(finite_log_weight(log, rows, &own, rival));
  const double most = *std::max_element(weights.begin(), weights.end());
  double sum = 0.0;
  for (double& weight : weights) sum += weight = elementary::exp(weight - most);
  std::size_t best = 0;
  for (std::size_t k = 1; k < chains.size(); ++k) {
    if (weights[k] > weights[best]) best = k;
  }
  Combined out;
  if (chains[best].size() < 2 || weights.back() > kAsLikely * weights[best]) return out;
  for (const Reading& part : chains[best]) {
    double probability = 0.0;
    for (std::size_t k = 0; k < chains.size(); ++k) {
      if (has(chains[k], part.fault)) probability += weights[k] / sum;
    }
    out.probability.push_back(probability);
    out.parts.push_back(part);
  }
  return out;
}

}  // namespace dcnn::check
