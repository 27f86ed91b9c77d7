// SPDX-License-Identifier: Apache-2.0
#include "discovery/handles.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "discovery/priors.h"

namespace dcnn::discovery {
namespace {

constexpr double kFarthestPoint = 3.0;  // diagonals of what was reached
constexpr double kLeastSpread = 1.5;    // of lags: below it one does the same
constexpr double kSteepest = 3.0;       // of an oblique axis: beyond 1 another axis is nearer

Handle positive(double& value, double low, double high) {
  return {&value, true, low, high, 0.01, 0.8};
}

void add_handles(const Data& data, Piece& piece, std::vector<Handle>& list) {
  const std::size_t c = piece.factor.coordinate;
  const law::Shape& shape = law::shapes()[piece.factor.shape];
  const bool clock_memory = piece.factor.memory == law::Memory::kLag ||
                            piece.factor.memory == law::Memory::kHighPass ||
                            piece.factor.memory == law::Memory::kDelay;
  if (clock_memory) {
    list.push_back(positive(piece.memory, 2.0 * data.dt(), 0.5 * data.seconds()));
  } else if (piece.factor.memory == law::Memory::kSecondOrder) {
    list.push_back(positive(piece.memory, 1.0 / data.seconds(), 0.25 / data.dt()));
    list.push_back(positive(piece.second, law::kLeastDamping, law::kMostDamping));
  } else if (piece.factor.memory == law::Memory::kThixotropic) {
    const double path = data.path_range(c);
    list.push_back(positive(piece.memory, 1e-3 * path, 100.0 * path));
    list.push_back(positive(piece.second, 2.0 * data.dt(), data.seconds()));
  } else if (piece.factor.memory == law::Memory::kPlay) {
    list.push_back(positive(piece.memory, 1e-3 * data.half_range(c), data.half_range(c)));
  } else if (piece.factor.memory == law::Memory::kStop) {
    list.push_back(positive(piece.memory, 1e-3 * data.path_range(c), data.path_range(c)));
  } else if (piece.factor.memory == law::Memory::kPlays) {
    list.push_back(positive(piece.memory, 1e-2 * data.half_range(c), 4.0 * data.half_range(c)));
  } else if (piece.factor.memory == law::Memory::kLags) {
    list.push_back(positive(piece.memory, 2.0 * data.dt(), 2.0 * data.seconds()));
    list.push_back(positive(piece.second, kLeastSpread, law::kMostSpread));
  } else if (piece.factor.memory != law::Memory::kNone) {
    list.push_back(positive(piece.memory, 1e-3 * data.path_range(c), 2.0 * data.path_range(c)));
  }
  const double range = data.half_range(c);
  if (piece.factor.centred && shape.free_centre) {
    list.push_back({&piece.centre, false, data.low(c) - range, data.high(c) + range, 5e-3 * range,
                    0.3 * range});
  }
  if (shape.free_scale) {
    const double size = std::max(range, data.rms(c));
    list.push_back(positive(piece.scale, 2e-3 * size, 50.0 * size));
  }
  for (std::size_t k = 0; k < piece.values.size(); ++k) {
    if (k != piece.factor.peak) list.push_back({&piece.values[k], false, -1e3, 1e3, 0.02, 10.0});
  }
  if (!*shape.extra) return;
  const bool is_power = shape.most < 100.0;
  list.push_back({&piece.extra, false, is_power ? prior::kLeastPower : shape.least, shape.most,
                  is_power ? 0.01 : 0.01 * (1.0 + std::abs(piece.extra)),
                  is_power ? 0.5 : 2.0 * (1.0 + std::abs(piece.extra))});
}

/// Two of an oblique axis, or the place of a point, which may lie outside what was reached.
void add_own_handles(const Data& data, Sketch& sketch, std::vector<Handle>& list) {
  if (law::is_central(sketch.direction)) {
    const std::size_t x = coordinate_named("x");
    const double diagonal = 2.0 * data.rms(coordinate_named("distance"));
    for (std::size_t k = 0; k < 3; ++k) {
      list.push_back({&sketch.own[k], false, data.low(x + k) - kFarthestPoint * diagonal,
                      data.high(x + k) + kFarthestPoint * diagonal, 2e-3 * diagonal,
                      0.15 * diagonal});
    }
  } else if (sketch.oblique) {
    for (std::size_t k = 0; k < 2; ++k) {
      list.push_back({&sketch.own[k], false, -kSteepest, kSteepest, 0.01, 0.3});
    }
  }
}

}  // namespace

double Handle::get() const { return logarithmic ? elementary::log(std::abs(*value)) : *value; }

void Handle::set(double x) const {
  if (logarithmic) {
    const double size = std::clamp(elementary::exp(x), low, high);
    *value = std::copysign(size, *value);
  } else {
    *value = std::clamp(x, low, high);
  }
}

std::vector<Handle> handles_of(const Data& data, Sketch& sketch) {
  std::vector<Handle> list;
  add_own_handles(data, sketch, list);
  if (sketch.vector_lag > 0.0) {
    list.push_back(positive(sketch.vector_lag, 2.0 * data.dt(), 0.5 * data.seconds()));
  }
  if (sketch.vector_length > 0.0) {
    const double length = data.diagonal();
    list.push_back(positive(sketch.vector_length, 1e-4 * length, 10.0 * length));
  }
  if (sketch.lag > 0.0) {
    list.push_back(positive(sketch.lag, 0.5 * data.dt(), 0.5 * data.seconds()));
  }
  if (sketch.spread > 0.0) {
    list.push_back(positive(sketch.spread, kLeastSpread, law::kMostSpread));
  }
  for (std::size_t k = 0; k < sketch.pieces.size(); ++k) {
    const std::size_t begin = list.size();
    add_handles(data, sketch.pieces[k], list);
    for (std::size_t i = begin; i < list.size(); ++i) list[i].of_piece = static_cast<int>(k);
  }
  return list;
}

}  // namespace dcnn::discovery
