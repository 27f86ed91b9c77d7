// SPDX-License-Identifier: Apache-2.0
// The structures that the judgement leaves: the members, each without some of them, with and
// without an unknown.
#include <algorithm>

#include "diagnosis/evidence/priors.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

constexpr std::size_t kAllSubsets = 3;  // members up to which every subset is weighed

/// Which of `count` members a structure holds: all subsets of few, else all but one and none.
std::vector<std::vector<bool>> choices(std::size_t count) {
  std::vector<std::vector<bool>> list;
  if (count <= kAllSubsets) {
    for (std::size_t bits = 0; bits < std::size_t{1} << count; ++bits) {
      list.emplace_back();
      for (std::size_t k = 0; k < count; ++k) list.back().push_back((bits >> k) & 1);
    }
    return list;
  }
  list.emplace_back(count, true);
  list.emplace_back(count, false);
  for (std::size_t k = 0; k < count; ++k) {
    list.emplace_back(count, true);
    list.back()[k] = false;
  }
  return list;
}

}  // namespace

std::size_t Search::weigh_once() {
  std::vector<Member> free = fit_.members;
  std::erase_if(free, [](const Member& m) { return m.fixed; });
  const evidence::Grid grid(*setting_);
  std::vector<evidence::Structure> structures;
  for (const std::vector<bool>& chosen : choices(free.size())) {
    std::vector<Member> members = apart_;
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (chosen[k]) members.push_back(free[k]);
    }
    structures.push_back(evidence::structure_of(*setting_, grid, joint_fit(*setting_, members)));
  }
  posterior_ = evidence::posterior_of(std::move(structures), rounding_ || impacts_.member);
  if (names().size() < fit_.members.size()) posterior_.hold_a_law();
  return posterior_.most_probable();
}

void Search::weigh() {
  say("computing the probabilities of what was found, of nothing and of an unknown effect");
  std::size_t best = weigh_once();
  // A machine leaves more than its noise: there its law's own error decides what is a finding.
  if (study_.axis) return;
  bool smaller = false;
  // Beside an unknown, which may take the place of any of them, the names stay as they were judged.
  while (posterior_.named_and_unknown + posterior_.unknown < 0.5 &&
         posterior_.structures[best].members.size() < fit_.members.size()) {
    settle(std::vector<Member>(posterior_.structures[best].members));
    best = weigh_once();
    smaller = true;
  }
  if (smaller || study_.is_static()) {  // poses at rest have no spectrum
    judge_rest();
    return;
  }
  // A spectrum a little above the floor alone is noise, and a field alone the error of a law: what
  // remains depends on what moves, or has more power than noise of a free spectrum.
  const bool unknown = posterior_.named_and_unknown + posterior_.unknown > 0.5;
  const bool loud = loudest(bands_) > prior::kMostFreeNoise;
  remains_ = (remains_ || unknown) && (loud || depends_on_motion());
}

void Search::judge_rest() {
  bands_ = band_tests(*setting_, fit_.residual);
  remains_ = posterior_.named_and_unknown + posterior_.unknown > 0.5;
}

void Search::leave_out(const std::vector<std::size_t>& members) {
  std::vector<Member> rest;
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (std::find(members.begin(), members.end(), m) == members.end()) {
      rest.push_back(fit_.members[m]);
    } else {
      refuted_.push_back(fit_.members[m]);
    }
  }
  const bool held =
      std::any_of(rest.begin(), rest.end(), [](const Member& m) { return !m.held.empty(); });
  if (!held) return adopt(rest);
  for (Member& m : rest) m.held.clear();  // what was not told beside the others may be told now
  begin_with(rest);
}

bool Search::look_again() {
  constexpr double kAgain = 0.5;  // of a search's limit, once, where it is spent on refuted names
  const auto before = places_of(fit_.members);
  if (is_spent() && !began_again_) {
    began_again_ = true;
    allow(kAgain);
  }
  explore();
  conclude();
  return places_of(fit_.members) != before;
}

void Search::add_beside() {
  beside_own_numbers_ = true;
  allow(1.0);
  while (!is_spent() && grow()) {
    while (simplify()) {
    }
  }
  adopt(std::vector<Member>(fit_.members));
}

void Search::begin_with(const std::vector<Member>& members) {
  settle(members);
  while (simplify()) {
  }
  bands_ = band_tests(*setting_, fit_.residual);
  hold_untold();
  adopt(std::vector<Member>(fit_.members));
}

void Search::adopt(const std::vector<Member>& members) {
  settle(members);
  leave_bounded_lags();  // beside fewer names a lag may go as far as it can
  weigh_once();
  if (study_.axis) {
    remains_ = is_alarming_now();
  } else {
    judge_rest();
  }
}

void Search::begin_anew() {
  std::vector<Member> members = apart_;
  std::erase_if(members, [](const Member& m) { return !m.law.is_null(); });
  hold(members);
}

void Search::leave_idle_names() {
  for (;;) {
    std::optional<std::size_t> least_useful;
    double least = 0.0;
    for (std::size_t m = 0; m < fit_.members.size(); ++m) {
      if (stays(fit_.members[m]) || net_gain(m) >= least) continue;
      least = net_gain(m), least_useful = m;
    }
    if (!least_useful) return;
    hold(members_without(*least_useful));
    weigh_once();
  }
}

std::vector<Member> Search::names() const {
  std::vector<Member> members = fit_.members;
  std::erase_if(members, [](const Member& m) { return !m.law.is_null(); });
  return members;
}

void Search::put_beside(const std::vector<Member>& laws) {
  if (names().size() == fit_.members.size()) {  // the first laws
    allow(1.0);
  }
  std::vector<Member> members = names();
  members.insert(members.end(), laws.begin(), laws.end());
  hold(members);
}

bool Search::name_beside_laws() {
  const std::size_t before = fit_.members.size();
  explore();
  drop_coincidences();
  drop_unconfirmed();
  return fit_.members.size() > before;
}

bool Search::confirms_names() {
  if (is_alarming_now()) return false;
  weigh_once();
  return true;
}

void Search::hold(const std::vector<Member>& members) {
  std::vector<Member> laws = members;
  std::erase_if(laws, [](const Member& m) { return m.law.is_null(); });
  std::erase_if(apart_, [](const Member& m) { return !m.law.is_null(); });
  apart_.insert(apart_.end(), laws.begin(), laws.end());
  settle(members);
  bands_ = band_tests(*setting_, fit_.residual);
}

}  // namespace dcnn
