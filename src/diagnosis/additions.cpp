// SPDX-License-Identifier: Apache-2.0
// The effects that would gain most next to a model.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "diagnosis/candidates.h"
#include "diagnosis/events.h"
#include "diagnosis/position_bins.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

constexpr Index kFine = 6;            // of these, looked at in full detail
constexpr std::size_t kRefined = 10;  // candidates whose shapes are refined before a decision
constexpr double kPromising = 0.4;    // of the gain needed, after a first refinement
constexpr double kNear = 0.8;         // of the gain needed, after a second one
constexpr double kNearRounded = 0.4;  // the same where rounding bends every tangent

/// An effect acts along an axis once, or at many frequencies or orders: those that recordings so
/// long, or so long a motion, tell from others.
bool same_place(const Member& a, const Member& b, double seconds) {
  constexpr double kPeriods = 2.0;  // over the whole, by which two lines differ
  if (a.kind != b.kind || a.axis != b.axis || a.interval_s || b.interval_s) return false;
  if (is_undriven(a, b)) return false;
  if (!a.kind->at_many) return true;
  const bool of_time = a.shape(0).peak == ShapeParameter::Peak::kLine;
  const double period = of_time ? 1.0 / seconds : a.least_shapes(0) / kFewestTurns;
  return std::abs(a.shapes(0) - b.shapes(0)) < kPeriods * period;
}

/// Both act along one line; that of alpha:base_x is base_x.
bool same_line(const Member& a, const Member& b) {
  const auto line = [](const Member& m) { return m.axis.substr(m.axis.find(':') + 1); };
  return line(a) == line(b);
}

/// Dry friction is a Stribeck curve that does not fall, and one of gears that does not vary: the
/// other takes its place, or none.
bool both_dry(const Member& a, const Member& b) {
  const auto dry = [](const Member& m) { return m.kind->friction == EffectKind::Friction::kDry; };
  return same_line(a, b) && dry(a) && dry(b);
}

bool same_angle(const Member& a, const Member& b) {
  const auto angle = [](const Member& m) { return m.axis.substr(0, m.axis.find(':')); };
  return angle(a) == angle(b);
}

/// A spring and less than a turn of a wave in one angle bend as any curved spring does, and are
/// neither: beside the one, or a simulator that has it, the other needs a whole turn.
void keep_apart(const Case& study, std::vector<Member>& list, const std::vector<Member>& members) {
  using Course = EffectKind::Course;
  const auto beside = [&](const Member& candidate, Course course, const auto& condition) {
    return std::any_of(members.begin(), members.end(), [&](const Member& m) {
      return m.kind->course == course && same_angle(m, candidate) && condition(m);
    });
  };
  const auto any = [](const Member&) { return true; };
  const auto slow = [](const Member& wave) {
    return wave.shapes(0) < wave.least_shapes(0) / kFewestTurns;
  };
  const auto& kinds = effect_kinds();
  const bool is_given = std::any_of(kinds.begin(), kinds.end(), [&](const EffectKind* kind) {
    return kind->course == Course::kStraight && is_in_base(study, *kind);
  });
  for (Member& candidate : list) {
    if (candidate.kind->course != Course::kWave) continue;
    if (!is_given && !beside(candidate, Course::kStraight, any)) continue;
    candidate.least_shapes /= kFewestTurns;
    candidate.shapes = candidate.shapes.cwiseMax(candidate.least_shapes);
  }
  std::erase_if(list, [&](const Member& candidate) {
    return candidate.kind->course == Course::kStraight && beside(candidate, Course::kWave, slow);
  });
}

}  // namespace

bool Search::was_refuted(const Member& candidate) const {
  const double seconds = longest_seconds(study_);
  return std::any_of(refuted_.begin(), refuted_.end(),
                     [&](const Member& m) { return same_place(m, candidate, seconds); });
}

double Search::net_gain_as_trial(std::size_t member) const {
  const Member& own = fit_.members[member];
  double most = 0.0;
  for (const Trial& trial : others(member)) {
    const bool same = trial.member.kind == own.kind && trial.member.axis == own.axis;
    if (same) most = std::max(most, trial.net_gain());
  }
  return most > 0.0 ? std::min(most, net_gain(member)) : net_gain(member);
}

