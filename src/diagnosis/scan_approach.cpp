// SPDX-License-Identifier: Apache-2.0
// Where the search for a candidate's shapes begins: combs over those with many local optima.
#include <algorithm>
#include <cmath>

#include "diagnosis/scan.h"

namespace dcnn {
namespace {

constexpr int kApproach = 12;  // evaluations of a first refinement

}  // namespace

/// A line over all recordings is far narrower than one in a recording, from which its frequency was
/// seeded: the best of a comb first.
Trial Scan::tuned(const Trial& start, Detail detail) const {
  Trial best = start;
  const double width = 0.6 / longest_seconds(setting_.study);
  const double step = std::max(0.25 / span_seconds(setting_.study), width / 40.0);
  for (double away = -width; away <= width; away += step) {
    Member member = start.member;
    member.shapes(0) += away;
    const Trial trial = evaluate(member, detail);
    if (trial.gain > best.gain) best = trial;
  }
  return best;
}

/// A mode that nothing drives at its own frequency has local minima at many: the best damping at
/// the frequencies where a comb has its peaks, highest first.
std::vector<Trial> Scan::local_minima(const Member& mode, Detail detail, std::size_t most) const {
  std::vector<Trial> comb;
  Member member = mode;
  for (double hz = 1.5; hz <= mode.most_shapes(0); hz *= 1.15) {
    comb.emplace_back();
    for (const double zeta : {0.01, 0.03, 0.1, 0.3}) {
      member.shapes << hz, zeta;
      const Trial trial = evaluate(member, detail);
      if (trial.gain > comb.back().gain) comb.back() = trial;
    }
  }
  std::vector<Trial> peaks;
  for (std::size_t k = 0; k < comb.size(); ++k) {
    const bool peak = comb[k].gain > 0.0 && (k == 0 || comb[k].gain >= comb[k - 1].gain) &&
                      (k + 1 == comb.size() || comb[k].gain >= comb[k + 1].gain);
    if (peak) peaks.push_back(comb[k]);
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Trial& x, const Trial& y) { return x.gain > y.gain; });
  if (peaks.size() > most) peaks.resize(most);
  return peaks;
}

std::vector<Member> Scan::as_likely(const Member& mode, double within) const {
  std::vector<Trial> seen{evaluate(mode, Detail::kCoarse)};
  for (const Trial& start : local_minima(mode, Detail::kCoarse, 12)) {
    improved(start, Detail::kCoarse, 40, &seen);
  }
  double most = 0.0;
  for (const Trial& trial : seen) most = std::max(most, trial.gain);
  std::vector<Member> likely;
  for (const Trial& trial : seen) {
    if (trial.gain >= most - within) likely.push_back(trial.member);
  }
  return likely;
}

/// A delay has a local minimum at every turn of the motion: the best of a comb first.
Trial Scan::combed(const Trial& start) const {
  constexpr double kStep = 0.02;  // s: an eighth of a turn at 6 Hz
  Trial best = start;
  Member member = start.member;
  for (double delay = kStep; delay < member.form->shapes[0].high; delay += kStep) {
    member.shapes(0) = delay;
    const Trial trial = evaluate(member, Detail::kCoarse);
    if (trial.gain > best.gain) best = trial;
  }
  return best;
}

/// A signal that varies fast meets its law at one lag alone: the best of a comb first, each tooth
/// half as far again.
Trial Scan::lagged(const Trial& start) const {
  constexpr double kLeast = 0.02, kRatio = 1.5;  // s; as delays of a force
  Trial best = start;
  Member member = start.member;
  const Index lag = member.own_shapes() - 1;
  for (double away = kLeast; away <= member.most_shapes(lag); away *= kRatio) {
    for (const double at : {-away, away}) {
      if (at < member.least_shapes(lag)) continue;
      member.shapes(lag) = at;
      const Trial trial = evaluate(member, Detail::kCoarse);
      if (trial.gain > best.gain) best = trial;
    }
  }
  return best;
}

Trial Scan::approach(const Trial& seed) const {
  const bool shaped = seed.member.own_shapes() > 0;
  const auto peak = shaped ? seed.member.shape(0).peak : ShapeParameter::Peak::kWide;
  const auto a_little = [&](const Trial& start) {
    return refine(start, Detail::kCoarse, kApproach);
  };
  if (setting_.study.without.refinement) return seed;
  if (peak == ShapeParameter::Peak::kLine) return a_little(tuned(seed, Detail::kCoarse));
  const bool fitted_base = !setting_.study.logs.front().regressors.empty();
  if (peak == ShapeParameter::Peak::kComb && fitted_base) return a_little(combed(seed));
  const Trial best = a_little(seed.member.driver ? lagged(seed) : seed);
  if (seed.member.kind->stage != Stage::kResonance || seed.gain < 2.0 * seed.price) return best;
  const Trial elsewhere = best_mode(seed.member);
  return elsewhere.gain > best.gain ? elsewhere : best;
}

Trial Scan::best_mode(const Member& mode) const {
  Trial best;
  for (const Trial& start : local_minima(mode, Detail::kCoarse, 4)) {
    const Trial trial = refine(start, Detail::kCoarse, kApproach);
    if (trial.gain > best.gain) best = trial;
  }
  return best;
}

}  // namespace dcnn
