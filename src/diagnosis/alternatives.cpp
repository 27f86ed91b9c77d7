// SPDX-License-Identifier: Apache-2.0
// Other names for the same numbers: what the recordings cannot exclude.
#include <algorithm>

#include "dcnn/diagnosis/decision.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/evidence/structure.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

/// Weighs other models against the one at hand in one setting.
class Scale {
 public:
  Scale(const Setting& setting, const JointFit& own) : setting_(setting), own_(own) {}
  const JointFit& own() const { return own_; }
  double log_odds_of(const JointFit& other) {
    if (!grid_) {  // made where there is an alternative
      grid_.emplace(setting_);
      log_own_ = evidence::log_named_of(setting_, *grid_, own_);
    }
    return evidence::log_named_of(setting_, *grid_, other) - log_own_;
  }

 private:
  const Setting& setting_;
  const JointFit& own_;
  std::optional<evidence::Grid> grid_;
  double log_own_ = 0.0;
};

std::vector<double> noisier(const std::vector<Floor>& other, const std::vector<Floor>& own) {
  std::vector<double> list;
  for (std::size_t j = 0; j < own.size(); ++j) {
    list.push_back(other[j].pose_variance() - own[j].pose_variance());
  }
  return list;
}

}  // namespace

std::vector<std::vector<Alternative>> Search::alternatives() const {
  const double price = setting_->price, loud = rest_loudness();
  Scale at_hand(*setting_, fit_);
  const auto brings_noise = [&](const Member& m) { return brings_position_noise(study_, m); };
  const auto has_noise = [&](const JointFit& fit) {
    return std::any_of(fit.members.begin(), fit.members.end(), brings_noise);
  };
  const bool own_noise = has_noise(fit_);
  std::vector<std::vector<Alternative>> all(fit_.members.size());
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const Member& own = fit_.members[m];
    if (own.fixed) continue;
    const JointFit& rest = without(m);
    const double told = net_gain_as_trial(m), own_gain = gain(m);
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
      JointFit other = joint_fit(*setting_, members);
      const double taken_off = rest.chi2 - other.chi2;
      // That a motion is derived with an error speaks for no law that needs none: both are weighed
      // beside the noise of that motion.
      std::optional<Surroundings> theirs;
      std::optional<JointFit> own_there;
      std::optional<Scale> there;
      if (has_noise(other) != own_noise) theirs.emplace(surroundings(other.members));
      if (theirs && !own_noise) {
        theirs->setting->price = price;
        own_there = joint_fit(*theirs->setting, fit_.members);
        other = joint_fit(*theirs->setting, other.members);
        there.emplace(*theirs->setting, *own_there);
      }
      Scale& scale = there ? *there : at_hand;
      const double above = other.chi2 - scale.own().chi2;
      // One that needs more numbers holds the named one as a special case: where they gain nothing,
      // nothing speaks for it.
      const int numbers = trial.member.parameters(), more = numbers - own.parameters();
      const double near = 0.1 * kAsLikely * price;
      double least = more > 0 ? kLeastOfMore * price * more * loud : price * more - near;
      // A small force hides how it bends.
      if (more > 0 && same_family(trial.member, own))
        least = std::min(least, prior::kOtherBend * own_gain - near);
      // Nor does noise stand in its place.
      const double noise = least_gain(*setting_, numbers, rest.members.empty()) - near;
      if (-above <= least || taken_off <= noise) continue;
      if (has_untold_shape(*setting_, other)) continue;
      const Alternative found{.name = trial.member.name(),
                              .members = other.members,
                              .base = other.base,
                              .floors = there ? theirs->floors : floors_,
                              .noisier = theirs ? noisier(theirs->floors, floors_)
                                                : std::vector<double>(floors_.size(), 0.0),
                              .log_odds = scale.log_odds_of(other),
                              .chi2_above = above};
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
