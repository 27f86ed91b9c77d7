// SPDX-License-Identifier: Apache-2.0
// A drift of which the recordings do not tell the time constant is told as what they do tell.
#include <algorithm>
#include <cmath>
#include <string>

#include "diagnosis/candidates.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/gear_order.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

constexpr double kAtEnd = 1e-3;  // of a shape: tolerance of a bound

/// Whether a 95 % interval of a number that must be positive, as a time constant, spans two
/// decades.
bool spans_decades(const Estimate& number) {
  return number.value > 0.0 &&
         number.high > prior::kKnownWithin * prior::kKnownWithin * std::max(0.0, number.low);
}

/// An offset that changes with the clock by a law with a shape, as one that settles.
bool settles(const Member& member) {
  return member.kind->stage == Stage::kOffset && member.kind->needs_time == TimeNeed::kClock &&
         !member.form->shapes.empty();
}

bool is_untold(const Member& member, const std::vector<Estimate>& numbers) {
  if (!settles(member) || member.fixed || member.interval_s) return false;
  for (std::size_t i = 0; i < member.form->shapes.size(); ++i) {
    const ShapeParameter& shape = member.form->shapes[i];
    const auto at = static_cast<Index>(i);
    // Fitted to an end of its range, or one that its interval holds: a constant settles at once, a
    // line never.
    const double ratio = member.shapes(at) / member.least_shapes(at);
    if (shape.low > 0.0 && (ratio < 1.0 + kAtEnd || is_degenerate(member))) return true;
    for (const Estimate& number : numbers) {
      const bool own = number.name.starts_with(std::string(shape.name) + "_");
      if (!own || shape.low <= 0.0) continue;
      if (spans_decades(number) || number.low <= member.least_shapes(at) ||
          number.high >= member.most_shapes(at)) {
        return true;
      }
    }
  }
  return false;
}

/// Dry friction of gears whose variation with the position may be none, or of an order that is not
/// known to a factor of ten.
bool is_even(const Member& member, const std::vector<Estimate>& numbers) {
  if (member.kind != find_effect("gear_friction") || member.fixed) return false;
  return std::any_of(numbers.begin(), numbers.end(), [](const Estimate& number) {
    return (number.name == "a" && number.low <= 0.0) ||
           (number.name == "order" && spans_decades(number));
  });
}

}  // namespace

/// On a machine, whose only position is that of the gears.
bool Search::even_out_gears() {
  if (!study_.axis) return false;
  bool changed = false;
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (fit_.members[m].kind != find_effect("gear_friction")) continue;
    if (!is_even(fit_.members[m], estimates(*setting_, fit_)[m])) continue;
    settle(with_even_gears(study_, fit_.members, m));
    weigh_once();
    changed = true;
    m = static_cast<std::size_t>(-1);  // from the first again
  }
  return changed;
}

bool has_untold_shape(const Setting& setting, const JointFit& fit) {
  const auto may_be = [&](const Member& member) {
    return settles(member) || (setting.study.axis && member.kind == find_effect("gear_friction"));
  };
  if (std::none_of(fit.members.begin(), fit.members.end(), may_be)) return false;
  const auto numbers = estimates(setting, fit);
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const Member& member = fit.members[m];
    if (is_untold(member, numbers[m]) || (may_be(member) && is_even(member, numbers[m]))) {
      return true;
    }
  }
  return false;
}

/// An offset that settles within an unknown time is a constant where it settles at once, a line
/// where it settles after the recording: whichever of the two leaves less.
void Search::straighten_drifts() {
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (!has_untold_shape(*setting_, fit_)) return;
    if (!is_untold(fit_.members[m], estimates(*setting_, fit_)[m])) continue;
    std::optional<JointFit> best;
    for (const EffectKind* offset : effect_kinds()) {
      const EffectKind& kind = *offset;
      const bool is_plain = kind.stage == Stage::kOffset && kind.fits.front().shapes.empty() &&
                            kind.interval != IntervalRule::kOnset;
      if (!is_plain || !is_listed(study_, kind) || !is_testable(study_, kind)) continue;
      std::vector<Member> members = members_without(m);
      const bool there = std::any_of(members.begin(), members.end(),
                                     [&](const Member& other) { return other.kind == &kind; });
      if (!there)
        members.push_back(make_member(study_, kind, kind.fits[0], "", Eigen::VectorXd(0)));
      JointFit other = joint_fit(*setting_, std::move(members));
      if (!best || other.chi2 < best->chi2) best = std::move(other);
    }
    if (!best) continue;
    settle(std::vector<Member>(best->members));
    weigh_once();
    m = static_cast<std::size_t>(-1);  // from the first again
  }
}

}  // namespace dcnn
