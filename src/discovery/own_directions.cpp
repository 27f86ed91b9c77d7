// SPDX-License-Identifier: Apache-2.0
#include "discovery/own_directions.h"

#include <string>

namespace dcnn::discovery {
namespace {

using law::Memory;
using law::Vector3d;

constexpr int kPointsAcross = 5;      // of the grid of points, each way
constexpr double kReach = 1.5;        // of it, in half ranges of the positions
constexpr double kLeastRange = 1e-3;  // m

bool in_base(std::size_t direction) {
  return std::string(law::directions()[direction].name).starts_with("base_");
}

/// A coordinate along an oblique axis, and the first of those along the axes of both frames.
struct Along {
  const char *own, *sensor, *base;
};
constexpr Along kAlong[] = {{"v_along", "v_sensor_x", "v_base_x"},
                            {"w_along", "w_sensor_x", "w_base_x"},
                            {"p_along", nullptr, "x"},
                            {"f_along", "f_sensor_x", "f_base_x"}};

/// Of an axis of the sketch's frame: the coordinate along it, if there is one.
std::optional<std::size_t> plain_of(const Along& along, std::size_t direction) {
  const char* const first = in_base(direction) ? along.base : along.sensor;
  if (first == nullptr) return std::nullopt;
  return coordinate_named(first) + direction % 3;
}

/// One of every direction and its opposite.
std::vector<Vector3d> axes() {
  std::vector<Vector3d> list;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const bool first = x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0)));
        if (first && x * x + y * y + z * z > 1) list.emplace_back(Vector3d(x, y, z).normalized());
      }
    }
  }
  return list;
}

void add_points(const Data& data, std::vector<Sketch>& list) {
  const std::size_t x = coordinate_named("x");
  Sketch sketch;
  sketch.direction = direction_named("from_point");
  constexpr int kPoints = kPointsAcross * kPointsAcross * kPointsAcross;
  for (int k = 0; k < kPoints; ++k) {
    const int place[] = {k % kPointsAcross, k / kPointsAcross % kPointsAcross,
                         k / (kPointsAcross * kPointsAcross)};
    for (std::size_t i = 0; i < 3; ++i) {
      const double along = 2.0 * place[i] / (kPointsAcross - 1) - 1.0;
      const double range = std::max(data.half_range(x + i), kLeastRange);
      sketch.own[i] = data.middle(x + i) + kReach * range * along;
    }
    list.push_back(sketch);
  }
}

std::vector<Atom> atoms_of_distance(const Data& data, const Sketch& point) {
  const std::size_t r = coordinate_named("distance");
  const double size = data.rms(r);
  std::vector<Atom> list{{piece("linear", r, size)}};
  for (const double p : {1.0, 2.0, 4.0}) list.push_back({piece("inverse_power", r, size, p)});
  for (const double width : {0.3, 0.8}) list.push_back({piece("gaussian", r, width * size)});
  list.push_back({piece("exponential", r, 0.5 * size)});
  const Eigen::VectorXd distance = data.product({piece("linear", r, 1.0)}, point);
  const double low = distance.minCoeff(), range = std::max(distance.maxCoeff() - low, kLeastRange);
  for (const double slack : {0.25, 0.5, 0.75}) {  // what is taut beyond a length
    list.push_back({centred(piece("one_sided", r, range, 1.0), low + slack * range)});
  }
  list.push_back({remembering(piece("linear", r, 1.0), Memory::kDahl, 0.1 * range)});
  return list;
}

void add_place_along(const Data& data, const Sketch& axis, std::vector<Atom>& list) {
  const std::size_t c = coordinate_named("p_along");
  const Eigen::VectorXd place = data.product({piece("linear", c, 1.0)}, axis);
  const double low = place.minCoeff(), high = place.maxCoeff();
  const double middle = 0.5 * (low + high), range = std::max(0.5 * (high - low), kLeastRange);
  list.push_back({centred(piece("linear", c, range), middle)});
  list.push_back({centred(piece("power", c, range, 3.0), middle)});
  list.push_back({centred(piece("dead_band", c, 0.5 * range), middle)});
  list.push_back({remembering(piece("linear", c, range), Memory::kPlay, 0.1 * range)});
  for (const double width : {0.03, 0.2}) {
    list.push_back({remembering(piece("linear", c, 1.0), Memory::kDahl, width * range)});
  }
}

