// SPDX-License-Identifier: Apache-2.0
// A signal as it was some time ago, between samples by a cubic.
#pragma once

#include <algorithm>
#include <cmath>

#include "dcnn/physics/motion.h"

namespace dcnn {

/// The cubic through the four samples about `place` (in samples from `begin`), Lagrange's form;
/// near an end the outermost four. Before the first sample the signal rests at its first value,
/// after the last at that. `x(i)` is sample i of `size`.
template <class Signal>
double interpolate(const Signal& x, Index size, double place) {
  if (place <= 0.0) return x(0);
  if (place >= static_cast<double>(size - 1)) return x(size - 1);
  if (size < 4) return x(std::min<Index>(std::llround(place), size - 1));
  const Index first = std::clamp<Index>(static_cast<Index>(place) - 1, 0, size - 4);
  const double s = place - static_cast<double>(first);
  const auto at = [&](Index i) { return x(first + i); };
  return -(s - 1) * (s - 2) * (s - 3) / 6.0 * at(0) + s * (s - 2) * (s - 3) / 2.0 * at(1) -
         s * (s - 1) * (s - 3) / 2.0 * at(2) + s * (s - 1) * (s - 2) / 6.0 * at(3);
}

/// Each column of signals of these rows as it was `seconds` earlier (later where they are
/// negative), within each segment; at its ends the outermost value.
void delay(Eigen::MatrixXd& signals, const Motion& motion, double seconds);

}  // namespace dcnn
