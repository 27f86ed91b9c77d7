// SPDX-License-Identifier: Apache-2.0
// Shapes of coloured noise over frequency.
#pragma once

#include <numbers>

#include "core/elementary.h"

namespace dcnn {

/// Shape of AR(1) noise of unit variance.
inline double ar_shape(double rho, double hz, double dt) {
  return (1.0 - rho * rho) /
         (1.0 - 2.0 * rho * elementary::cos(2.0 * std::numbers::pi * hz * dt) + rho * rho);
}

/// Power gain of a second-order Butterworth filter.
inline double filter_shape(double cutoff_hz, double hz) {
  const double r = hz / cutoff_hz;
  return 1.0 / (1.0 + r * r * r * r);
}

}  // namespace dcnn
