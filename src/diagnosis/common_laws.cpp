// SPDX-License-Identifier: Apache-2.0
// A second beginning on a machine: beside the laws that nearly every machine has.
#include <algorithm>

#include "core/elementary.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/name_prior.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

/// Prices of a number that the names of a model cost: one for each number, less what makes a law
/// likelier than others before the recordings (a number costs half of kNumberPrice nats).
double prices(const Case& study, const std::vector<Member>& members) {
  const double other = elementary::log(prior::kName / (1.0 - prior::kName));
  double sum = 0.0;
  for (const Member& m : members) {
    sum += m.parameters();
    if (!m.kind->common) continue;
    sum -= (evidence::log_odds_of_name(study, *m.kind) - other) / (0.5 * kNumberPrice);
  }
  return sum;
}

}  // namespace

double Search::worse(const std::vector<Member>& members) const {
  const JointFit other = joint_fit(*setting_, members);
  return (other.chi2 - fit_.chi2) / setting_->price + prices(study_, other.members) -
         prices(study_, fit_.members);
}

/// Fits those of these laws that take something off, each beside those before it: whether any do.
bool Search::put_common_laws() {
  const std::size_t before = fit_.members.size();
  for (const EffectKind* kind : effect_kinds()) {
    if (!kind->common || is_in_base(study_, *kind)) continue;
    const Scan scan(*setting_, fit_);
    Trial best;
    for (const Member& member : candidates(scan, left_, floors_)) {
      if (member.kind != kind || member.driver) continue;
      const Trial trial = scan.evaluate(member, Detail::kCoarse);
      if (trial.gain > best.gain) best = trial;
    }
    if (best.gain > 0.0) settle(with_member(fit_.members, best.member));
  }
  return fit_.members.size() > before;
}

/// A search that adds one law at a time may begin with another that does the work of two, a lag for
/// viscous and dry friction, a wave of some other order for a weight that is read late, and end
/// there. On a machine it is repeated beside the common laws, where one of them is not among those
/// found, and the likelier of the two models stays: as the noise that each leaves tells, on the
/// mean.
void Search::search_beside_common_laws() {
  if (!study_.axis || fit_.members.size() == apart_.size()) return;
  const auto kinds = effect_kinds();
  const bool are_there = std::all_of(kinds.begin(), kinds.end(), [&](const EffectKind* kind) {
    return !kind->common || is_in_base(study_, *kind) || axes_of(study_, *kind).empty() ||
           std::any_of(fit_.members.begin(), fit_.members.end(),
                       [&](const Member& m) { return m.kind == kind; });
  });
  if (are_there) return;
  say("looking again beside friction and a weight off the axis");
  const std::vector<Member> found = fit_.members;
  const DerivativeSpec smoother = study_.derivative;
  settle(apart_);
  if (put_common_laws()) explore();
  const std::vector<Member> beside = fit_.members;
  const double found_here = worse(found);
  if (study_.derivative.cutoff_hz != smoother.cutoff_hz) {
    study_.derivative = smoother;
    smooth(smoother.cutoff_hz);
  }
  settle(found);
  const double beside_there = worse(beside);
  if (beside_there < found_here) settle(beside);
}

}  // namespace dcnn
