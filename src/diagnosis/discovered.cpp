// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/discovered.h"

#include <algorithm>
#include <map>
#include <set>

#include "diagnosis/candidates.h"
#include "diagnosis/laws.h"
#include "diagnosis/names_alone.h"

namespace dcnn {

using discovery::Discovered;

namespace {

constexpr int kFewestNumbers = 2;  // of a law: its size, and a scale or a power

bool can_hold_laws(const Case& study) {
  if (study.is_static() || !study.axis_moves) return false;
  if (!is_listed(study, *find_effect("discovered"))) return false;
  return std::all_of(study.logs.begin(), study.logs.end(), [](const Log& log) {
    return log.motion.v_B.rows() == log.motion.samples() &&
           log.motion.a_B.rows() == log.motion.samples();
  });
}

/// Looks for names beside laws; those that are found stand where both, fitted again, leave nothing.
void name_beside(Search& search, Laws& laws) {
  const std::vector<Member> before = search.fit().members;
  if (search.name_beside_laws()) {
    Laws again = borne_out(search.setting(), joint_fit(search.setting(), search.names()));
    if (!again.found.empty()) search.put_beside(again.members);
    if (!search.confirms_names()) {
      search.hold(before);
    } else if (!again.found.empty()) {
      laws = std::move(again);
    }
  }
  laws = those_in(search.fit().members, std::move(laws));
}

/// Lets laws stand beside other names where they explain as much for their numbers; whether it did.
bool put_in_place(Search& search, Laws& laws, std::vector<Member> names, Laws again) {
  if (again.found.empty() || again.found.size() > laws.found.size()) return false;
  const Setting& setting = search.setting();
  names.insert(names.end(), again.members.begin(), again.members.end());
  const std::vector<Member>& all = search.fit().members;
  const double lost = joint_fit(setting, names).chi2 - search.fit().chi2;
  if (lost > setting.price * (numbers_of(laws, all) - numbers_of(again, names))) return false;
  search.hold(names);
  laws = std::move(again);
  return true;
}

/// Leaves out names without which the laws, fitted or looked for again, explain as much for their
/// numbers: what had no name may have been taken for one in part.
void leave_needless_names(Search& search, Laws& laws) {
  for (std::size_t m = search.names().size(); m-- > 0;) {
    std::vector<Member> rest = search.names();
    if (rest[m].fixed) continue;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(m));
    const Setting& setting = search.setting();  // another one after each change
    const JointFit fit = joint_fit(setting, rest);
    if (put_in_place(search, laws, rest, borne_out_again(setting, fit, laws))) continue;
    if (!search.laws_are_spent()) put_in_place(search, laws, rest, borne_out(setting, fit));
  }
}

/// All members but the law that stands there among those without a name.
std::vector<Member> without_law(std::vector<Member> members, std::size_t place) {
  for (auto m = members.begin(); m != members.end(); ++m) {
    if (m->law.is_null() || place-- > 0) continue;
    members.erase(m);
    break;
  }
  return members;
}

/// Leaves out laws that are names which held-out data refuted: such a name in its place explains as
/// much, but for what any law must gain.
void leave_refuted_forms(Search& search, Laws& laws) {
  for (std::size_t k = laws.found.size(); k-- > 0;) {
    const std::vector<Member> all = search.fit().members, rest = without_law(all, k);
    const Laws others = without(laws, k);
    const Setting& setting = search.setting();
    const bool refuted =
        std::any_of(search.refuted().begin(), search.refuted().end(), [&](const Member& member) {
          std::vector<Member> named = rest;
          named.push_back(member);
          const double lost = joint_fit(setting, named).chi2 - search.fit().chi2,
                       saved = setting.price * (numbers_of(laws, all) - numbers_of(others, named));
          return lost < saved + least_gain_of_law(setting);
        });
    if (!refuted) continue;
    search.hold(rest);
    laws = others;
  }
}

/// A law may be an effect that has a name, which what is unknown hid: whether a name in its place
/// explains as much, but for what any law must gain to be accepted in the place of names. It then
/// stands, and laws are looked for beside it.
bool name_in_place_of_one(Search& search, Laws& laws) {
  constexpr std::size_t kMostTrials = 3;  // a limit of computation
  const std::vector<Member> before = search.fit().members;
  for (std::size_t k = 0; k < laws.found.size(); ++k) {
    Laws others = without(laws, k);
    search.put_beside(others.members);
    auto trials = search.additions(/*events=*/false);
    if (trials.size() > kMostTrials) trials.resize(kMostTrials);
    for (const Trial& trial : trials) {
      // Without the law the others have moved far off, to explain a part of what it did.
      std::vector<Member> named = without_law(before, k);
      named.push_back(trial.member);
      search.settle(named);
      const double lost = search.fit().chi2 - joint_fit(search.setting(), before).chi2,
                   saved = search.setting().price *
                           (numbers_of(laws, before) - numbers_of(others, named));
      if (lost < saved + least_gain_of_law(search.setting())) {
        const Setting& setting = search.setting();
        Laws again;
        if (!search.laws_are_spent()) {
          again = borne_out(setting, joint_fit(setting, search.names()));
        }
        if (!again.found.empty()) {
          search.put_beside(again.members);
          others = std::move(again);
        }
        search.confirms_names();
        laws = std::move(others);
        return true;
      }
    }
    search.hold(before);
  }
  return false;
}

/// Whether a law's curve, its first shape, goes as far as it may: the catalogue does not have it.
/// The second of friction before sliding is its damping, which few recordings tell.
bool is_out_of_shape(const Member& member) {
  return member.own_shapes() > 0 && is_at_bound(member, 0);
}

/// Places of the names that one law may stand for: those along one axis; and of a machine, whose
/// laws all act along its own, all that are none of its numbers, where one is out of shape.
std::set<std::vector<std::size_t>> laws_in_parts(const Case& study,
                                                 const std::vector<Member>& members) {
  const std::vector<Member> own = own_parameters(study);
  const auto is_own = [&](const Member& member) {
    return std::any_of(own.begin(), own.end(),
                       [&](const Member& number) { return number.kind == member.kind; });
  };
  std::map<std::string, std::vector<std::size_t>> along;
  std::vector<std::size_t> all;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Member& member = members[m];
    if (member.fixed || member.interval_s) continue;
    const Stage stage = member.kind->stage;
    if (stage == Stage::kForce) along[member.axis].push_back(m);
    const bool settles = stage == Stage::kDynamics && member.amplitudes.size() > 0;
    if ((stage == Stage::kForce || settles) && !is_own(member)) all.push_back(m);
  }
  std::set<std::vector<std::size_t>> parts;
  for (const auto& [axis, names] : along) parts.insert(names);
  const bool at_bound = std::any_of(all.begin(), all.end(),
                                    [&](std::size_t m) { return is_out_of_shape(members[m]); });
  if (at_bound && study.axis) parts.insert(all);
  return parts;
}

