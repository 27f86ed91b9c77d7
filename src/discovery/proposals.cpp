// SPDX-License-Identifier: Apache-2.0
// Changes of a law that are tried: other shapes, further factors, memories.
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "discovery/dictionary.h"

namespace dcnn::discovery {
namespace {

using law::Memory;

/// States that are no displacement or rate of their coordinate.
bool has_other_unit(Memory memory) {
  return memory == Memory::kDahl || memory == Memory::kStop || memory == Memory::kDwell ||
         memory == Memory::kThixotropic;
}

void add_modulators(const Data& data, std::size_t c, std::vector<Piece>& list) {
  const double range = data.half_range(c), middle = data.middle(c);
  const Kind kind = kind_of(c);
  if (kind == Kind::kClock) {
    list.push_back(piece("exponential", c, 0.3 * (data.high(c) - data.low(c))));
    return;
  }
  list.push_back(centred(piece("affine", c, range, 0.3), middle));
  if (kind == Kind::kSize) {
    for (const double tau : {1.0, 3.0, 10.0}) {
      list.push_back(remembering(piece("affine", c, data.rms(c), 1.0), Memory::kLag, tau));
    }
  }
  if (kind != Kind::kPlace) list.push_back(piece("linear", c, data.rms(c)));
  if (kind == Kind::kRate || kind == Kind::kLoad) {
    list.push_back(piece("switched", c, 0.1 * data.rms(c), 0.3));
  }
  if (kind == Kind::kRate || kind == Kind::kSize) {
    list.push_back(piece("falling", c, 0.3 * data.rms(c), 0.3));
  }
  if (kind == Kind::kRate || kind == Kind::kLoad) {
    list.push_back(piece("even_power", c, data.rms(c), 1.0));
    list.push_back(piece("tanh", c, 0.2 * data.rms(c)));
    for (const double side : {1.0, -1.0}) {
      list.push_back(piece("one_sided", c, side * data.rms(c), 1.0));
    }
  }
  if (law::coordinates()[c].is_rate) {  // a contact that grows with its age
    for (const double length : {0.001, 0.01}) {
      const Piece aged = piece("affine", c, 1.0, 0.1);
      list.push_back(remembering(aged, Memory::kDwell, length * data.path_range(c)));
    }
    for (const double length : {0.1, 1.0}) {  // what motion breaks down and a rest rebuilds
      for (const double seconds : {1.0, 5.0}) {
        const Piece built = piece("affine", c, 1.0, 1.0);
        list.push_back(thixotropic(built, length * data.path_range(c), seconds));
      }
    }
  }
  if (kind != Kind::kPlace) return;
  for (const double at : {-0.4, 0.0, 0.4}) {
    list.push_back(centred(piece("gaussian", c, 0.3 * range), middle + at * range));
    list.push_back(centred(piece("switched", c, 0.1 * range, 0.3), middle + at * range));
  }
  const bool angle = std::string(law::coordinates()[c].unit) == "rad";
  for (const double turns : {1.0, 2.0, 3.0, 5.0}) {
    const double scale = angle ? 1.0 / turns : range / (3.1 * turns);
    for (const double phase : {0.0, 1.57}) {
      list.push_back(centred(piece("wavy", c, scale, 0.3), middle - phase * scale));
    }
  }
}

}  // namespace

bool has_constant(const Sketch& sketch) {
  if (sketch.pieces.size() != 1 || !law::is_axis(sketch.direction)) return false;
  const law::Factor& factor = sketch.pieces[0].factor;
  const bool line = factor.centred && factor.shape == shape_named("linear");
  return (line || factor.shape == shape_named("affine")) && factor.memory == law::Memory::kNone &&
         kind_of(factor.coordinate) != Kind::kPlace;
}

std::vector<Piece> without_constant(const Piece& from) {
  constexpr double kMostly = 3.0;  // times the constant: a limit of computation, the score decides
  if (std::abs(from.extra) < kMostly) return {};
  const std::string name = law::shapes()[from.factor.shape].name;
  Piece p = from;
  p.extra = 0.0;
  if (name == "affine") {
    p.factor.shape = shape_named("linear");
    p.factor.centred = true;
    p.centre -= from.scale / from.extra;
  } else if (name == "wavy") {
    p.factor.shape = shape_named("sine");
  } else if (name == "switched") {
    p.factor.shape = shape_named("step");
  } else if (name == "falling") {
    p.factor.shape = shape_named("gaussian");
    p.scale = from.scale / std::numbers::sqrt2;
  } else {
    return {};
  }
  return {p};
}

std::vector<Piece> modulators(const Data& data) {
  std::vector<Piece> list;
  for (std::size_t c = 0; c < law::coordinates().size(); ++c) {
    if (data.varies(c) && !law::is_own(c)) add_modulators(data, c, list);
  }
  return list;
}

std::vector<Piece> other_shapes(const Data& data, const Piece& from) {
  std::vector<Piece> list = without_constant(from);
  const std::size_t c = from.factor.coordinate;
  const double size = kind_of(c) == Kind::kPlace ? data.half_range(c) : data.rms(c);
  const auto add = [&](const char* shape, double scale, double extra = 0.0) {
    Piece p = from;
    p.factor.shape = shape_named(shape);
    if (p.factor.shape == from.factor.shape) return;
    p.scale = scale;
    p.extra = extra;
    list.push_back(p);
  };
  if (has_other_unit(from.factor.memory)) return list;
  if (!from.values.empty()) return list;
  add("linear", size);
  add("power", size, 1.5);
  add("even_power", size, 1.5);
  add("tanh", 0.3 * size);
  add("peaked", 0.5 * size);
  add("fading", 0.5 * size);
  add("log", 0.3 * size);
  add("dead_band", 0.4 * size);
  add("asymmetric", size, 0.5);
  add("one_sided", size, 1.0);
  add("one_sided", -size, 1.0);
  add("step", 0.2 * size);
  add("step", -0.2 * size);
  if (from.extra != 0.0) add("switched", 0.2 * size, from.extra);
  if (kind_of(c) == Kind::kSize) add("inverse_power", size, 2.0);
  if (kind_of(c) == Kind::kSignal) add("exponential", data.half_range(c));
  if (c == coordinate_named("distance")) {
    add("gaussian", size);
    add("exponential", 0.5 * size);
  }
  if (kind_of(c) == Kind::kPlace) {
    add("gaussian", 0.4 * size);
    add("sine", 0.5 * size);
  }
  return list;
}

namespace {

/// Where the coordinate, or the state that it drives, lies: centre and half of the range.
std::pair<double, double> range_of(const Data& data, const law::Factor& factor) {
  if (factor.memory == Memory::kDahl || factor.memory == Memory::kStop) return {0.0, 1.0};
  if (factor.memory == Memory::kHighPass) return {0.0, data.half_range(factor.coordinate)};
  return {data.middle(factor.coordinate), data.half_range(factor.coordinate)};
}

double value_at(const Piece& piece, double q) {
  const double u = (q - piece.centre) / piece.scale;
  if (!piece.values.empty()) return law::curve_at(piece.values.data(), piece.values.size(), u);
  return law::shapes()[piece.factor.shape].value(u, piece.extra);
}

/// `from` with the curve through f's values in the place of its shape; none where these are zero.
template <class Function>
std::vector<Piece> sampled(const Data& data, const Piece& from, std::size_t nodes,
                           const Function& f) {
  Piece p = from;
  p.factor.shape = shape_named("curve");
  p.factor.nodes = nodes;
  p.factor.peak = 0;
  p.factor.centred = true;
  std::tie(p.centre, p.scale) = range_of(data, from.factor);
  p.values.resize(nodes);
  for (std::size_t k = 0; k < nodes; ++k) {
    const double u = 2.0 * static_cast<double>(k) / static_cast<double>(nodes - 1) - 1.0;
    p.values[k] = f(p.centre + u * p.scale);
    if (std::abs(p.values[k]) > std::abs(p.values[p.factor.peak])) p.factor.peak = k;
  }
  const double peak = p.values[p.factor.peak];
  if (!(std::abs(peak) > 0.0)) return {};
  for (double& value : p.values) value /= peak;
  return {p};
}

}  // namespace

std::vector<Piece> as_curves(const Data& data, const Piece& from) {
  constexpr std::size_t kFirst = 7, kFine = 25, kMost = 25;
  const Memory memory = from.factor.memory;
  if (memory == Memory::kDwell || memory == Memory::kThixotropic) return {};
  if (memory == Memory::kSecondOrder) return {};
  if (kind_of(from.factor.coordinate) == Kind::kClock) return {};
  const auto f = [&](double q) { return value_at(from, q); };
  if (from.values.empty()) {  // a fine table may be right where a coarse one is not
    auto list = sampled(data, from, kFirst, f);
    if (has_other_unit(memory)) return list;  // which is mostly at its ends
    const auto fine = sampled(data, from, kFine, f);
    list.insert(list.end(), fine.begin(), fine.end());
    return list;
  }
  const std::size_t nodes = from.values.size(), more = 2 * nodes - 1, fewer = (nodes + 1) / 2;
  std::vector<Piece> list;
  if (more <= kMost && !has_other_unit(memory)) list = sampled(data, from, more, f);
  if (fewer >= law::kFewestNodes) {
    const auto plain = sampled(data, from, fewer, f);
    list.insert(list.end(), plain.begin(), plain.end());
  }
  return list;
}

std::vector<Piece> merged(const Data& data, const Piece& first, const Piece& second) {
  constexpr std::size_t kNodes = 13;
  const std::size_t c = first.factor.coordinate;
  const bool joins = c == second.factor.coordinate && kind_of(c) != Kind::kClock &&
                     first.factor.memory == Memory::kNone && second.factor.memory == Memory::kNone;
  if (!joins) return {};
  return sampled(data, first, kNodes,
                 [&](double q) { return value_at(first, q) * value_at(second, q); });
}

Piece without_memory(const Data& data, const Piece& from) {
  const std::size_t c = from.factor.coordinate;
  const bool other_unit = has_other_unit(from.factor.memory);
  if (other_unit && kind_of(c) != Kind::kPlace) return piece("tanh", c, 0.3 * data.rms(c));
  if (other_unit) return centred(piece("tanh", c, 0.3 * data.half_range(c)), data.middle(c));
  Piece plain = from;
  plain.factor.memory = Memory::kNone;
  if (!plain.values.empty()) std::tie(plain.centre, plain.scale) = range_of(data, plain.factor);
  return plain;
}

std::vector<Piece> with_memories(const Data& data, const Piece& from) {
  std::vector<Piece> list;
  const std::size_t c = from.factor.coordinate;
  if (from.factor.memory != Memory::kNone) {  // another in its place
    list = with_memories(data, without_memory(data, from));
    std::erase_if(list, [&](const Piece& p) { return p.factor.memory == from.factor.memory; });
    return list;
  }
  list.push_back(remembering(from, Memory::kLag, 0.2));
  list.push_back(lagging(from, 1.0, 30.0));
  for (const double delay : {0.1, 0.3}) list.push_back(remembering(from, Memory::kDelay, delay));
  if (kind_of(c) == Kind::kRate || kind_of(c) == Kind::kLoad) {
    for (const double hz : {0.7, 2.0}) list.push_back(swinging(from, hz));
  }
  if (kind_of(c) == Kind::kPlace || kind_of(c) == Kind::kLoad || kind_of(c) == Kind::kSignal) {
    list.push_back(remembering(from, Memory::kPlay, 0.1 * data.half_range(c)));
    list.push_back(remembering(from, Memory::kPlays, 0.5 * data.half_range(c)));
  }
  if (kind_of(c) == Kind::kPlace || law::coordinates()[c].is_rate) {
    Piece p = piece("linear", c, 1.0);
    list.push_back(remembering(p, Memory::kDahl, 0.03 * data.path_range(c)));
    list.push_back(remembering(p, Memory::kStop, 0.03 * data.path_range(c)));
  }
  return list;
}

}  // namespace dcnn::discovery
