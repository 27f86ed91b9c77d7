// SPDX-License-Identifier: Apache-2.0
// What is added to a model, and what is left out again.
#include <algorithm>
#include <string>

#include "diagnosis/evidence/priors.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

using prior::kModelError;

// More only ever fed what is not in the catalogue; but friction acts in every direction.
constexpr int kMostMembers = 5, kMostFrictions = 14;

}  // namespace

/// Adds the effect that gains most, if it gains enough and is itself where the fit ends.
bool Search::grow() {
  const auto frictions =
      std::count_if(fit_.members.begin(), fit_.members.end(),
                    [](const Member& m) { return m.kind->axis == AxisRule::kLine; });
  const auto others = static_cast<std::ptrdiff_t>(fit_.members.size()) - frictions;
  if (others >= kMostMembers || frictions >= kMostFrictions) return false;
  say("searching for effects (" + std::to_string(fit_.members.size()) + " found so far)");
  auto trials = additions();
  std::erase_if(trials, [&](const Trial& trial) {
    return trial.gain < least_gain(*setting_, trial.member.parameters(), fit_.members.empty());
  });
  if (trials.empty()) return false;
  // Poses at rest have no error of the motion, but that of the law.
  const double share = study_.is_static() ? kModelError * kModelError : prior::kLeastShare;
  const double least = share * explained(false);
  const std::vector<Member> before = fit_.members;
  for (const Trial& trial : trials) {
    if (trial.gain < least) break;
    if (may_be_slow_noise(trial.member) && admit_slow_noise()) return true;
    settle(with_member(before, trial.member));
    const bool possible = std::none_of(fit_.members.begin(), fit_.members.end(),
                                       [&](const Member& m) { return rests_at_bound(study_, m); });
    if (possible) return true;
    settle(before);
  }
  return false;
}

/// Of members whose forces cancel each other, so that each is a multiple of what all make together,
/// the one that gains least: the recordings tell of such a pair the sum alone.
std::optional<std::size_t> Search::cancelled() const {
  constexpr double kMultiple = 5.0;  // of two equal forces 11 degrees from cancelling
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(fit_.residual.size());
  std::vector<Eigen::VectorXd> forces;
  Eigen::VectorXd sum = zero;
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const Member& member = fit_.members[m];
    const Index first = tangent_columns(fit_, m).first, numbers = member.amplitudes.size();
    const bool tells = !member.fixed && numbers > 0;
    forces.push_back(tells ? fit_.tangent.middleCols(first, numbers) * member.amplitudes : zero);
    sum += forces.back();
  }
  std::optional<std::size_t> least;
  for (std::size_t m = 0; m < forces.size(); ++m) {
    if (stays(fit_.members[m]) || forces[m].norm() <= kMultiple * sum.norm()) continue;
    if (!least || gain(m) < gain(*least)) least = m;
  }
  return least;
}

/// Puts a law's plain form in the place of one that bends it and does not leave less by what its
/// further numbers cost: a bent law is found where a plain one acts beside another that is missing.
bool Search::straighten() {
  bool changed = false;
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const Member& member = fit_.members[m];
    const auto plain = plain_form(study_, member);
    if (!plain || plain->own_shapes() > 0 || stays(member)) continue;
    const int fewer = member.parameters() - plain->parameters();
    if (fewer <= 0) continue;
    std::vector<Member> members = fit_.members;
    members[m] = *plain;
    const JointFit other = joint_fit(*setting_, std::move(members));
    if (other.chi2 - fit_.chi2 > setting_->price * fewer) continue;
    settle(std::vector<Member>(other.members));
    changed = true;
  }
  return changed;
}

/// Leaves out members that no longer earn their numbers, are another law where the fit ends, or
/// cancel each other.
bool Search::simplify() {
  bool changed = straighten();
  while (const auto member = cancelled()) {
    settle(std::vector<Member>(without(*member).members));
    changed = true;
  }
  for (std::size_t m = 0; m < fit_.members.size() && fit_.members.size() > 1;) {
    if (stays(fit_.members[m])) {
      ++m;
      continue;
    }
    if (gain(m) >= least_gain(*setting_, fit_.members[m].parameters(), false) &&
        !rests_at_bound(study_, fit_.members[m])) {
      ++m;
      continue;
    }
    settle(std::vector<Member>(without(m).members));
    changed = true;
    m = 0;
  }
  return changed;
}

}  // namespace dcnn
