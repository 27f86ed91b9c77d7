// SPDX-License-Identifier: Apache-2.0
// A law while it is being searched for: its numbers by factor, ready to be changed.
#pragma once

#include <array>
#include <vector>

#include "dcnn/physics/law.h"

namespace dcnn::discovery {

struct Piece {
  law::Factor factor;
  double memory = 0.0, second = 0.0;  ///< of a state, where it has them
  double centre = 0.0, scale = 1.0, extra = 0.0;
  std::vector<double> values = {};  ///< of a curve, at its nodes
};

struct Sketch {
  std::size_t direction = 0;
  bool oblique = false;
  std::array<double, 3> own{};  ///< of the direction itself: two of an oblique axis, or a point, m
  double vector_scale = 1.0;
  double vector_lag = 0.0, lag = 0.0;  ///< s; 0 for none
  double vector_length = 0.0;          ///< m, of presliding; 0 for none
  double spread = 0.0;                 ///< of the lag; 0 for one lag
  double amplitude = 1.0;
  std::vector<Piece> pieces;
};

/// The numbers of a factor in the order in which a law holds them.
std::vector<double> numbers_of(const Piece& piece);

law::Structure structure_of(const Sketch& sketch);
/// Of the direction itself.
int own_numbers(const Sketch& sketch);
law::Vector3d own_vector(const Sketch& sketch);
/// The sketch along the axis `e` of the frame in which its direction is, told from the nearest of
/// that frame's axes.
Sketch with_axis(Sketch sketch, const law::Vector3d& e);
/// The law names those of `signals` that it takes; a sketch numbers them in the order of that list.
law::Law law_of(const Sketch& sketch, const std::vector<std::string>& signals);
Sketch sketch_of(const law::Law& law, const std::vector<std::string>& signals);

/// Place of a shape, coordinate or direction by its name.
std::size_t shape_named(const char* name);
std::size_t coordinate_named(const char* name);
std::size_t direction_named(const char* name);

/// The same law with the numbers at which its amplitude is told rounded to one digit.
Sketch with_round_references(Sketch sketch);

/// Numbers that are fitted, the amplitude among them.
int free_numbers(const Sketch& sketch);
/// States and lags.
int memories(const Sketch& sketch);

}  // namespace dcnn::discovery
