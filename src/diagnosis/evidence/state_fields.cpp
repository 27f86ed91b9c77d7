// SPDX-License-Identifier: Apache-2.0
// Fields of the state of motion: rates, forces, poses and products of them.
#include <algorithm>
#include <numbers>

#include "core/elementary.h"
#include "diagnosis/evidence/field_builder.h"

namespace dcnn::evidence {
namespace {

constexpr double kSteps[] = {0.1, 0.4};  // widths of a rate's sign, in units of its rms

/// A factor, its name, and functions of it.
struct Factor {
  std::string words;
  std::vector<Series> functions;
};

Series step_of(const Series& rate, double width, double size) {
  return mapped(rate,
                [=](const Vector& v) -> Vector { return elementary::tanh(v / (width * size)); });
}

Series scaled(const Series& series, double size) {
  return mapped(series, [=](const Vector& v) -> Vector { return v / size; });
}

/// Calls f(words, rate, rms, axis, base) for every rate of the motion.
template <class F>
void for_each_rate(const FieldBuilder& builder, const F& f) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [frame, words] : rate_words()) {
      if (builder.study().is_static() || (frame != 'w' && !builder.moves())) continue;
      const Series rate = builder.rate_of(frame, axis);
      const double size = rms(rate);
      if (size > 0.0) f(words + kLetters[axis], rate, size, axis, frame == 'b');
    }
  }
}

void add_rates(FieldBuilder& builder) {
  for_each_rate(builder, [&](const std::string& words, const Series& rate, double, int, bool base) {
    builder.add_shapes(words, rate, base);
  });
  if (builder.study().is_static()) return;
  for (int axis = 0; axis < 3; ++axis) {
    builder.add_shapes(
        "angular acceleration about sensor " + std::string(kLetters[axis]),
        builder.of_logs([&](const Motion& m, std::size_t) { return m.dw_S.col(axis).array(); }),
        false);
    if (!builder.moves()) continue;
    builder.add_shapes(
        "acceleration along base " + std::string(kLetters[axis]),
        builder.of_logs([&](const Motion& m, std::size_t) { return m.a_B.col(axis).array(); }),
        true);
  }
  if (!builder.moves()) return;
  builder.add_shapes("speed", builder.of_logs([](const Motion& m, std::size_t) {
    return m.v_B.rowwise().norm().array();
  }),
                     false);
}

void add_forces(FieldBuilder& builder) {
  for (Index j = 0; j < builder.study().channel_count(); ++j) {
    builder.add_shapes("predicted " + builder.study().targets[static_cast<std::size_t>(j)],
                       builder.force_of(j), false);
  }
}

/// A factor times a rate, its sign, or a force, along the axis of the latter.
void add_products(FieldBuilder& builder, const Factor& factor) {
  for_each_rate(
      builder, [&](const std::string& words, const Series& rate, double size, int axis, bool base) {
        std::vector<Series> all;
        for (const Series& f : factor.functions) {
          for (const double width : kSteps) all.push_back(product(f, step_of(rate, width, size)));
          all.push_back(product(f, scaled(rate, size)));
        }
        builder.add(factor.words + " times " + words, "state", all, axis, base);
      });
  for (Index j = 0; j < builder.study().channel_count(); ++j) {
    const Series force = builder.force_of(j);
    const double size = rms(force);
    if (size == 0.0) continue;
    std::vector<Series> all;
    for (const Series& f : factor.functions) all.push_back(product(f, scaled(force, size)));
    builder.add(factor.words + " times the predicted " +
                    builder.study().targets[static_cast<std::size_t>(j)],
                "state", all, builder.study().channels[static_cast<std::size_t>(j)], false);
  }
}

/// Harmonics of an angle, of order up to 8.
std::vector<Series> harmonics(const Series& angle) {
  std::vector<Series> list;
  for (const double order : {1.0, 2.0, 4.0, 8.0}) {
    list.push_back(mapped(
        angle, [=](const Vector& q) -> Vector { return elementary::sin(order * q) / order; }));
    list.push_back(mapped(
        angle, [=](const Vector& q) -> Vector { return elementary::cos(order * q) / order; }));
  }
  return list;
}

/// Cosines over the range of a position, -1 to 1, smaller the faster they are.
std::vector<Series> waves(const Series& place) {
  std::vector<Series> list;
  for (int k = 1; k <= 6; ++k) {
    list.push_back(mapped(place, [=](const Vector& q) -> Vector {
      return elementary::cos(0.5 * k * std::numbers::pi * (q + 1.0)) / static_cast<double>(k);
    }));
  }
  return list;
}

void add_angles(FieldBuilder& builder) {
  constexpr const char* kNames[3] = {"angle alpha", "angle beta", "angle gamma"};
  for (Index a = 0; a < 3; ++a) {
    const auto list = harmonics(
        builder.of_logs([&](const Motion& m, std::size_t) { return m.euler.col(a).array(); }));
    for (const bool base : {false, true}) builder.add_all(kNames[a], "state", list, base);
    add_products(builder, {kNames[a], list});
  }
}

void add_places(FieldBuilder& builder) {
  for (const char* letter : kLetters) {
    const auto& logs = builder.study().logs;
    if (!logs.front().recording.has(letter)) continue;
    Series place = builder.of_logs([&](const Motion&, std::size_t k) -> Vector {
      return logs[k].recording.column(letter).array();
    });
    double low = 1e300, high = -1e300;
    for (const Vector& q : place) {
      low = std::min(low, q.minCoeff());
      high = std::max(high, q.maxCoeff());
    }
    if (!(high > low)) continue;
    place = mapped(
        place, [=](const Vector& q) -> Vector { return (2.0 * q - high - low) / (high - low); });
    const std::string words = "position " + std::string(letter);
    for (const bool base : {false, true}) builder.add_all(words, "state", waves(place), base);
    const Series square = mapped(place, [](const Vector& q) -> Vector { return q.square(); });
    add_products(builder, {words, {place, square}});
  }
}

/// Forces and their sizes: friction that grows with a load.
void add_loads(FieldBuilder& builder) {
  Factor load{"force", {}};
  for (Index j = 0; j < builder.study().channel_count(); ++j) {
    const Series force = builder.force_of(j);
    const double size = rms(force);
    if (size == 0.0) continue;
    load.functions.push_back(scaled(force, size));
    load.functions.push_back(
        mapped(force, [=](const Vector& f) -> Vector { return (f / size).abs(); }));
  }
  for_each_rate(
      builder, [&](const std::string& words, const Series& rate, double size, int axis, bool base) {
        std::vector<Series> all;
        for (const Series& f : load.functions) {
          for (const double width : kSteps) all.push_back(product(f, step_of(rate, width, size)));
        }
        builder.add("force times " + words, "state", all, axis, base);
      });
}

}  // namespace

void add_state_fields(FieldBuilder& builder) {
  add_rates(builder);
  add_forces(builder);
  add_angles(builder);
  add_places(builder);
  add_loads(builder);
}

}  // namespace dcnn::evidence
