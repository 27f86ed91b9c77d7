// Other names for the same numbers: what the recordings cannot exclude.
#include <algorithm>

#include "dcnn/diagnosis/decision.h"
#include "diagnosis/evidence/structure.h"
#include "diagnosis/search.h"

namespace dcnn {

std::vector<std::vector<Alternative>> Search::alternatives() const {
  constexpr double kAkaike = 0.2;  // the same for a faint effect (Akaike 1974)
  constexpr double kFaint = 15.0;  // prices
  constexpr double kBend = 0.06;   // of a gain: what another bend of a law is worth
  const double price = setting_->price, loud = rest_loudness();
  std::optional<evidence::Grid> grid;  // made where there is an alternative
  double log_own = 0.0;
  const auto log_odds_of = [&](const JointFit& other) {
    if (!grid) {
      grid.emplace(*setting_);
      log_own = evidence::log_named_of(*setting_, *grid, fit_);
    }
    return evidence::log_named_of(*setting_, *grid, other) - log_own;
  };
  std::vector<std::vector<Alternative>> all(fit_.members.size());
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const Member& own = fit_.members[m];
    if (own.fixed) continue;
    const JointFit& rest = without(m);
    const double told = net_gain_as_trial(m), own_gain = gain(m);
    const double each = own_gain < kFaint * price ? kAkaike : kLeastOfMore;
    for (const Trial& trial : others(m)) {
      // What explains a remainder better than the member explains its own is none in its place.
      if (remains_ && trial.member.axis != own.axis) continue;
      const bool same = trial.member.kind == own.kind;
      if ((same && (trial.member.form == own.form || trial.member.axis != own.axis)) ||
          trial.net_gain() < told - std::max(0.4 * kAsLikely * price, doubt(trial))) {
        continue;
      }
      std::vector<Member> members = rest.members;
      members.push_back(trial.member);
      const JointFit other = joint_fit(*setting_, members);
      // One that needs more numbers holds the named one as a special case: where they gain nothing,
      // nothing speaks for it.
      const int numbers = trial.member.parameters(), more = numbers - own.parameters();
      const double near = 0.1 * kAsLikely * price;
      double least = more > 0 ? each * price * more * loud : price * more - near;
      // A small force hides how it bends.
      if (more > 0 && same_family(trial.member, own))
        least = std::min(least, kBend * own_gain - near);
      // Nor does noise stand in its place.
      const double noise = least_gain(*setting_, numbers, rest.members.empty()) - near;
      if (fit_.chi2 - other.chi2 <= least || rest.chi2 - other.chi2 <= noise) continue;
      if (has_untold_shape(*setting_, other)) continue;
      const Alternative found{trial.member.name(), other.members, other.base, log_odds_of(other),
                              other.chi2 - fit_.chi2};
      const auto listed = std::find_if(all[m].begin(), all[m].end(), [&](const Alternative& a) {
        return a.name == trial.member.name();
      });
      if (listed == all[m].end()) {
        all[m].push_back(found);
      } else if (found.log_odds > listed->log_odds) {
        *listed = found;
      }
    }
  }
  return all;
}

}  // namespace dcnn