/// Names may be one law that no catalogue has: where it explains more than they, each number of
/// either at its price, by what any law must gain, and held-out data do not speak against it, it
/// stands in their place.
Laws in_place_of_names(Search& search, const HoldOut& holdout) {
  const Setting& setting = search.setting();
  const JointFit& fit = search.fit();
  for (const std::vector<std::size_t>& names : laws_in_parts(search.study(), fit.members)) {
    std::vector<Member> rest = fit.members;
    int numbers = 0;
    bool at_bound = false;  // of a shape
    for (auto m = names.rbegin(); m != names.rend(); ++m) {
      numbers += rest[*m].parameters();
      at_bound = at_bound || is_out_of_shape(rest[*m]);
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(*m));
    }
    if (numbers <= kFewestNumbers && !at_bound) continue;
    // A spring's rest, or what creeps, may have held the machine's.
    const std::size_t left = rest.size();
    if (at_bound && search.study().axis) add_constant(search.study(), rest);
    numbers -= static_cast<int>(rest.size() - left);
    Laws laws = worthy_laws(setting, joint_fit(setting, rest));
    if (laws.found.empty() || !laws.found.front().established) continue;
    laws.found.resize(1);  // the loudest; what it leaves is looked at beside it
    laws.members.resize(1);
    std::vector<Member> other = rest;
    other.push_back(laws.members.front());
    const int more = numbers_of(laws, {}) - numbers;  // its lever among them
    const JointFit with = joint_fit(setting, other);
    if (fit.chi2 - with.chi2 - setting.price * more < least_gain_of_law(setting)) continue;
    const double support =
        holdout.log_support(holdout.prediction(with.members, with.base),
                            holdout.prediction(fit.members, fit.base), search.floors());
    if (support < 0.0) continue;
    search.adopt(rest);  // each of the names may be right: none is refuted
    return laws;
  }
  return {};
}