void add_motion_along(const Data& data, const char* coordinate, std::vector<Atom>& list) {
  const std::size_t c = coordinate_named(coordinate);
  const double rms = data.rms(c);
  if (!(rms > 0.0)) return;
  list.push_back({piece("linear", c, rms)});
  for (const double p : {0.5, 2.0}) list.push_back({piece("power", c, rms, p)});
  for (const double s : {0.05, 0.2, 0.6}) list.push_back({piece("tanh", c, s * rms)});
  list.push_back({piece("peaked", c, 0.4 * rms)});
}

}  // namespace

std::vector<Sketch> own_directions(const Data& data) {
  std::vector<Sketch> list;
  if (data.of_axis()) return list;
  for (const char* frame : {"sensor_x", "base_x"}) {
    Sketch sketch;
    sketch.direction = direction_named(frame);
    for (const Vector3d& e : axes()) list.push_back(with_axis(sketch, e));
  }
  // Gravity behind a lag: liquid, a hose, a polymer.
  for (const char* axis : {"base_x", "base_y", "base_z"}) {
    for (const double tau : {0.1, 0.3, 1.0, 3.0, 10.0}) {
      Sketch sketch;
      sketch.direction = direction_named(axis);
      sketch.vector_lag = tau;
      list.push_back(sketch);
    }
  }
  if (!data.varies(coordinate_named("distance"))) return list;
  add_points(data, list);
  for (const double share : {0.005, 0.03, 0.2, 1.0}) {  // a contact that gives way
    Sketch sketch;
    sketch.direction = direction_named("along_velocity");
    sketch.vector_length = share * data.diagonal();
    list.push_back(sketch);
  }
  return list;
}

std::vector<Atom> own_atoms(const Data& data, const Sketch& direction) {
  if (law::is_central(direction.direction)) return atoms_of_distance(data, direction);
  if (direction.vector_lag > 0.0 || direction.vector_length > 0.0) return {{}};
  std::vector<Atom> list;
  for (const char* motion : {"v_along", "w_along"}) add_motion_along(data, motion, list);
  const std::size_t f = coordinate_named("f_along");
  if (data.varies(f)) list.push_back({piece("linear", f, data.rms(f))});
  if (in_base(direction.direction) && data.varies(coordinate_named("p_along"))) {
    add_place_along(data, direction, list);
  }
  return list;
}

std::vector<Sketch> made_oblique(const Sketch& from) {
  if (from.oblique || !law::has_axis(from.direction)) return {};
  Sketch sketch = from;
  sketch.oblique = true;
  sketch.own = {};
  if (!law::is_axis(from.direction)) return {sketch};
  for (Piece& part : sketch.pieces) {
    for (const Along& along : kAlong) {
      const auto plain = plain_of(along, from.direction);
      if (plain == part.factor.coordinate) part.factor.coordinate = coordinate_named(along.own);
    }
  }
  return {sketch};
}

std::vector<Sketch> made_along(const Sketch& from) {
  std::vector<Sketch> list;
  if (!from.oblique || !law::is_axis(from.direction)) return list;
  for (std::size_t k = 0; k < from.pieces.size(); ++k) {
    for (const Along& along : kAlong) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = from.direction - from.direction % 3;
        if (plain_of(along, first + axis) != from.pieces[k].factor.coordinate) continue;
        list.push_back(from);
        list.back().pieces[k].factor.coordinate = coordinate_named(along.own);
      }
    }
  }
  return list;
}

std::vector<Sketch> made_plain(const Sketch& from) {
  if (!from.oblique) return {};
  Sketch sketch = from;
  sketch.oblique = false;
  sketch.own = {};
  for (Piece& part : sketch.pieces) {
    for (const Along& along : kAlong) {
      if (part.factor.coordinate != coordinate_named(along.own)) continue;
      const auto plain = plain_of(along, from.direction);
      if (!plain) return {};
      part.factor.coordinate = *plain;
    }
  }
  return {sketch};
}

}  // namespace dcnn::discovery
