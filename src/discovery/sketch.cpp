// SPDX-License-Identifier: Apache-2.0
#include "discovery/sketch.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/elementary.h"

namespace dcnn::discovery {
namespace {

template <class List>
std::size_t place_named(const List& list, const char* name) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (std::string(name) == list[k].name) return k;
  }
  assert(false && "a shape, coordinate or direction of this name");
  return 0;
}

/// Place of a name in the list, or the list's length.
std::size_t place_of(const std::vector<std::string>& list, const std::string& name) {
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), name) - list.begin());
}

double one_digit(double value) {
  const double size = elementary::pow(
      10.0, static_cast<int>(std::floor(elementary::log(std::abs(value)) / elementary::log(10.0))));
  return std::copysign(std::round(std::abs(value) / size) * size, value);
}

law::Structure direction_of(const Sketch& sketch) {
  law::Structure structure;
  structure.direction = sketch.direction;
  structure.oblique = sketch.oblique;
  return structure;
}

bool has_vector_scale(const Sketch& sketch) {
  return *law::directions()[sketch.direction].unit != 0;
}

template <class AnyPiece, class Visit>
void each_number_of(AnyPiece& piece, const Visit& visit) {
  if (piece.factor.memory != law::Memory::kNone) visit(piece.memory);
  if (law::numbers_of(piece.factor.memory) > 1) visit(piece.second);
  if (piece.factor.centred) visit(piece.centre);
  visit(piece.scale);
  if (*law::shapes()[piece.factor.shape].extra) visit(piece.extra);
  for (auto& value : piece.values) visit(value);
}

/// Visits the numbers of a sketch in the order in which a law holds them.
template <class AnySketch, class Visit>
void each_number(AnySketch& sketch, const Visit& visit) {
  visit(sketch.amplitude);
  if (has_vector_scale(sketch)) visit(sketch.vector_scale);
  for (int k = 0; k < own_numbers(sketch); ++k) visit(sketch.own[static_cast<std::size_t>(k)]);
  if (sketch.vector_lag > 0.0) visit(sketch.vector_lag);
  if (sketch.vector_length > 0.0) visit(sketch.vector_length);
  if (sketch.lag > 0.0) visit(sketch.lag);
  if (sketch.spread > 0.0) visit(sketch.spread);
  for (auto& piece : sketch.pieces) each_number_of(piece, visit);
}

}  // namespace

std::size_t shape_named(const char* name) { return place_named(law::shapes(), name); }
std::size_t coordinate_named(const char* name) { return place_named(law::coordinates(), name); }
std::size_t direction_named(const char* name) { return place_named(law::directions(), name); }

std::vector<double> numbers_of(const Piece& piece) {
  std::vector<double> numbers;
  each_number_of(piece, [&](double value) { numbers.push_back(value); });
  return numbers;
}

int own_numbers(const Sketch& sketch) { return law::own_numbers(direction_of(sketch)); }

law::Vector3d own_vector(const Sketch& sketch) {
  return law::own_vector(direction_of(sketch), sketch.own.data());
}

Sketch with_axis(Sketch sketch, const law::Vector3d& e) {
  Eigen::Index k = 0;
  e.cwiseAbs().maxCoeff(&k);
  sketch.direction = sketch.direction / 3 * 3 + static_cast<std::size_t>(k);
  sketch.oblique = true;
  sketch.own = {e[(k + 1) % 3] / e[k], e[(k + 2) % 3] / e[k], 0.0};
  return sketch;
}

law::Structure structure_of(const Sketch& sketch) {
  law::Structure structure = direction_of(sketch);
  structure.direction_lagged = sketch.vector_lag > 0.0;
  structure.presliding = sketch.vector_length > 0.0;
  structure.lagged = sketch.lag > 0.0;
  structure.spread = sketch.spread > 0.0;
  for (const Piece& piece : sketch.pieces) structure.factors.push_back(piece.factor);
  return structure;
}

law::Law law_of(const Sketch& sketch, const std::vector<std::string>& signals) {
  std::vector<double> numbers;
  each_number(sketch, [&](double value) { numbers.push_back(value); });
  law::Structure structure = structure_of(sketch);
  for (law::Factor& factor : structure.factors) {
    if (!law::is_signal(factor.coordinate)) continue;
    const std::string& name = signals.at(factor.coordinate - law::signal_coordinate(0));
    factor.coordinate = law::signal_coordinate(place_of(structure.signals, name));
    if (factor.coordinate == law::signal_coordinate(structure.signals.size())) {
      structure.signals.push_back(name);
    }
  }
  return {structure,
          Eigen::Map<Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()))};
}

Sketch sketch_of(const law::Law& law, const std::vector<std::string>& signals) {
  Sketch sketch;
  sketch.direction = law.structure.direction;
  sketch.oblique = law.structure.oblique;
  sketch.vector_lag = law.structure.direction_lagged ? 1.0 : 0.0;
  sketch.vector_length = law.structure.presliding ? 1.0 : 0.0;
  sketch.lag = law.structure.lagged ? 1.0 : 0.0;
  sketch.spread = law.structure.spread ? 1.0 : 0.0;
  for (const law::Factor& factor : law.structure.factors) {
    Piece piece;
    piece.factor = factor;
    if (law::is_signal(factor.coordinate)) {
      const std::size_t own = factor.coordinate - law::signal_coordinate(0);
      piece.factor.coordinate =
          law::signal_coordinate(place_of(signals, law.structure.signals.at(own)));
    }
    piece.values.resize(factor.nodes);
    sketch.pieces.push_back(piece);
  }
  Eigen::Index next = 0;
  each_number(sketch, [&](double& value) { value = law.numbers(next++); });
  return sketch;
}

Sketch with_round_references(Sketch sketch) {
  if (has_vector_scale(sketch)) sketch.vector_scale = one_digit(sketch.vector_scale);
  for (Piece& piece : sketch.pieces) {
    const law::Shape& shape = law::shapes()[piece.factor.shape];
    if (shape.free_scale || !piece.values.empty()) continue;
    const double before = piece.scale;
    piece.scale = one_digit(before);
    if (*shape.extra && piece.factor.shape == shape_named("affine")) {
      piece.extra *= piece.scale / before;
    }
  }
  return sketch;
}

int free_numbers(const Sketch& sketch) {
  int count = 0;
  for (const law::Number& number : law::numbers_of(structure_of(sketch))) {
    count += !number.is_reference;
  }
  return count;
}

int memories(const Sketch& sketch) {
  int count = (sketch.lag > 0.0) + (sketch.vector_lag > 0.0) + (sketch.vector_length > 0.0);
  for (const Piece& piece : sketch.pieces) count += piece.factor.memory != law::Memory::kNone;
  return count;
}

}  // namespace dcnn::discovery
