// SPDX-License-Identifier: Apache-2.0
// What tests of their own find, and what is taken back.
#include <algorithm>
#include <cmath>

#include "diagnosis/candidates.h"
#include "diagnosis/detectors.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/impacts.h"
#include "diagnosis/left_out.h"
#include "diagnosis/search.h"
#include "physics/effect_law.h"

namespace dcnn {
/// What tests of their own find in the raw force and at the log's rate.
void Search::detect() {
  for (const Clipping& clip : clipping(study_)) {
    const EffectKind& kind = *find_effect("saturation");
    if (!is_listed(study_, kind)) break;
    Member member = make_member(study_, kind, kind.fits[0],
                                admitted_axes(AxisRule::kSensor)[static_cast<std::size_t>(
                                    study_.channels[static_cast<std::size_t>(clip.channel)])],
                                Eigen::VectorXd::Constant(1, clip.limit));
    member.fixed = true;
    // A limit is read off: known to the digit, or to the step that rounding makes of it.
    const double digit = std::max(reading_digit(study_), rounding_step(study_));
    member.fixed_deviation = Eigen::VectorXd::Constant(1, digit / std::sqrt(12.0));
    apart_.push_back(member);
    masked_.insert(masked_.end(), clip.spans.begin(), clip.spans.end());
  }
  // A machine's values come in any unit: its lattice matters where the noise does not cover it.
  const double least = study_.axis ? floors_.front().deviation() : 0.0;
  const EffectKind& kind = *find_effect("quantisation");
  if (const double step = rounding_step(study_); step > least && is_listed(study_, kind)) {
    Member member = make_member(study_, kind, kind.fits[0], "", Eigen::VectorXd::Constant(1, step));
    member.fixed = true;
    member.fixed_deviation = Eigen::VectorXd::Constant(1, rounding_deviation(study_, step));
    rounding_ = member;
    for (Case* study : cases()) {
      study->rounding_step = step;
      study->rounding_noise = 0.3 * step;  // choose_rounding_noise()
    }
  }
  if (study_.is_static()) return;
  if (const auto hum = heard_hum(left_)) apart_.push_back(*hum);
}

/// A line above the motion's band in what is left.
std::optional<Member> Search::heard_hum(const Signals& left) const {
  const auto hum = find_fast_hum(study_, left, floors_);
  if (!hum || !is_listed(study_, *hum->kind)) return std::nullopt;
  double power = 0.0, rows = 0.0;
  for (const auto& signal : left) {
    power += signal.squaredNorm();
    rows += static_cast<double>(signal.size());
  }
  // A motor's log is full of faint lines: of what is left on a machine one must be a share.
  const double line = 0.5 * hum->amplitudes.squaredNorm() * rows;
  if (study_.axis && line < 0.002 * power) return std::nullopt;
  // Nor is it motion too small for the encoder to show.
  return line > prior::kLeastLine * unseen_motion(study_, fit_.members, hum->shapes(0))
             ? hum
             : std::nullopt;
}

/// Whether a line that was heard before anything was found is none beside that: what a motion that
/// repeats leaves has lines of its own.
bool Search::hums_no_more() {
  const auto heard = std::find_if(apart_.begin(), apart_.end(), is_heard_hum);
  if (heard == apart_.end()) return false;
  const Member hum = *heard;
  const std::vector<Member> before = fit_.members;
  std::vector<Member> others = before;
  std::erase_if(others, is_heard_hum);
  if (others.empty()) return false;
  apart_.erase(heard);
  settle(others);
  while (simplify()) {
  }
  if (!heard_hum(left_)) return true;
  apart_.push_back(hum);
  settle(before);
  return false;
}

void Search::leave_hum() {
  std::vector<Member> others = fit_.members;
  std::erase_if(others, is_heard_hum);
  std::erase_if(apart_, is_heard_hum);
  adopt(others);
}

bool Search::detect_impacts() {
  if (study_.is_static() || !is_listed(study_, *find_effect("loose_load"))) return false;
  impacts_ = find_impacts(study_, left_);
  return impacts_.member.has_value();
}

/// Whether the residual of all that was found since still shows the load's impacts.
bool Search::still_has_impacts() {
  Impacts impacts = find_impacts(study_, left_);
  if (impacts.member) impacts.spans = impacts_.spans;  // beside which all was fitted
  impacts_ = std::move(impacts);
  return impacts_.member.has_value();
}

/// Takes back, the most doubtful first, what signs drawn at random for each second explain as
/// often: a coincidence of a few moments, not a law. (An event has too few seconds for this test,
/// and so has a recording of less than six: no law would pass it.)
/// A delay or a lag at the end of its range is no estimate, but what comes nearest to another law.
void Search::drop_coincidences() {
  constexpr double kMostLikely = 0.05;
  if (study_.is_static() || study_.without.flips) return;
  const bool tells = least_flip_p_value(*setting_) <= kMostLikely;
  while (true) {
    double most = kMostLikely;
    std::optional<std::size_t> worst;
    for (std::size_t m = 0; m < fit_.members.size(); ++m) {
      if (stays(fit_.members[m]) || fit_.members[m].interval_s) continue;
      const bool estimate =
          fit_.members[m].amplitudes.size() > 0 || !is_degenerate(fit_.members[m]);
      if (estimate && net_gain(m) > prior::kCertainGain * setting_->price)
        continue;  // nor have a few moves
      if (estimate && !tells) continue;
      const double p = estimate ? flip_p_value(*setting_, fit_, m) : 1.0;
      if (p > most) most = p, worst = m;
    }
    if (!worst) return;
    settle(members_without(*worst));
  }
}

/// A machine's simulator is as little exact as any law: what is left within its error is nothing.
bool Search::is_alarming_now() {
  bands_ = band_tests(*setting_, fit_.residual);
  const double measured = study_.axis ? setting_->whitened(setting_->measured).squaredNorm() : 0.0;
  const double least = prior::kModelError * prior::kModelError * measured;
  return !study_.without.omnibus && is_alarming(bands_, explained(true), least);
}

/// Of a tool: an effect that a fit to the other pieces of time does not show to help on each piece
/// in turn explains some moments, and nothing outside them. What acts for some time alone is seen
/// in few pieces, and an offset that drifts only as a whole.
void Search::drop_unconfirmed() {
  if (is_inexact()) return;
  while (true) {
    const auto shares = left_out_shares(*setting_, fit_);
    double least = 0.0;
    std::optional<std::size_t> worst;
    for (std::size_t m = 0; m < shares.size(); ++m) {
      const Member& member = fit_.members[m];
      const bool whole = !member.interval_s && member.kind->stage != Stage::kOffset;
      if (whole && !stays(member) && shares[m] < least) least = shares[m], worst = m;
    }
    if (!worst) return;
    settle(members_without(*worst));
  }
}

/// Takes back what a remainder nobody can name makes doubtful: events, but for those of which only
/// the shape is a little off, and members that fit in some places and not in others.
void Search::judge() {
  constexpr double kWithoutEvents = 0.2;  // of a search's limit, at least
  drop_coincidences();
  drop_unconfirmed();
  if (is_inexact()) keep_what_is_confirmed();
  remains_ = is_alarming_now();
  if (remains_ && admit_slow_noise()) {
    if (!in_slow_noise_) explore();
    remains_ = is_alarming_now();
  }
  if (remains_ && (admit_own_zeros() || admit_colour())) remains_ = false;
  if (begin_without_refuted() && remains_) {
    tried_slow_noise_ = false;
    if (admit_slow_noise()) remains_ = is_alarming_now();
  }
  if (keep_unaffected()) {
    remains_ = true;
    bands_ = band_tests(*setting_, fit_.residual);
    return;
  }
  if (!remains_ && !remove_near_laws()) return;
  remains_ = true;
  say("a residual remains: testing the found effects again");
  if (events_allowed_) {
    events_allowed_ = false;
    std::vector<Member> rest;
    const double plain = prior::kPlainEvent * left_over(bands_);
    for (std::size_t m = 0; m < fit_.members.size(); ++m) {
      if (!fit_.members[m].interval_s || net_gain(m) > plain) rest.push_back(fit_.members[m]);
    }
    forget_places();
    if (rest.size() < fit_.members.size()) {
      settle(rest);
      // What the events stood for is still to be found, though the search be spent on them.
      allow(kWithoutEvents);
      explore();
    }
  }
  if (is_inexact()) {
    keep_what_is_confirmed();
    bands_ = band_tests(*setting_, fit_.residual);
    return;
  }
  while (remove_near_laws()) {
  }
  drop_coincidences();
  if (study_.is_static()) return;
  choose_cutoff(fit_.members);  // beside what is no more another one was best
  settle(fit_.members);
  remains_ = is_alarming_now();
}

/// Of a machine, where laws are never constant to the last digit: a name must help on pieces of
/// time on which it was not fitted; and a mode must be one after its fit as before it: as damped as
/// its bound it rings no more, and is the gain and the delay of a motion of one frequency. Whether
/// any was left out.
bool Search::keep_what_carries_over() {
  const std::size_t refuted = refuted_.size();
  std::vector<Member> members;
  const Scan scan(*setting_, fit_);
  for (const Member& m : fit_.members) {
    const bool possible =
        m.kind->stage != Stage::kResonance || (scan.is_possible(m) && !is_degenerate(m));
    (possible ? members : refuted_).push_back(m);
  }
  if (members.size() < fit_.members.size()) settle(members);
  while (!fit_.members.empty()) {
    const auto shares = left_out_shares(*setting_, fit_);
    // Of those that do not, what explains least: beside it another may not seem to help either.
    std::optional<std::size_t> least;
    for (std::size_t m = 0; m < shares.size(); ++m) {
      if (shares[m] < prior::kRemains && (!least || gain(m) < gain(*least))) least = m;
    }
    if (!least) break;
    refuted_.push_back(fit_.members[*least]);
    settle(members_without(*least));
  }
  return refuted_.size() > refuted;
}

/// Searches for others in the place of names that do not carry over, until all do.
void Search::keep_what_is_confirmed() {
  while (keep_what_carries_over() && !is_spent()) {
    explore();
    drop_coincidences();
  }
}

}  // namespace dcnn
