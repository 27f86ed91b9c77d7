// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/confidence.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "dcnn/diagnosis/decision.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/marginal.h"
#include "diagnosis/evidence/posterior.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/exchanges.h"
#include "diagnosis/gear_order.h"

namespace dcnn {
namespace {

void add_support(const Search& search, const HoldOut& holdout,
                 std::vector<std::vector<Alternative>>& alternatives) {
  const JointFit& fit = search.fit();
  const Signals own = holdout.prediction(fit.members, fit.base);
  for (auto& of_member : alternatives) {
    for (Alternative& other : of_member) {
      other.log_support = holdout.log_support(holdout.prediction(other.members, other.base), own,
                                              other.floors, other.noisier);
    }
  }
}

/// What evidence and held-out data exclude is no alternative: a share below e^-6 of the whole,
/// the odds at which a model is no more listed by its chi-square alone (kAsLikely).
void leave_out_improbable(const Search& search,
                          std::vector<std::vector<Alternative>>& alternatives) {
  const double least = elementary::exp(-0.5 * kAsLikely);
  for (auto& of_member : alternatives) {
    const auto masses = masses_of(search, of_member);
    std::vector<Alternative> kept;
    for (std::size_t k = 0; k < of_member.size(); ++k) {
      if (masses[k + 1] >= least) kept.push_back(of_member[k]);
    }
    of_member = std::move(kept);
  }
}

/// Whether another effect is named rather than a member: the likelier by far, held-out data
/// included; of two that make the same force the one that is likelier beforehand, or that the
/// catalogue has first, so that rounding decides nothing.
bool goes_before(const Alternative& other, const Member& own, double odds) {
  constexpr double kSame = 1e-3;       // of odds of 1: rounding, and where a fit ends
  constexpr double kSameForce = 1e-3;  // of chi-square: the same
  const auto place = [](const std::string& name) {
    const auto& kinds = effect_kinds();
    return std::find(kinds.begin(), kinds.end(), find_effect(name)) - kinds.begin();
  };
  if (odds > prior::kLikelier) return true;
  if (std::abs(odds - 1.0) < kSame) return place(other.name) < place(own.name());
  return odds > 1.0 && std::abs(other.chi2_above) < kSameForce;
}

/// What a probability from the fitted rows counts where held-out data say something. A machine
/// leaves far more than its noise there, of which every law explains a part: that one fits is
/// little evidence that it acts.
double before_held_out(double before, const Search& search, double log_support) {
  const bool open = search.study().axis && log_support != 0.0;
  return open ? std::min(before, prior::kFittedOnMachine) : before;
}

/// A probability that was `before`, after what the held-out data say of a model that predicts
/// `with` against another.
double after_held_out(double before, const Search& search, const HoldOut& holdout,
                      const Signals& with, const JointFit& other) {
  const double support =
      holdout.log_support(with, holdout.prediction(other.members, other.base), search.floors());
  return evidence::updated(before_held_out(before, search, support), support);
}

/// What chi-square falls by in each channel of the fitted rows from `rest` to `fit`.
std::vector<double> gain_by_channel(const Setting& setting, const JointFit& fit,
                                    const JointFit& rest) {
  std::vector<double> gain(static_cast<std::size_t>(setting.study.channel_count()), 0.0);
  const auto& rows = setting.whitener.row_info();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto at = static_cast<Index>(i);
    gain[rows[i].channel] +=
        rest.residual(at) * rest.residual(at) - fit.residual(at) * fit.residual(at);
  }
  return gain;
}

}  // namespace

double supported(double before, const Search& search, const HoldOut& holdout, const Signals& with,
                 std::size_t member) {
  return after_held_out(before, search, holdout, with, search.without(member));
}

std::vector<std::optional<double>> confidences(const Search& search, const HoldOut& holdout) {
  const JointFit& fit = search.fit();
  const Signals with = holdout.prediction(fit.members, fit.base);
  std::vector<std::optional<double>> list;
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    list.emplace_back();
    if (fit.members[m].fixed) continue;
    const double before = search.posterior().inclusion(fit.members[m]);
    list.back() = supported(before, search, holdout, with, m);
  }
  return list;
}

std::vector<Contradicted> contradicted(const Search& search, const HoldOut& holdout) {
  const JointFit& fit = search.fit();
  const Signals with = holdout.prediction(fit.members, fit.base);
  std::vector<Contradicted> list(fit.members.size());
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    if (fit.members[m].fixed) continue;
    const JointFit& rest = search.without(m);
    // A channel in which the name makes no force says nothing of it, whatever the odds before.
    const auto support =
        holdout.support_by_channel(with, holdout.prediction(rest.members, rest.base),
                                   search.floors(), gain_by_channel(search.setting(), fit, rest));
    const double inclusion = search.posterior().inclusion(fit.members[m]);
    const double before = std::max(inclusion, supported(inclusion, search, holdout, with, m));
    for (std::size_t j = 0; j < support.size(); ++j) {
      const double p = evidence::updated(before, support[j]);
      if (p >= 0.5) continue;
      list[m].channels.push_back(j);
      list[m].probability = std::min(list[m].probability, p);
    }
  }
  return list;
}

std::vector<double> masses_of(const Search& search, const std::vector<Alternative>& alternatives) {
  // On a machine, whose laws err by more than its noise, a number costs more, and evidence says
  // less.
  const double weight = kNumberPrice / search.setting().price;
  std::vector<double> odds{0.0};  // ln
  for (const Alternative& other : alternatives) {
    odds.push_back(weight * other.log_odds + other.log_support);
  }
  const double sum = evidence::log_sum(odds);
  for (double& odd : odds) odd = elementary::exp(odd - sum);
  return odds;
}

