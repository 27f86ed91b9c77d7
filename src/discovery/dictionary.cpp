// SPDX-License-Identifier: Apache-2.0
#include "discovery/dictionary.h"

#include <string>

namespace dcnn::discovery {
namespace {

using law::Memory;

/// What swings with an acceleration or a force: liquid, a hanging load, a flexible part.
void add_swings(const Data& data, std::size_t c, std::vector<Atom>& list) {
  for (const double hz : {0.3, 0.5, 0.8, 1.2, 1.8, 2.7, 4.0, 6.0}) {
    list.push_back({swinging(piece("linear", c, data.rms(c)), hz)});
  }
}

void add_rate(const Data& data, std::size_t c, std::vector<Atom>& list) {
  const double rms = data.rms(c);
  const auto add = [&](const Piece& p) { list.push_back({p}); };
  add(piece("linear", c, rms));
  for (const double p : {0.5, 2.0, 3.0}) add(piece("power", c, rms, p));
  for (const double p : {1.0, 2.0}) add(piece("even_power", c, rms, p));
  for (const double s : {0.05, 0.2, 0.6}) add(piece("tanh", c, s * rms));
  for (const double s : {0.15, 0.4, 1.0}) add(piece("peaked", c, s * rms));
  for (const double s : {0.5, 1.0}) add(piece("dead_band", c, s * rms));
  for (const double s : {1.0, -1.0}) add(piece("one_sided", c, s * rms, 1.0));
  for (const double tau : {0.05, 0.2, 0.6, 2.0}) {
    add(remembering(piece("linear", c, rms), Memory::kLag, tau));
  }
  for (const double delay : {0.08, 0.16, 0.25, 0.4}) {
    add(remembering(piece("linear", c, rms), Memory::kDelay, delay));
  }
  if (!law::coordinates()[c].is_rate) {
    add_swings(data, c, list);
    return;
  }
  for (const double width : {0.01, 0.04, 0.15}) {
    add(remembering(piece("linear", c, 1.0), Memory::kDahl, width * data.path_range(c)));
  }
}

void add_size(const Data& data, std::size_t c, std::vector<Atom>& list) {
  const double rms = data.rms(c);
  for (const double p : {0.5, 1.0, 2.0, 3.0}) list.push_back({piece("even_power", c, rms, p)});
  list.push_back({piece("tanh", c, 0.5 * rms)});
  for (const double tau : {0.3, 1.0, 3.0, 10.0}) {
    list.push_back({remembering(piece("even_power", c, rms, 1.0), Memory::kLag, tau)});
    list.push_back({remembering(piece("even_power", c, rms, 2.0), Memory::kLag, tau)});
  }
}

void add_bumps(const Data& data, std::size_t c, std::vector<Atom>& list) {
  const double range = data.half_range(c), middle = data.middle(c);
  for (const double at : {-0.6, -0.3, 0.0, 0.3, 0.6}) {
    for (const double width : {0.15, 0.4}) {
      list.push_back({centred(piece("gaussian", c, width * range), middle + at * range)});
    }
  }
  for (const double at : {-0.4, 0.0, 0.4}) {
    const double centre = middle + at * range;
    for (const double side : {1.0, -1.0}) {
      for (const double p : {1.0, 2.0}) {
        list.push_back({centred(piece("one_sided", c, side * range, p), centre)});
      }
    }
    list.push_back({centred(piece("tanh", c, 0.2 * range), centre)});
  }
}

void add_waves(const Data& data, std::size_t c, std::vector<Atom>& list) {
  const bool angle = std::string(law::coordinates()[c].unit) == "rad";
  for (const double turns : {0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0}) {
    const double scale = angle ? 1.0 / turns : data.half_range(c) / (3.1 * turns);
    if (angle && turns != 1.5 && turns < 1.0) continue;
    for (const double phase : {0.0, 1.57}) {
      list.push_back({centred(piece("sine", c, scale), data.middle(c) - phase * scale)});
    }
  }
}

void add_place(const Data& data, std::size_t c, std::vector<Atom>& list) {
  const double range = data.half_range(c), middle = data.middle(c);
  const auto add = [&](const Piece& p) { list.push_back({centred(p, middle)}); };
  add(piece("linear", c, range));
  add(piece("even_power", c, range, 2.0));
  add(piece("power", c, range, 2.0));
  add(piece("power", c, range, 3.0));
  for (const double s : {0.3, 0.6}) add(piece("dead_band", c, s * range));
  add_bumps(data, c, list);
  add_waves(data, c, list);
  for (const double width : {0.05, 0.2}) {
    add(remembering(piece("linear", c, range), Memory::kPlay, width * range));
  }
  for (const double width : {0.03, 0.1, 0.3}) {
    list.push_back({remembering(piece("linear", c, 1.0), Memory::kDahl, width * range)});
  }
  for (const double tau : {0.1, 0.3, 1.0, 3.0}) {
    add(remembering(piece("linear", c, range), Memory::kLag, tau));
    list.push_back({remembering(piece("linear", c, range), Memory::kHighPass, 3.0 * tau)});
  }
}

void add_load(const Data& data, std::size_t c, std::vector<Atom>& list) {
  const double range = data.half_range(c), rms = data.rms(c);
  const auto add = [&](const Piece& p) { list.push_back({p}); };
  add(piece("linear", c, rms));
  for (const double p : {2.0, 3.0}) add(piece("power", c, rms, p));
  for (const double p : {1.0, 2.0}) add(piece("even_power", c, rms, p));
  for (const double s : {0.1, 0.5}) add(piece("tanh", c, s * rms));
  for (const double s : {0.3, 0.6}) add(piece("dead_band", c, s * rms));
  for (const double s : {1.0, -1.0}) add(piece("one_sided", c, s * rms, 1.0));
  for (const double tau : {0.1, 0.3, 1.0, 3.0, 10.0}) {
    add(remembering(piece("linear", c, rms), Memory::kLag, tau));
  }
  add(remembering(piece("linear", c, rms), Memory::kPlay, 0.1 * range));
  add_swings(data, c, list);
}

void add_signal(const Data& data, std::size_t c, std::vector<Atom>& list) {
  const double rms = data.rms(c), range = data.half_range(c), middle = data.middle(c);
  list.push_back({piece("linear", c, rms)});
  for (const double p : {0.5, 1.5, 2.0, 3.0}) list.push_back({piece("power", c, rms, p)});
  for (const double p : {1.0, 2.0}) list.push_back({piece("even_power", c, rms, p)});
  for (const double s : {0.1, 0.4}) list.push_back({centred(piece("tanh", c, s * range), middle)});
  for (const double s : {1.0, -1.0}) list.push_back({piece("exponential", c, s * range)});
  for (const double tau : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0}) {
    list.push_back({remembering(piece("linear", c, rms), Memory::kLag, tau)});
    list.push_back({remembering(piece("linear", c, rms), Memory::kHighPass, tau)});
  }
  list.push_back({remembering(piece("linear", c, rms), Memory::kPlay, 0.1 * range)});
}

void add_products(const Data& data, std::vector<Atom>& list) {
  const std::size_t count = law::coordinates().size();
  for (std::size_t a = 0; a < count; ++a) {
    const bool rate = kind_of(a) == Kind::kRate && law::coordinates()[a].is_rate;
    for (std::size_t b = 0; b < count; ++b) {
      if (a == b || !data.varies(a) || !data.varies(b)) continue;
      if (law::is_own(a) || law::is_own(b)) continue;
      if (kind_of(a) == Kind::kClock || kind_of(b) == Kind::kClock) continue;
      if (b > a) list.push_back({linear_in(data, a), linear_in(data, b)});
      if (rate && kind_of(b) != Kind::kRate) {
        list.push_back({piece("tanh", a, 0.1 * data.rms(a)), linear_in(data, b)});
      }
    }
  }
}

/// Of the motion's rates, places and loads, one place at least: what shows only where all three
/// differ from their means is not found factor by factor.
void add_triples(const Data& data, std::vector<Atom>& list) {
  std::vector<std::size_t> told;
  for (const char* first :
       {"v_base_x", "v_sensor_x", "w_sensor_x", "a_base_x", "f_sensor_x", "x", "alpha"}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t c = coordinate_named(first) + k;
      if (data.varies(c)) told.push_back(c);
    }
  }
  for (std::size_t i = 0; i < told.size(); ++i) {
    for (std::size_t j = i + 1; j < told.size(); ++j) {
      for (std::size_t k = j + 1; k < told.size(); ++k) {
        if (kind_of(told[k]) != Kind::kPlace) continue;  // places are last
        list.push_back(
            {linear_in(data, told[i]), linear_in(data, told[j]), linear_in(data, told[k])});
      }
    }
  }
}

}  // namespace

