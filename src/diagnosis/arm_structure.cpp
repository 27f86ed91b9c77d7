// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/arm_structure.h"

#include <algorithm>

#include "core/elementary.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn {

using Eigen::VectorXd;

ArmRegression ArmStructureSearch::unweighted(const ArmStructure& structure) const {
  ArmModel model{shared_[structure.shared], {}};
  for (const std::vector<Index>& more : structure.more) {
    std::vector<Index> own;
    for (Index k = 0; k < kOwnFriction; ++k) own.push_back(k);
    own.insert(own.end(), more.begin(), more.end());
    model.own.push_back(std::move(own));
  }
  return {sums_, std::move(model)};
}

ArmRegression ArmStructureSearch::fitted(const ArmStructure& structure) const {
  ArmRegression regression = unweighted(structure);
  regression.reweight();
  return regression;
}

/// A name for each set of shared parameters on the way; one of a joint's for each term.
double ArmStructureSearch::log_prior(const ArmStructure& structure) const {
  const auto odds = [](double p) { return elementary::log(p / (1.0 - p)); };
  const double name = prior::kName;
  double sum = static_cast<double>(structure.shared) * odds(name);
  for (const std::vector<Index>& more : structure.more) {
    sum += static_cast<double>(more.size()) * odds(name / static_cast<double>(sums_.joints()));
  }
  return sum;
}

double ArmStructureSearch::log_odds(const ArmStructure& a, const ArmStructure& b,
                                    const VectorXd& variances) const {
  ArmRegression of_a = unweighted(a), of_b = unweighted(b);
  of_a.set_variances(variances);
  of_b.set_variances(variances);
  return of_a.log_support_against(of_b) + log_prior(a) - log_prior(b);
}

/// Up the sets of shared parameters, from each to the next that is likelier.
ArmStructure ArmStructureSearch::climbed(const ArmStructure& from,
                                         const VectorXd& variances) const {
  ArmStructure best = from;
  for (std::size_t h = from.shared + 1; h < shared_.size(); ++h) {
    ArmStructure next = from;
    next.shared = h;
    if (log_odds(next, best, variances) > 0.0) best = next;
  }
  return best;
}

/// The term that helps most; beside the links' parameters, with which each trial costs a hundred
/// times as much, of those alone that promise most by themselves.
ArmStructure ArmStructureSearch::with_best_term(const ArmStructure& from,
                                                const VectorXd& variances) const {
  constexpr std::size_t kTriedBesideLinks = 14;
  ArmRegression now = unweighted(from);
  now.set_variances(variances);
  const Eigen::MatrixXd promises = now.promises();
  std::vector<std::pair<double, ArmStructure>> next;
  for (std::size_t j = 0; j < sums_.joints(); ++j) {
    for (Index k = kOwnFriction; k < kOwnFriction + kOwnAliases; ++k) {
      const std::vector<Index>& has = from.more[j];
      if (std::find(has.begin(), has.end(), k) != has.end()) continue;
      next.emplace_back(promises(static_cast<Index>(j), k), from);
      next.back().second.more[j].push_back(k);
    }
  }
  std::stable_sort(next.begin(), next.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  ArmStructure best = from;
  double most = 0.0;
  const bool links = shared_[from.shared].cols() > BodyVector::SizeAtCompileTime;
  const std::size_t tried = links ? std::min(kTriedBesideLinks, next.size()) : next.size();
  for (std::size_t k = 0; k < tried; ++k) {
    const double odds = log_odds(next[k].second, from, variances);
    if (odds > most) most = odds, best = std::move(next[k].second);
  }
  return best;
}

/// Takes back one thing without which the rest is as likely; false where there is none.
bool ArmStructureSearch::drop_needless(ArmStructure* structure) const {
  std::vector<ArmStructure> smaller;
  if (structure->shared > 0) smaller.push_back({0, structure->more});
  for (std::size_t j = 0; j < sums_.joints(); ++j) {
    for (std::size_t k = 0; k < structure->more[j].size(); ++k) {
      smaller.push_back(*structure);
      std::vector<Index>& more = smaller.back().more[j];
      more.erase(more.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
  const VectorXd variances = fitted(*structure).variances();
  for (ArmStructure& less : smaller) {
    if (log_odds(*structure, less, variances) > 0.0) continue;
    *structure = std::move(less);
    return true;
  }
  return false;
}

/// Adds what makes the structure likelier, the best first, bodies as well where they may join; then
/// takes back what the rest makes needless.
ArmStructure ArmStructureSearch::grown(ArmStructure now, bool with_bodies) const {
  while (true) {
    const VectorXd variances = fitted(now).variances();
    ArmStructure next = with_best_term(now, variances);
    if (with_bodies) {
      ArmStructure bodies = climbed(now, variances);
      const bool first = bodies.shared != now.shared &&
                         log_odds(bodies, now, variances) >= log_odds(next, now, variances);
      if (first) next = std::move(bodies);
    }
    if (next.shared == now.shared && next.more == now.more) break;
    now = std::move(next);
  }
  while (drop_needless(&now)) {
  }
  return now;
}

ArmStructure ArmStructureSearch::run() const {
  const ArmStructure nothing{0, std::vector<std::vector<Index>>(sums_.joints())};
  ArmStructure without = grown(nothing, false);
  // Terms of all joints together imitate a body, and a body a term: each begins once.
  const ArmStructure body = climbed(nothing, fitted(nothing).variances());
  ArmStructure with = grown(body, true);
  const auto outweighs = [&](const ArmStructure& bodies) {
    const VectorXd variances = fitted(bodies).variances().cwiseMax(fitted(without).variances());
    return log_odds(bodies, without, variances) > 0.0;
  };
  // Terms that joined a body were weighed beside it: against a model without any body the change of
  // all joints is one statistic, whose spread over the pieces is the body's.
  return outweighs(body) || outweighs(with) ? with : without;
}

}  // namespace dcnn