// One that leaves what no noise explains stands beside an unknown, and has its prior odds too.
std::vector<std::vector<Alternative>> adopt_likelier(Search& search, const HoldOut& holdout) {
  constexpr double kBesideUnknown = prior::kUnknown / (1.0 - prior::kUnknown);
  constexpr int kMostRounds = 6;  // a limit of computation: each round searches all places again
  Exchanges exchanges;
  for (int round = 0;; ++round) {
    auto alternatives = search.alternatives();
    exchanges.make_symmetric(search.fit().members, alternatives);
    add_support(search, holdout, alternatives);
    double most = 0.0;
    Alternative* best = nullptr;
    for (std::size_t m = 0; m < alternatives.size(); ++m) {
      const auto masses = masses_of(search, alternatives[m]);
      for (std::size_t k = 0; k < alternatives[m].size(); ++k) {
        Alternative& other = alternatives[m][k];
        const double odds = masses[k + 1] / masses[0];
        if (odds > most && goes_before(other, search.fit().members[m], odds)) {
          most = odds, best = &other;
        }
      }
    }
    if (!best || round == kMostRounds) {
      leave_out_improbable(search, alternatives);
      return alternatives;
    }
    const std::vector<Member> before = search.fit().members;
    const bool remained = search.remains();
    exchanges.made(before, *best);
    search.adopt(best->members);
    search.hold_untold();  // what a fault of the sensor has in common may be a mass
    search.leave_idle_names();
    if (remained || !search.remains()) continue;
    if (most * kBesideUnknown > prior::kLikelier) continue;
    search.adopt(before);
    best->log_support += elementary::log(kBesideUnknown);
    leave_out_improbable(search, alternatives);
    return alternatives;
  }
}

namespace {

/// Probability that any of the names acts, held-out data included: two that cancel in part may each
/// be right beside the other, and both wrong.
double together(const Search& search, const HoldOut& holdout) {
  const JointFit& fit = search.fit();
  std::vector<Member> others = fit.members;
  std::erase_if(others, [](const Member& m) { return !m.fixed; });
  if (others.size() == fit.members.size()) return 1.0;
  const JointFit none = joint_fit(search.setting(), others);
  const evidence::Posterior& before = search.posterior();
  return after_held_out(before.named + before.named_and_unknown, search, holdout,
                        holdout.prediction(fit.members, fit.base), none);
}

/// Probability of a machine's names beside the scale of its simulator in their place: names that
/// predict what was held out no better than that are none. (A tool's simulator has thirteen
/// numbers, which are names themselves and follow slow laws that begin anyhow.)
double beside_own_numbers(const Search& search, const HoldOut& holdout) {
  if (!search.study().axis) return 1.0;
  const std::vector<Member> numbers = own_parameters(search.study());
  const std::vector<Member>& members = search.fit().members;
  const bool has_all = std::all_of(numbers.begin(), numbers.end(), [&](const Member& own) {
    return std::any_of(members.begin(), members.end(),
                       [&](const Member& m) { return m.kind == own.kind; });
  });
  if (numbers.empty() || has_all) return 1.0;
  return after_held_out(1.0 - prior::kElsewhere, search, holdout,
                        holdout.prediction(members, search.fit().base),
                        joint_fit(search.setting(), numbers));
}

/// Rather wrong than right; held-out data that hardly tell refute nothing.
bool is_refuted(double probability) {
  constexpr double kNothingSaid = 0.01;  // of even odds
  return probability < 0.5 - kNothingSaid;
}

/// Of the names that may go, the one that explains least of the fitted rows: beside it another may
/// seem to be refuted that is not.
std::optional<std::size_t> weakest(const Search& search, const std::vector<bool>& may_go) {
  std::optional<std::size_t> least;
  for (std::size_t m = 0; m < may_go.size(); ++m) {
    if (!may_go[m]) continue;
    if (!least || search.without(m).chi2 < search.without(*least).chi2) least = m;
  }
  return least;
}

}  // namespace

Json leave_refuted(Search& search, const HoldOut& holdout) {
  Json refuted = Json::array();
  while (true) {
    const auto likely = confidences(search, holdout);
    std::vector<bool> named, unlikely;
    for (const auto& probability : likely) {
      named.push_back(probability.has_value());
      unlikely.push_back(probability && is_refuted(*probability));
    }
    double all = 1.0;  // probability of all of them
    auto worst = weakest(search, unlikely);
    if (!worst) {
      all = std::min(together(search, holdout), beside_own_numbers(search, holdout));
      if (is_refuted(all)) worst = weakest(search, named);
    }
    if (!worst) return refuted;
    const Member& member = search.fit().members[*worst];
    refuted.push_back({{"effect", member.name()},
                       {"axis", member.axis.empty() ? Json() : Json(member.axis)},
                       {"confidence", std::min(all, *likely[*worst])}});
    search.leave_out({*worst});
  }
}

bool leave_refuted_variations(Search& search, const HoldOut& holdout) {
  if (!search.study().axis) return false;
  bool changed = false;
  for (std::size_t m = 0; m < search.fit().members.size();) {
    const Member& member = search.fit().members[m++];
    if (member.kind != find_effect("gear_friction") || member.fixed) continue;
    const JointFit even =
        joint_fit(search.setting(), with_even_gears(search.study(), search.fit().members, m - 1));
    const double support =
        holdout.log_support(holdout.prediction(search.fit().members, search.fit().base),
                            holdout.prediction(even.members, even.base), search.floors());
    if (support >= 0.0) continue;
    search.adopt(even.members);
    changed = true;
    m = 0;
  }
  return changed;
}

}  // namespace dcnn
