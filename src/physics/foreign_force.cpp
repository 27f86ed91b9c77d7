// SPDX-License-Identifier: Apache-2.0
#include "physics/foreign_force.h"

#include <algorithm>
#include <cstdio>

namespace dcnn {

double foreign_share(double residual, double noise, double force) {
  return force > 0.0 ? std::clamp((residual - noise) / force, 0.0, 1.0) : 0.0;
}

std::string foreign_force_note(double share, const std::string& conclusion,
                               const std::string& what) {
  // A prior: numbers fitted to a force that is mostly something else are not the tool's.
  constexpr double kMostForeign = 0.5;
  if (share <= kMostForeign) return {};
  char percent[16];
  std::snprintf(percent, sizeof percent, "%.0f", 100.0 * share);
  return std::string(percent) + " % of " + what + ": " + conclusion;
}

}  // namespace dcnn
