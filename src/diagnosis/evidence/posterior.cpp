// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/posterior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/elementary.h"
#include "diagnosis/evidence/marginal.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn::evidence {

double Posterior::inclusion(const Member& member) const {
  double mass = 0.0;
  for (std::size_t k = 0; k < structures.size(); ++k) {
    const auto& members = structures[k].members;
    const bool holds = std::any_of(members.begin(), members.end(), [&](const Member& m) {
      return m.kind == member.kind && m.axis == member.axis;
    });
    if (holds) mass += without_unknown[k] + with_unknown[k];
  }
  // What lies elsewhere holds the name as often as not.
  return (1.0 - prior::kElsewhere) * mass + 0.5 * prior::kElsewhere;
}

double updated(double probability, double log_factor) {
  const double against = (1.0 - probability) / probability * elementary::exp(-log_factor);
  return std::clamp(1.0 / (1.0 + against), 0.5 * prior::kElsewhere, 1.0 - 0.5 * prior::kElsewhere);
}

double with_elsewhere(double probability, double elsewhere) {
  return (1.0 - elsewhere) * probability + 0.5 * elsewhere;
}

void Posterior::hold_a_law() {
  unknown += std::exchange(nothing, 0.0);
  named_and_unknown += std::exchange(named, 0.0);
}

std::size_t Posterior::most_probable() const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < structures.size(); ++k) {
    const auto mass = [&](std::size_t s) { return without_unknown[s] + with_unknown[s]; };
    if (mass(k) > mass(best)) best = k;
  }
  return best;
}

Posterior posterior_of(std::vector<Structure> structures, bool found_apart) {
  Posterior p;
  std::vector<double> without, with;
  double most = -1e300, gain = 0.0;
  for (const Structure& s : structures) {
    // Slow noise that is more than a sensor's is part of what nobody can name.
    const double unknown =
        s.unknown.log_factor + elementary::log(prior::kUnknown / (1.0 - prior::kUnknown));
    const double slow = s.noise.log_factor;
    without.push_back(s.log_named + (s.noise.plausible ? log_sum({0.0, slow}) : 0.0));
    with.push_back(s.log_named + (s.noise.plausible ? unknown : log_sum({unknown, slow})));
    if (with.back() > most) most = with.back(), gain = s.unknown.gain;
  }
  // Tempered within the class of the unknown, whose sum stays what it is.
  const double mass = log_sum(with), heat = 1.0 / (1.0 + std::max(0.0, gain) / prior::kTempering);
  for (double& l : with) l = most + heat * (l - most);
  const double tempered = log_sum(with);
  for (double& l : with) l += mass - tempered;
  std::vector<double> all = without;
  all.insert(all.end(), with.begin(), with.end());
  const double sum = log_sum(all);
  p.structures = std::move(structures);
  for (std::size_t k = 0; k < p.structures.size(); ++k) {
    p.without_unknown.push_back(elementary::exp(without[k] - sum));
    p.with_unknown.push_back(elementary::exp(with[k] - sum));
    const bool named = found_apart || !p.structures[k].members.empty();
    (named ? p.named : p.nothing) += p.without_unknown.back();
    (named ? p.named_and_unknown : p.unknown) += p.with_unknown.back();
  }
  for (double* part : {&p.nothing, &p.named, &p.named_and_unknown, &p.unknown}) {
    *part = (1.0 - prior::kElsewhere) * *part + prior::kElsewhere / 4.0;
  }
  return p;
}

}  // namespace dcnn::evidence
