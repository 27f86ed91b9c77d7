// SPDX-License-Identifier: Apache-2.0
// A second beginning on a tool: without the laws that were found and are refuted.
#include <algorithm>

#include "diagnosis/evidence/priors.h"
#include "diagnosis/search.h"

namespace dcnn {

Search::State Search::state() const {
  return {fit_.members, study_,   smoothed_,      other_filter_,
          tuned_,       ringing_, in_slow_noise_, events_allowed_};
}

void Search::restore(const State& state) {
  study_ = state.study, smoothed_ = state.smoothed, other_filter_ = state.other_filter;
  tuned_ = state.tuned, ringing_ = state.ringing;
  in_slow_noise_ = state.in_slow_noise, events_allowed_ = state.events_allowed;
}

/// A search that adds one law at a time may begin with one that does the work of two, a spring for
/// crosstalk beside a lag, and all that it finds beside it is refuted with it. It is repeated
/// without the kinds that are refuted, each time from what the last repetition found, as long as
/// that is likelier; what it ends at stands where it leaves so little of what was left, as a law
/// must to take the place of names. All are compared beside the noise from above the motion.
bool Search::begin_without_refuted() {
  constexpr double kShare = 0.3;  // of a search's limit, for each beginning
  constexpr int kMost = 3;        // beginnings: what the second finds may be refuted too
  if (study_.axis || study_.is_static() || study_.without.exchange) return false;
  const auto put_aside = [&] {
    const std::vector<double> far = doubts(prior::kLeastShare);
    const std::size_t before = set_aside_.size();
    for (std::size_t m = 0; m < far.size(); ++m) {
      if (far[m] > 1.0) set_aside_.insert(fit_.members[m].kind);
    }
    return set_aside_.size() > before;
  };
  if (!put_aside()) return false;
  say("searching again without the laws that are refuted");
  const State first = state();
  in_slow_noise_ = false;
  settle(first.members);
  const double left = left_over(band_tests(*setting_, fit_.residual));
  State best = state();
  double least = penalised_deviance();
  for (int round = 0; round < kMost; ++round) {
    allow(kShare);
    settle(apart_);
    explore();
    if (penalised_deviance() >= least) break;
    best = state();
    least = penalised_deviance();
    if (!put_aside()) break;
  }
  set_aside_.clear();
  restore(best);
  settle(best.members);
  const bool better =
      (1.0 - prior::kInPlaceOfName) * left > left_over(band_tests(*setting_, fit_.residual));
  if (!better) {
    restore(first);
    settle(first.members);
  }
  remains_ = is_alarming_now();
  return better;
}

}  // namespace dcnn
