// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/gear_order.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/candidates.h"
#include "diagnosis/position_bins.h"

namespace dcnn {
namespace {

constexpr double kStill = 0.05;  // of the rms velocity: below it friction has no sign
constexpr Index kFewestGearBins = 16;

/// What is left against the motion, in bins of the position.
PositionBins gear_bins(const Case& study, const Signals& left) {
  double low = 1e300, high = -1e300, square = 0.0, samples = 0.0;
  for (const Log& log : study.logs) {
    low = std::min(low, log.motion.euler.col(0).minCoeff());
    high = std::max(high, log.motion.euler.col(0).maxCoeff());
    square += log.motion.v_B.col(0).squaredNorm();
    samples += static_cast<double>(log.motion.samples());
  }
  const double still = kStill * std::sqrt(square / samples);
  PositionBins bins(low, high, position_bin(study));
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    for (Index i = 0; i < motion.samples(); i += 3) {
      const double v = motion.v_B(i, 0);
      if (std::abs(v) <= still) continue;
      bins.add(motion.euler(i, 0), std::copysign(1.0, v) * left[k](i, 0), 1.0);
    }
  }
  return bins;
}

}  // namespace

void add_gear_frictions(const Case& study, const Signals& left, std::vector<Member>& list) {
  const EffectKind& kind = *find_effect("gear_friction");
  if (!is_listed(study, kind) || !is_testable(study, kind)) return;
  if (study.logs.front().motion.v_B.rows() == 0) return;
  const PositionBins bins = gear_bins(study, left);
  if (bins.size() < kFewestGearBins || !(bins.count.maxCoeff() > 0.0)) return;
  const EffectFit& form = kind.fits[0];
  const double least = least_order(study, 0, kFewestRepeats),
               end = highest_order(study, form.shapes[0], bins.width);
  const double order =
      best_order(bins, std::max(least, unit_of(study, form.shapes[0]) * form.shapes[0].low), end);
  if (order == 0.0) return;
  for (const double v0 : form.shapes[1].seeds) {
    list.push_back(make_member(study, kind, form, axes_of(study, kind).front(),
                               Eigen::Vector2d(order, unit_of(study, form.shapes[1]) * v0)));
    list.back().least_shapes(0) = least;
    list.back().most_shapes(0) = end;
  }
}

std::vector<Member> with_even_gears(const Case& study, std::vector<Member> members,
                                    std::size_t gear) {
  const Member own = members[gear];
  members.erase(members.begin() + static_cast<std::ptrdiff_t>(gear));
  const EffectKind& kind = *find_effect("coulomb_friction");
  // Both make dry friction along the one axis of a machine.
  const bool is_dry = std::any_of(members.begin(), members.end(), [&](const Member& m) {
    return m.kind->friction == EffectKind::Friction::kDry;
  });
  if (is_dry || !is_listed(study, kind)) return members;
  members.push_back(
      make_member(study, kind, kind.fits[0], axes_of(study, kind).front(), own.shapes.tail(1)));
  // The mean over the positions; one that would drive is none.
  members.back().amplitudes = own.amplitudes.head(1).cwiseMax(0.0);
  return members;
}

}  // namespace dcnn
