// SPDX-License-Identifier: Apache-2.0
// Shapes of coloured noise over frequency.
#pragma once

#include <algorithm>
#include <numbers>
#include <vector>

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

/// Power gain of linear interpolation (Recording::interpolated), averaged over the rows; 1 where
/// rows are as logged.
inline double interpolated_shape(const std::vector<double>& covariance, double hz, double dt) {
  if (covariance.empty()) return 1.0;
  double sum = covariance.front();
  for (std::size_t lag = 1; lag < covariance.size(); ++lag) {
    sum += 2.0 * covariance[lag] *
           elementary::cos(2.0 * std::numbers::pi * hz * dt * static_cast<double>(lag));
  }
  return std::max(0.0, sum);
}

}  // namespace dcnn
