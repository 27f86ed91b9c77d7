// SPDX-License-Identifier: Apache-2.0
// Where a search for a law begins: factors with numbers, without a direction.
#pragma once

#include "discovery/data.h"

namespace dcnn::discovery {

/// What may be done with a coordinate.
enum class Kind {
  kRate,    ///< signed, with a zero of its own
  kSize,    ///< not negative
  kPlace,   ///< without a zero of its own: position, angle
  kLoad,    ///< a force
  kSignal,  ///< logged, of any unit
  kClock,
};
Kind kind_of(std::size_t coordinate);

Piece piece(const char* shape, std::size_t coordinate, double scale, double extra = 0.0);
Piece centred(Piece piece, double centre);
Piece remembering(Piece piece, law::Memory memory, double size);
/// Behind a state of second order with this natural frequency, lightly damped.
Piece swinging(Piece piece, double hz);
/// Behind many lags about `seconds`.
Piece lagging(Piece piece, double seconds, double spread);
/// Broken down by motion over `length`, rebuilt in `seconds`.
Piece thixotropic(Piece piece, double length, double seconds);

/// A factor linear in the coordinate, about the middle of its range where it has no zero.
Piece linear_in(const Data& data, std::size_t coordinate);

using Atom = std::vector<Piece>;
/// Some thousand single factors and products of two.
std::vector<Atom> dictionary(const Data& data);

/// A direction, perhaps behind a lag; the sketch has no factors.
std::vector<Sketch> direction_sketches(const Data& data);

/// Factors by which a law may be multiplied.
std::vector<Piece> modulators(const Data& data);
/// Other shapes of a piece's coordinate.
std::vector<Piece> other_shapes(const Data& data, const Piece& piece);
/// A line of a rate or a load along an axis, and a constant force, which is an effect with a name.
bool has_constant(const Sketch& sketch);
/// What 1 + p f(u) is for large p: f(u) alone, which needs one number fewer. Nothing for others.
std::vector<Piece> without_constant(const Piece& piece);
/// The piece's shape as a curve, or a curve with twice or half as many nodes.
std::vector<Piece> as_curves(const Data& data, const Piece& piece);
/// The same shape of the coordinate itself; of states in another unit, the one most alike.
Piece without_memory(const Data& data, const Piece& piece);
/// Two shapes of one coordinate without states as one curve; none of others.
std::vector<Piece> merged(const Data& data, const Piece& first, const Piece& second);
/// The piece with a state between coordinate and shape, or with another one.
std::vector<Piece> with_memories(const Data& data, const Piece& piece);

}  // namespace dcnn::discovery
