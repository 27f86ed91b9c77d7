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

}  // namespace dcnn
