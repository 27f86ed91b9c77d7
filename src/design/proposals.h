// SPDX-License-Identifier: Apache-2.0
// Motions to be judged: control points drawn at random, and changed at random.
#pragma once

#include "design/path.h"

namespace dcnn::design {

/// Draws points that use the ranges: random targets, strokes to and fro at speeds of a decade,
/// turns through the whole range, stops. The spacing of the points is what the limits allow, or up
/// to four times as long.
Spline draw_spline(const Limits& limits, double seconds, Rng& rng);

/// Another draw for a piece of time of some coordinates, or all of one made larger or smaller about
/// the start.
Spline changed(const Spline& spline, const Limits& limits, Rng& rng);

}  // namespace dcnn::design
