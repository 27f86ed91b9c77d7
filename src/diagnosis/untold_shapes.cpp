// SPDX-License-Identifier: Apache-2.0
// A drift of which the recordings do not tell the time constant, and a law of which they do not
// tell how it bends, are told as what they do tell.
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

bool is_loop(const Member& member) {
  return member.kind->course == EffectKind::Course::kLoop && !member.driver && !member.fixed;
}

/// A law in a form that bends it by numbers of which one is not told to a decade, or is as far as
/// it goes.
bool bends_untold(const Case& study, const Member& member, const std::vector<Estimate>& numbers) {
  const auto plain = plain_form(study, member);
  if (!plain || member.driver || member.fixed) return false;
  const auto& shapes = member.form->shapes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const auto& kept = plain->form->shapes;
    const bool bends = std::none_of(kept.begin(), kept.end(), [&](const ShapeParameter& s) {
      return std::string(s.name) == shapes[i].name;
    });
    if (bends && is_at_bound(member, static_cast<Index>(i))) return true;
  }
  const Json known = parameters_of(*plain);
  return std::any_of(numbers.begin(), numbers.end(), [&](const Estimate& number) {
    return !known.contains(number.name) && spans_decades(number);
  });
}

/// A loop over the position whose width is not told to a decade.
bool is_untold_loop(const Member& member, const std::vector<Estimate>& numbers) {
  if (!is_loop(member)) return false;
  return std::any_of(numbers.begin(), numbers.end(), [](const Estimate& number) {
    return number.name == "width_rad" && spans_decades(number);
  });
}

/// A law in this form where searches for it begin: at each seed of its first shape.
std::vector<Member> at_seeds(const Case& study, const EffectKind& kind, const EffectFit& form,
                             const std::string& axis) {
  Eigen::VectorXd shapes(static_cast<Index>(form.shapes.size()));
  for (std::size_t i = 0; i < form.shapes.size(); ++i) {
    const auto& seeds = form.shapes[i].seeds;
    if (seeds.empty()) return {};  // which the residual tells
    shapes(static_cast<Index>(i)) = seeds[seeds.size() / 2] * unit_of(study, form.shapes[i]);
  }
  if (form.shapes.empty()) return {make_member(study, kind, form, axis, shapes)};
  std::vector<Member> list;
  for (const double seed : form.shapes.front().seeds) {
    shapes(0) = seed * unit_of(study, form.shapes.front());
    list.push_back(make_member(study, kind, form, axis, shapes));
  }
  return list;
}

/// Plain laws of dry friction, for a loop; none beside one of them.
std::vector<Member> dry_frictions(const Case& study, const std::vector<Member>& members) {
  using Friction = EffectKind::Friction;
  std::vector<Member> list;
  if (std::any_of(members.begin(), members.end(),
                  [](const Member& m) { return m.kind->friction == Friction::kDry; })) {
    return list;
  }
  for (const EffectKind* kind : effect_kinds()) {
    if (kind->friction != Friction::kDry || !is_listed(study, *kind)) continue;
    const std::string axis = axes_of(study, *kind).front();
    for (Member& m : at_seeds(study, *kind, first_form(study, *kind), axis)) list.push_back(m);
  }
  return list;
}

/// The likeliest fit with one of these in the place of a member.
std::optional<JointFit> likeliest_with(const Setting& setting, const JointFit& fit,
                                       std::size_t place, const std::vector<Member>& others) {
  std::optional<JointFit> best;
  for (const Member& other : others) {
    std::vector<Member> members = fit.members;
    members[place] = other;
    JointFit tried = joint_fit(setting, std::move(members));
    if (!best || tried.chi2 < best->chi2) best = std::move(tried);
  }
  return best;
}

}  // namespace

bool Search::leave_untold_bends() {
  if (!study_.axis) return false;  // no bent form is tried on a tool
  bool changed = false;
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const Member& member = fit_.members[m];
    const bool gears = member.kind == find_effect("gear_friction");
    if (!gears && !is_loop(member) && !plain_form(study_, member)) continue;
    const auto numbers = estimates(*setting_, fit_)[m];
    if (gears && is_even(member, numbers)) {
      settle(with_even_gears(study_, fit_.members, m));
    } else if (is_untold_loop(member, numbers)) {
      const auto other = likeliest_with(*setting_, fit_, m, dry_frictions(study_, fit_.members));
      if (!other) continue;
      const int fewer = member.parameters() - other->members[m].parameters();
      if (other->chi2 - fit_.chi2 > setting_->price * fewer) continue;
      settle(std::vector<Member>(other->members));
    } else if (bends_untold(study_, member, numbers)) {
      const Member plain = *plain_form(study_, member);
      std::vector<Member> plains = at_seeds(study_, *plain.kind, *plain.form, plain.axis);
      plains.push_back(plain);
      settle(std::vector<Member>(likeliest_with(*setting_, fit_, m, plains)->members));
    } else {
      continue;
    }
    weigh_once();
    changed = true;
    m = static_cast<std::size_t>(-1);  // from the first again
  }
  return changed;
}

bool has_untold_shape(const Setting& setting, const JointFit& fit) {
  const auto may_be = [&](const Member& member) {
    if (settles(member)) return true;
    const bool bends =
        member.kind == find_effect("gear_friction") || plain_form(setting.study, member);
    return setting.study.axis && bends;
  };
  if (std::none_of(fit.members.begin(), fit.members.end(), may_be)) return false;
  const auto numbers = estimates(setting, fit);
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const Member& member = fit.members[m];
    if (is_untold(member, numbers[m])) return true;
    if (!may_be(member)) continue;
    if (is_even(member, numbers[m]) || bends_untold(setting.study, member, numbers[m])) return true;
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
