// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/search.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "diagnosis/candidates.h"
#include "diagnosis/detectors.h"
#include "diagnosis/events.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/law_search.h"
#include "diagnosis/outlying.h"
#include "diagnosis/rest.h"

namespace dcnn {
namespace {

constexpr int kMostRounds = 6;   // of exchanges
constexpr int kMostGrowth = 30;  // of growth: what is added may be left out again

}  // namespace

std::multiset<std::string> places_of(const std::vector<Member>& members) {
  std::multiset<std::string> places;
  for (const Member& m : members) places.insert(m.name() + " " + m.axis);
  return places;
}

Signals difference(const Case& study, const Signals& prediction) {
  Signals left;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    left.push_back(study.logs[k].measured - prediction[k]);
    if (study.logs[k].zeroed) left[k].rowwise() -= left[k].colwise().mean().eval();
  }
  return left;
}

Search::Search(Case study, std::vector<Span> held_out,
               std::function<void(const std::string&)> progress)
    : study_(std::move(study)), progress_(std::move(progress)), held_out_(std::move(held_out)) {
  for (const Log& log : study_.logs) samples_ += log.motion.samples();
  for (const Span& span : rests(study_)) held_out_.push_back(span);
}

double Search::passes() const {
  return static_cast<double>(study_.work->samples()) / static_cast<double>(samples_);
}

void Search::allow(double share) {
  ended_early_ = ended_early_ || is_spent();
  begun_ = std::max(begun_, passes() - (1.0 - share) * kMostPasses);
}

bool Search::laws_are_spent() const { return dcnn::laws_are_spent(study_); }

void Search::say(const std::string& text) const {
  if (progress_) progress_(text);
}

std::vector<Member> Search::members_without(std::size_t member) const {
  std::vector<Member> rest = fit_.members;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(member));
  return rest;
}

const JointFit& Search::without(std::size_t member) const {
  Place& place = places_[member];
  if (!place.rest) place.rest = joint_fit(*setting_, members_without(member));
  return *place.rest;
}

double Search::gain(std::size_t member) const { return without(member).chi2 - fit_.chi2; }

double Search::net_gain(std::size_t member) const {
  return gain(member) - setting_->price * fit_.members[member].parameters();
}

const std::vector<Trial>& Search::others(std::size_t member) const {
  Place& place = places_[member];
  if (!place.others) {
    // An event repairs any law that is a little wrong: it never takes the place of one, but that of
    // another event or of a drift.
    const bool events = may_be_slow_noise(fit_.members[member]);
    place.others = additions(without(member), events, net_gain(member));
  }
  return *place.others;
}

void Search::forget_places() {
  places_.clear();
  places_.resize(fit_.members.size());
}

double Search::explained(bool all) const {
  std::vector<Member> exact = fit_.members;
  std::erase_if(exact, [&](const Member& m) {
    const bool fitted = m.fixed || all || m.parameters() > 0;
    return fitted && (m.driver || !m.kind->is_constant);
  });
  // A simulator in another unit is none of the model's merits: no more than what was measured.
  const double most =
      setting_->mask.cwiseProduct(setting_->whitened(setting_->measured)).squaredNorm();
  return std::clamp(joint_fit(*setting_, exact).chi2 - fit_.chi2, 0.0, most);
}

bool Search::stays(const Member& member) const {
  return member.fixed || (ringing_ && member.kind->stage == Stage::kResonance);
}

bool Search::rings() const {
  return std::any_of(fit_.members.begin(), fit_.members.end(), [](const Member& m) {
    return !m.fixed && m.kind->stage == Stage::kResonance;
  });
}

double Search::doubt(const Trial& trial) const {
  return (study_.rounding_step > 0.0 ? prior::kTangentErrorRounded : prior::kTangentError) *
         trial.gain;
}

