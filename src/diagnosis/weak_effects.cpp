// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/weak_effects.h"

#include <algorithm>

#include "diagnosis/evidence/structure.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostTried = 6;  // a limit of computation

/// The likeliest of the names that gain most beside the members, if it is likelier than none.
std::optional<std::vector<Member>> likeliest(const Search& search, const HoldOut& holdout) {
  const Setting& setting = search.setting();
  const JointFit& fit = search.fit();
  const Signals without = holdout.prediction(fit.members, fit.base);
  const evidence::Grid grid(setting);
  const double log_none = evidence::log_named_of(setting, grid, fit);
  double most = 0.0;
  std::optional<std::vector<Member>> best;
  std::vector<Trial> trials = search.additions(/*events=*/false);
  if (trials.size() > kMostTried) trials.resize(kMostTried);
  for (const Trial& trial : trials) {
    const JointFit other = joint_fit(setting, with_member(fit.members, trial.member));
    const double log_odds = evidence::log_named_of(setting, grid, other) - log_none +
                            holdout.log_support(holdout.prediction(other.members, other.base),
                                                without, search.floors());
    if (log_odds > most) most = log_odds, best = other.members;
  }
  return best;
}

}  // namespace

void add_weak_effects(Search& search, const HoldOut& holdout) {
  if (!search.study().is_static() || holdout.empty()) return;
  if (search.remains() || !search.fit().members.empty()) return;
  if (const auto members = likeliest(search, holdout)) search.adopt(*members);
}

}  // namespace dcnn
