// SPDX-License-Identifier: Apache-2.0
// The shape that all friction laws share: a force -law(v)·n against the velocity along an axis.
#pragma once

#include "physics/effect_law.h"

namespace dcnn {

/// Times its friction of motion, that a machine's dry friction is at rest at most.
constexpr double kMostAtRest = 4.0;

/// Subtracts law(v, k)·n from the force of each sample k, called in order of time.
template <class Law>
void resist(Wrench& wrench, const std::string& axis, const Motion& motion,
            const Eigen::VectorXd& velocity, Law law) {
  Eigen::VectorXd force(velocity.size());
  for (Index k = 0; k < force.size(); ++k) force(k) = -law(velocity(k), k);
  push_along(axis, motion, force, wrench);
}

/// EffectKind::apply and ::stream of a law without memory; `law(parameters)` gives the force
/// against the velocity.
template <auto law>
void resisted(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
              Options& parameters) {
  resist(wrench, spec.axis, motion, velocity_of(spec.axis, motion),
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
