// The shape that all friction laws share: a force -law(v)·n against the velocity along an axis.
#pragma once

#include "physics/effect_law.h"

namespace dcnn {

/// Subtracts law(v, k)·n from the force of each sample k, in order of time.
template <class Law>
void resist(Wrench& wrench, const Line& line, Law law) {
  for (Index k = 0; k < line.velocity.size(); ++k) {
    wrench.force.row(k) -= law(line.velocity(k), k) * line.n_S.row(k);
  }
}

/// EffectKind::apply and ::stream of a law without memory; `law(parameters)` gives the force
/// against the velocity.
template <auto law>
void resisted(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
              Options& parameters) {
  resist(wrench, line_of(spec.axis, motion),
         [law_of_v = law(parameters)](double v, Index) { return law_of_v(v); });
}
template <auto law>
EffectStream resisting(const EffectSpec& spec, Options& parameters) {
  return [line = LineNow(spec.axis), law_of_v = law(parameters)](InstantWrench& wrench,
                                                                 const Instant& now) {
    wrench.force -= law_of_v(line.velocity(now)) * line.n_S(now);
  };
}

}  // namespace dcnn
