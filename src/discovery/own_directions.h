// SPDX-License-Identifier: Apache-2.0
// Directions with numbers of their own: oblique axes, and points that forces point away from.
#pragma once

#include "discovery/dictionary.h"

namespace dcnn::discovery {

/// Oblique axes of base and sensor on a coarse grid of directions, axes of the base behind lags,
/// and points in and around the space that was reached; without factors.
std::vector<Sketch> own_directions(const Data& data);
/// Factors of coordinates along such an axis, or of the distance from such a point.
std::vector<Atom> own_atoms(const Data& data, const Sketch& direction);

/// The same law along an oblique axis, which begins at the plain one; what is taken along the axis
/// turns with it. None where it cannot be, or is, oblique.
std::vector<Sketch> made_oblique(const Sketch& from);
/// Laws along the same oblique axis, each with one coordinate taken along it in place of one along
/// an axis of its frame.
std::vector<Sketch> made_along(const Sketch& from);
/// The same law along the nearest plain axis.
std::vector<Sketch> made_plain(const Sketch& from);

}  // namespace dcnn::discovery