Kind kind_of(std::size_t coordinate) {
  const law::Coordinate& q = law::coordinates()[coordinate];
  if (q.is_clock) return Kind::kClock;
  if (law::is_signal(coordinate)) return Kind::kSignal;
  const std::string unit = q.unit;
  if (q.frame.empty() || q.name == "load_across") return Kind::kSize;
  if (unit == "m" || unit == "rad") return Kind::kPlace;
  return unit == "N" ? Kind::kLoad : Kind::kRate;
}

Piece piece(const char* shape, std::size_t coordinate, double scale, double extra) {
  Piece p;
  p.factor.shape = shape_named(shape);
  p.factor.coordinate = coordinate;
  p.scale = scale;
  p.extra = extra;
  return p;
}

Piece centred(Piece piece, double centre) {
  piece.factor.centred = true;
  piece.centre = centre;
  return piece;
}

Piece remembering(Piece piece, Memory memory, double size) {
  piece.factor.memory = memory;
  piece.memory = size;
  return piece;
}

Piece swinging(Piece piece, double hz) {
  piece.factor.memory = Memory::kSecondOrder;
  piece.memory = hz;
  piece.second = 0.2;
  return piece;
}

Piece lagging(Piece piece, double seconds, double spread) {
  piece = remembering(piece, Memory::kLags, seconds);
  piece.second = spread;
  return piece;
}

