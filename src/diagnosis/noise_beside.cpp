// SPDX-License-Identifier: Apache-2.0
// What could leave a remainder without any effect being missing: noise that the band above the
// motion does not show, against names that would be fitted to it.
#include <algorithm>

#include "diagnosis/axis_case.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/formula.h"
#include "diagnosis/search.h"

namespace dcnn {
bool Search::depends_on_motion() const {
  return most_of_a_term(*setting_, fit_) > prior::kDependence;
}

/// Nothing is left, in no band and of no product of what moves.
bool Search::is_independent() { return !is_alarming_now() && !depends_on_motion(); }

double Search::penalised_deviance() const {
  double numbers = 0.0;
  for (const Member& m : fit_.members) numbers += m.fixed ? 0.0 : m.parameters();
  for (const SlowPart& part : slow_) numbers += part.numbers();
  return fit_.chi2 + setting_->whitener.log_determinant() + kNumberPrice * numbers;
}

/// An event, or a drift: what slow noise looks like.
bool Search::may_be_slow_noise(const Member& member) const {
  return member.interval_s || (member.kind->stage == Stage::kOffset && member.parameters() > 0);
}

bool Search::are_constant() const {
  const auto tests = constancy(*setting_, fit_);
  return std::none_of(tests.begin(), tests.end(),
                      [](const Constancy& test) { return test.refutes(); });
}

/// Whether beside the noise that was admitted no law gains and nothing is left, in no band and of
/// no product of what moves.
bool Search::noise_suffices() { return !grow() && is_independent(); }

/// Whether noise of one colour, which the band above the motion bears out, is all that is left: far
/// below that band its colour is hardly known from there. It is likelier then than the best product
/// of what moves beside noise as it is known.
bool Search::admit_colour() {
  if (study_.is_static() || study_.without.coloured_floor) return false;
  const Signals raw = study_.lowpass_hz > 0.0 ? unfiltered_left(study_, fit_.members) : left_;
  const std::vector<Member> members = fit_.members;
  noise_ = noise_of_all(study_, raw, noise_level(study_, raw), floors_);
  if (noise_) {
    const double with_term = penalised_deviance() - most_of_a_term(*setting_, fit_) + kNumberPrice;
    settle(members);
    if (penalised_deviance() < with_term && noise_suffices()) return true;
    noise_.reset();
    settle(members);
    is_alarming_now();
  }
  return false;
}

/// An event has the spectrum of slow noise, but need not have its size: one that was found without
/// such noise stands beside it where both are likelier.
void Search::put_events_beside_noise(const std::vector<Member>& found) {
  for (const Member& event : found) {
    if (!event.interval_s) continue;
    const std::vector<Member> before = fit_.members;
    const double alone = penalised_deviance();
    settle(with_member(before, event));
    if (penalised_deviance() > alone) settle(before);
  }
}

/// Searches from nothing in slow noise, which is estimated again beside whatever is found, and
/// keeps what that finds where it leaves nothing in any band and is likelier than all names that
/// gain without such noise, and the best product of what moves beside them. Else these names are
/// the better beginning where they are likelier without it too: noise as loud as what is left
/// weighs every band alike, and an event is no first guess in it. True where either is kept.
bool Search::admit_slow_noise() {
  if (tried_slow_noise_ || study_.is_static() || study_.axis || study_.without.coloured_floor) {
    return false;
  }
  tried_slow_noise_ = true;
  if (!slow_parts(study_, left_, floors_)) return false;
  say("searching in slow noise");
  const State state = this->state();
  const double before = passes();
  while (grow()) {
  }
  const double plain = penalised_deviance();
  const std::vector<Member> without_noise = fit_.members;
  const double with_term = plain - most_of_a_term(*setting_, fit_) + kNumberPrice;
  in_slow_noise_ = true;
  events_allowed_ = false;  // an event has the spectrum of such noise
  settle(to_begin_with());
  explore();
  put_events_beside_noise(without_noise);
  if (penalised_deviance() < std::min(plain, with_term) && are_constant() && !is_alarming_now())
    return true;
  const std::vector<Member> found = fit_.members;
  begun_ += passes() - before;  // an attempt that failed is not what the search may take
  restore(state);
  settle(found);
  if (penalised_deviance() < plain) return true;
  settle(state.members);
  is_alarming_now();
  return false;
}

}  // namespace dcnn