std::vector<Trial> Search::additions(bool events) const {
  return additions(fit_, events, std::nullopt);
}

std::vector<Trial> Search::additions(const JointFit& fit, bool events,
                                     std::optional<double> needed) const {
  const Scan scan(*setting_, fit);
  const Signals left = difference(study_, scan.chain().prediction());
  const double seconds = longest_seconds(study_);
  // The best seed of each form of an effect on an axis, then the best places of each effect.
  std::map<std::tuple<std::string, std::string, const EffectFit*>, Trial> places;
  const auto effect_of = [](const Member& member) {
    return member.name() + (member.driver ? " driven by " + member.driver->signal : "");
  };
  const auto look_at = [&](const std::vector<Member>& list) {
    std::vector<Trial> trials(list.size());
    for_each_piece(static_cast<Index>(list.size()), [&](Index k) {
      const Member& member = list[static_cast<std::size_t>(k)];
      const auto is_at = [&](const Member& m) { return same_place(m, member, seconds); };
      const bool taken =
          was_refuted(member) || set_aside_.count(member.kind) > 0 ||
          std::any_of(fit.members.begin(), fit.members.end(), [&](const Member& m) {
            return is_at(m) || (study_.axis && both_dry(m, member) && !is_undriven(m, member));
          });
      if (!taken) trials[static_cast<std::size_t>(k)] = scan.evaluate(member, Detail::kCoarse);
    });
    for (const Trial& trial : trials) {
      if (!trial.member.kind || trial.gain <= 0.0) continue;
      Trial& best = places[{effect_of(trial.member), trial.member.axis, trial.member.form}];
      if (trial.gain > best.gain) best = trial;
    }
  };
  std::vector<Member> list = candidates(scan, left, floors_);
  keep_apart(study_, list, fit.members);
  look_at(list);
  std::vector<Member> plain = fit.members;
  for (const auto& [place, trial] : places) plain.push_back(trial.member);
  look_at(driven_candidates(study_, plain));
  std::vector<Trial> ranked;
  for (const auto& [place, trial] : places) ranked.push_back(trial);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Trial& a, const Trial& b) { return a.gain > b.gain; });
  std::map<std::string, int> seen;
  std::vector<Trial> chosen;
  for (const Trial& trial : ranked) {
    if (seen[effect_of(trial.member)]++ >= 2) continue;
    if (chosen.size() >= kRefined && trial.gain < 0.3 * ranked.front().gain) break;
    chosen.push_back(trial);
    if (chosen.size() >= 2 * kRefined) break;
  }
  const auto by_net_gain = [](const Trial& a, const Trial& b) {
    return a.net_gain() > b.net_gain();
  };
  /// How many come near what is needed, best first.
  const auto near = [&](double share) {
    std::stable_sort(chosen.begin(), chosen.end(), by_net_gain);
    const double least = share * needed.value_or(chosen.empty() ? 0.0 : chosen[0].net_gain());
    return static_cast<Index>(std::count_if(chosen.begin(), chosen.end(), [&](const Trial& trial) {
      return trial.net_gain() >= least;
    }));
  };
  for_each_piece(static_cast<Index>(chosen.size()), [&](Index k) {
    Trial& trial = chosen[static_cast<std::size_t>(k)];
    trial = scan.approach(trial);
  });
  for_each_piece(near(kPromising), [&](Index k) {
    Trial& trial = chosen[static_cast<std::size_t>(k)];
    trial = scan.refine(trial, Detail::kCoarse, 40);
  });
  const Index fine = near(study_.rounding_step > 0.0 ? kNearRounded : kNear);
  for_each_piece(std::min(kFine, fine), [&](Index k) {
    Trial& trial = chosen[static_cast<std::size_t>(k)];
    trial = scan.refine(scan.evaluate(trial.member, Detail::kFine), Detail::kFine, 14);
  });
  if (events && events_allowed_ && !study_.is_static()) {
    if (is_listed(study_, *find_effect("contact"))) chosen.push_back(find_contact(scan));
    if (is_listed(study_, *find_effect("step_bias"))) chosen.push_back(find_step(scan));
  }
  std::erase_if(chosen, [](const Trial& trial) { return trial.gain <= 0.0; });
  std::stable_sort(chosen.begin(), chosen.end(), by_net_gain);
  return chosen;
}

}  // namespace dcnn