Piece thixotropic(Piece piece, double length, double seconds) {
  piece = remembering(piece, Memory::kThixotropic, length);
  piece.second = seconds;
  return piece;
}

Piece linear_in(const Data& data, std::size_t c) {
  if (kind_of(c) != Kind::kPlace) return piece("linear", c, data.rms(c));
  return centred(piece("linear", c, data.half_range(c)), data.middle(c));
}

std::vector<Atom> dictionary(const Data& data) {
  std::vector<Atom> list{{}};
  for (std::size_t c = 0; c < law::coordinates().size(); ++c) {
    if (!data.varies(c) || law::is_own(c)) continue;
    switch (kind_of(c)) {
      case Kind::kRate:
        add_rate(data, c, list);
        break;
      case Kind::kSize:
        add_size(data, c, list);
        break;
      case Kind::kPlace:
        add_place(data, c, list);
        break;
      case Kind::kLoad:
        add_load(data, c, list);
        break;
      case Kind::kSignal:
        add_signal(data, c, list);
        break;
      default:
        break;
    }
  }
  add_products(data, list);
  add_triples(data, list);
  return list;
}

std::vector<Sketch> direction_sketches(const Data& data) {
  std::vector<Sketch> list;
  for (std::size_t d = 0; d < law::directions().size(); ++d) {
    if (!data.has_direction(d) || law::is_central(d)) continue;
    Sketch sketch;
    sketch.direction = d;
    sketch.vector_scale = data.size_of(d);
    list.push_back(sketch);
    const std::string name = law::directions()[d].name;
    if (name != "load" && name != "velocity") continue;
    for (const double tau : {0.1, 0.3, 1.0, 3.0, 10.0}) {
      sketch.vector_lag = tau;
      list.push_back(sketch);
    }
  }
  return list;
}

}  // namespace dcnn::discovery