/// Exchanges a member for another effect that serves better in its place.
bool Search::swap() {
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (stays(fit_.members[m])) continue;
    if (is_spent()) return false;
    const JointFit& rest = without(m);
    const double own = net_gain(m), told = net_gain_as_trial(m);
    for (const Trial& trial : others(m)) {
      // The same effect counts where it has better shapes than those that it was found with.
      if (trial.member.kind == fit_.members[m].kind && trial.member.axis == fit_.members[m].axis &&
          trial.net_gain() < own + setting_->price) {
        continue;
      }
      const double doubtful =
          is_degenerate(fit_.members[m]) ? prior::kTangentErrorAtBound * trial.gain : 0.0;
      if (trial.net_gain() < told - std::max({2.0 * setting_->price, doubt(trial), doubtful}))
        break;
      const std::vector<Member> members = with_member(rest.members, trial.member);
      const JointFit other = joint_fit(*setting_, members);
      const int fewer = fit_.members[m].parameters() - trial.member.parameters();
      const bool gives_way = is_degenerate(fit_.members[m]) && fewer > 0;
      const double least = own + setting_->price * (gives_way ? -fewer : 0.2);
      const int numbers = trial.member.parameters();
      const double better = rest.chi2 - other.chi2;
      // What noise reaches takes no place; on a machine simplify() sees to that.
      const double needed =
          study_.axis ? 0.0 : least_gain(*setting_, numbers, rest.members.empty());
      if (better - setting_->price * numbers > least && better >= needed) {
        settle(members);
        return true;
      }
    }
  }
  return false;
}

/// Adds, exchanges and leaves out effects until nothing gains.
void Search::explore() {
  bool recut = false;
  for (int round = 0; round < kMostRounds && !is_spent(); ++round) {
    while (simplify()) {
    }
    for (int steps = 0; steps < kMostGrowth && !is_spent(); ++steps) {
      const auto before = places_of(fit_.members);
      if (!grow()) break;
      tune_to_mode();
      while (simplify()) {
      }
      if (places_of(fit_.members) == before) break;  // what was added does not earn its numbers
      if (fit_.members.size() == apart_.size() + 2 && !study_.without.exchange) replace_pairs();
    }
    if (fit_.members.empty() || fit_.members.size() == apart_.size()) return;
    say("trying other effects in place of those found so far");
    if (!study_.without.exchange && (swap() || replace_pairs())) continue;
    if (recut || study_.is_static()) return;
    recut = true;
    const bool lag = std::any_of(fit_.members.begin(), fit_.members.end(),
                                 [](const Member& m) { return m.kind->stage == Stage::kDynamics; });
    const double before = study_.derivative.cutoff_hz;
    // A long lag fools the first choice; otherwise names do not depend on a small error of it.
    if (!lag && !is_alarming(band_tests(*setting_, fit_.residual), explained(true))) {
      pass_more_motion();
      return;
    }
    choose_cutoff(fit_.members);
    settle(fit_.members);
    if (std::abs(study_.derivative.cutoff_hz / before - 1.0) < 0.1) return;
  }
}

bool Search::mask_outlying() {
  // On a tool a foreign force is an effect of its own, and found as such.
  if (study_.is_static() || is_listed(study_, *find_effect("contact"))) return false;
  auto spans = outlying(*setting_, left_, held_out_);
  if (spans == outlying_) return false;
  outlying_ = std::move(spans);
  settle(fit_.members);
  return true;
}

std::vector<Member> Search::to_begin_with() const { return is_spent() ? fit_.members : apart_; }

bool Search::swamps_noise() {
  if (is_inexact() || study_.is_static()) return false;
  swamped_ = fit_.chi2 > prior::kSwamped * prior::kSwamped * setting_->mask.sum();
  return swamped_;
}

void Search::run() {
  choose_cutoff({});
  settle({});
  detect();
  settle(apart_);
  mask_outlying();
  explore();
  if (swamps_noise()) {
    settle(apart_);
    explore();
  }
  if (begin_with_own_numbers()) explore();
  search_beside_common_laws();
  if (mask_outlying()) explore();  // beside a law other things are outlying
  if (hums_no_more()) explore();
  // After larger effects: what is left of a mode that is not in the model resembles impacts.
  if (detect_impacts()) {
    settle(to_begin_with());
    explore();
    if (!still_has_impacts()) search_without_impacts();
  }
  let_ring();
  conclude();
}

void Search::search_without_impacts() {
  settle(fit_.members);
  while (simplify()) {
  }
  explore();
}

void Search::leave_impacts() {
  impacts_ = {};
  search_without_impacts();
  conclude();
}

void Search::conclude() {
  judge();
  hold_untold();  // a number that is not told would weigh against its effect
  const std::size_t judged = fit_.members.size();
  weigh();
  if (fit_.members.size() < judged) hold_untold();
  straighten_drifts();
  leave_untold_parts();
  leave_untold_bends();
}

}  // namespace dcnn