/// -2 ln of the likelihood, and the price of all numbers.
double penalised_deviance(const Search& search, const Laws& laws) {
  return search.penalised_deviance() + search.setting().price * numbers_of(laws, {});
}

/// Laws beside the names that stand; where those leave something, or are approximations, also from
/// the beginning: beside none, with the names that are found beside them then, and beside each name
/// that gains most next to those before it. (Names that were found without laws may imitate one;
/// once refuted, they are removed together with those that act.) The model of the highest penalised
/// likelihood is kept.
Laws laws_of_the_rest(Search& search) {
  constexpr int kMostNames = 5;  // a limit of computation
  Laws best = borne_out(search.setting(), search.fit());
  search.put_beside(best.members);
  std::vector<Member> members = search.fit().members;
  double least = penalised_deviance(search, best);
  const bool alarming = search.is_alarming_now();
  if (!alarming && are_established(best)) return best;
  search.begin_anew();
  for (int names = 0; names < kMostNames && !search.laws_are_spent(); ++names) {
    const std::vector<Member> before = search.fit().members;
    Laws laws = borne_out(search.setting(), search.fit());
    if (!laws.found.empty()) {
      search.put_beside(laws.members);
      if (names == 0) name_beside(search, laws);  // names that only a law lets be seen
      // One approximation is as good as another, where neither leaves anything.
      const bool better = alarming || are_established(laws);
      if (better && penalised_deviance(search, laws) < least) {
        least = penalised_deviance(search, laws);
        members = search.fit().members;
        best = std::move(laws);
      }
      if (!search.is_alarming_now() && are_established(laws)) break;
      search.hold(before);
    }
    const auto trials = search.additions(/*events=*/false);
    if (trials.empty()) break;
    const Trial& next = trials.front();
    if (next.gain < least_gain(search.setting(), next.member.parameters(), names == 0)) break;
    std::vector<Member> more = before;
    more.push_back(next.member);
    search.settle(more);
  }
  search.hold(members);
  return best;
}

/// Names and laws settled beside each other.
void settle_beside(Search& search, Laws& laws) {
  search.say("fitting effects and laws together");
  leave_needless_names(search, laws);
  name_beside(search, laws);
  constexpr int kMostRounds = 5;  // a limit of computation: each round searches all places again
  int round = 0;
  while (round < kMostRounds && name_in_place_of_one(search, laws)) ++round;
  leave_refuted_forms(search, laws);
  search.leave_untold_parts();
  search.leave_idle_names();
  laws = those_in(search.fit().members, std::move(laws));
}

}  // namespace

std::vector<Discovered> add_discovered(Search& search, const HoldOut& holdout) {
  if (!can_hold_laws(search.study())) return {};
  const NamesAlone names(search, holdout);
  search.say("searching for a law in place of the effects found");
  Laws laws = in_place_of_names(search, holdout);
  if (!laws.found.empty()) {
    search.put_beside(laws.members);
    settle_beside(search, laws);
    if (names.give_way_to(laws)) return laws.found;
    names.put_back();
  }
  if (!search.remains()) return {};
  search.say("searching for a law of what no effect explains");
  laws = laws_of_the_rest(search);
  if (laws.found.empty()) return {};
  settle_beside(search, laws);
  if (names.give_way_to(laws)) return laws.found;
  names.put_back();
  return {};
}

}  // namespace dcnn
