// SPDX-License-Identifier: Apache-2.0
// An effect with numbers: what is in a model, or tried for it.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "dcnn/physics/effect.h"
#include "diagnosis/case.h"

namespace dcnn {

struct Member {
  const EffectKind* kind = nullptr;
  const EffectFit* form = nullptr;  ///< one of kind->fits
  std::string axis;                 ///< empty for none
  std::optional<std::pair<double, double>> interval_s;
  std::string recording;  ///< acts in this one only; empty for all
  /// Shapes of the form, and after them, where torques are measured, the components of the lever at
  /// which the force acts that its torque tells of [m, in S].
  Eigen::VectorXd amplitudes, shapes;
  /// Of a law that a logged signal drives: which one, and its range in the fitted recordings. The
  /// amplitudes are then the strengths at either end, and a shape after the form's own is the lag.
  std::optional<Case::Driver> driver;
  /// Bounds of the shapes: the effect's own, or closer where these recordings can tell less (a
  /// period that is never completed is a spring; a mode above what the blocks hold does not ring).
  Eigen::VectorXd least_shapes, most_shapes;
  /// Found at the full rate by a test of its own (hum above the blocks' band, rounding, clipping,
  /// impacts): the joint fit leaves it as it is.
  bool fixed = false;
  Eigen::VectorXd fixed_deviation;  ///< then: of amplitudes and shapes, from that test
  /// Of a discovered law, which is fixed but for its size: its form and its numbers
  /// (dcnn/physics/law.h). Its one amplitude multiplies that size.
  Json law = nullptr, law_parameters = nullptr;

  /// An amplitude that is held at zero because the recordings do not tell it, with the interval in
  /// which they leave it.
  struct Held {
    Index amplitude;
    double low, high;
  };
  std::vector<Held> held;
  bool is_held(Index amplitude) const;
  void hold(Index amplitude, double low, double high);

  std::string name() const { return kind->name; }
  Eigen::Index own_shapes() const {
    return static_cast<Eigen::Index>(form->shapes.size()) + (driver ? 1 : 0);
  }
  Eigen::Index levers() const { return std::max<Eigen::Index>(0, shapes.size() - own_shapes()); }
  /// Bounds and scale of shape i.
  const ShapeParameter& shape(Eigen::Index i) const;
  /// Numbers that a joint fit moves.
  Eigen::Index coordinates() const {
    return fixed && law.is_null() ? 0 : amplitudes.size() + shapes.size();
  }
  /// Numbers that were fitted: amplitudes, shapes and the ends of an interval; and one each for the
  /// choice of a special law and of the signal that drives it.
  int parameters() const;
};

/// Whether a shape is as far as it goes, a signed one to either side: no estimate, but a bound.
bool is_at_bound(const Member& member, Eigen::Index shape);

/// A shape as far as it goes: the law bends less, or more, than any of its kind, and another that
/// has no such shape may do.
bool is_degenerate(const Member& member);

/// Whether a member's amplitudes are entries of a vector or matrix, each of which may be zero.
bool has_entries(const Member& member);

/// Laws of one kind (friction, drift, …) that act along the same axis.
bool same_family(const Member& a, const Member& b);

/// Whether `plain` is the law of a driven member at a strength that follows nothing.
bool is_undriven(const Member& plain, const Member& driven);
/// The members with one more; a driven law takes the place of the undriven one.
std::vector<Member> with_member(std::vector<Member> members, const Member& more);

/// The same effect in its plain form, where the member's bends it by further shapes (special): with
/// the shapes that both forms have and unit amplitudes.
std::optional<Member> plain_form(const Case& study, const Member& member);

/// What a shape's bounds and seeds are multiplied by on the axis of a machine; 1 for a tool.
double unit_of(const Case& study, const ShapeParameter& shape);

/// Whether the diagnosis of this case tries a form, undriven.
bool is_tried(const Case& study, const EffectFit& form);
/// The first form of an effect that is tried; the first of all where none is.
const EffectFit& first_form(const Case& study, const EffectKind& kind);

/// A member with these shapes and unit amplitudes.
Member make_member(const Case& study, const EffectKind& kind, const EffectFit& form,
                   const std::string& axis, const Eigen::VectorXd& shapes);

/// The same driven by a logged signal, which lags by `shapes`' last.
Member make_driven(const Case& study, const EffectKind& kind, const EffectFit& form,
                   const std::string& axis, const Eigen::VectorXd& shapes,
                   const Case::Driver& driver);

/// Lets the strength of a driven law follow its signal at once.
void leave_out_lag(Member& member);

/// Begins the components of the lever that the member's torque tells of at zero.
void add_lever(Member& member);
/// Lets the force act at the origin of S.
void leave_out_lever(Member& member);
/// Where the force acts [m, in S]; zero where torques are not measured.
Eigen::Vector3d lever_of(const Member& member);
/// The published parameters.
Json parameters_of(const Member& member);
EffectSpec spec_of(const Member& member);
std::vector<EffectSpec> specs_of(const std::vector<Member>& members);

/// A shape on the scale it is searched on: its logarithm where it must be positive.
double search_scale(const ShapeParameter& shape, double value);
/// The inverse for shape i of a member, held within its bounds.
double from_search_scale(const Member& member, Index i, double coordinate);

}  // namespace dcnn
