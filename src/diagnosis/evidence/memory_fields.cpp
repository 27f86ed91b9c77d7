// SPDX-License-Identifier: Apache-2.0
// Fields of where the motion came from, and of the clock.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "diagnosis/evidence/field_builder.h"

namespace dcnn::evidence {
namespace {

constexpr double kPasts[] = {0.1, 0.3, 1.0, 3.0, 10.0, 30.0};  // s, of a force
constexpr double kRatePasts[] = {0.1, 0.5, 2.0};               // s, of a rate
constexpr double kReaches[] = {0.02, 0.1, 0.4};                // of bristles, over the rms rate: s
constexpr int kWaves = 24;                                     // of the clock

/// Behind a low-pass with time constant tau, at rest before the first sample.
Series lagged(const Series& series, double dt, double tau) {
  const double keep = elementary::exp(-dt / tau);
  return mapped(series, [=](const Vector& x) {
    Vector y(x.size());
    double state = x.size() > 0 ? x(0) : 0.0;
    for (Index i = 0; i < y.size(); ++i) y(i) = state = keep * state + (1.0 - keep) * x(i);
    return y;
  });
}

/// Deflection z of bristles, dz = dq - |dq| z/reach (Dahl 1968), over the reach.
Series dragged(const Series& rate, double dt, double reach) {
  return mapped(rate, [=](const Vector& v) {
    Vector z = Vector::Zero(v.size());
    for (Index i = 1; i < z.size(); ++i) {
      const double step = v(i) * dt, end = std::copysign(1.0, step);
      z(i) = end + (z(i - 1) - end) * elementary::exp(-std::abs(step) / reach);
    }
    return z;
  });
}

/// First or second difference within segments, zero at their ends.
Series difference_of(const FieldBuilder& builder, const Series& force, int order) {
  return builder.of_logs([&](const Motion& m, std::size_t k) {
    const Vector& f = force[k];
    Vector d = Vector::Zero(f.size());
    for (const Segment& s : m.segments) {
      for (Index i = s.begin + 1; i + 1 < s.end; ++i) {
        d(i) = order == 1 ? f(i + 1) - f(i - 1) : f(i + 1) - 2.0 * f(i) + f(i - 1);
      }
    }
    return d;
  });
}

/// What lags, leads, resonances and slow relaxations look like.
void add_past_forces(FieldBuilder& builder) {
  for (Index j = 0; j < builder.study().channel_count(); ++j) {
    const Series force = builder.force_of(j);
    const std::string name = "predicted " + builder.study().targets[static_cast<std::size_t>(j)];
    builder.add_all("change of the " + name, "memory", {difference_of(builder, force, 1)}, false);
    builder.add_all("second derivative of the " + name, "memory",
                    {difference_of(builder, force, 2)}, false);
    std::vector<Series> pasts;
    for (const double tau : kPasts) pasts.push_back(lagged(force, builder.study().dt(), tau));
    builder.add_all("past of the " + name, "memory", pasts, false);
  }
}

void add_past_rates(FieldBuilder& builder) {
  const double dt = builder.study().dt();
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [frame, words] : rate_words()) {
      if (frame != 'w' && !builder.moves()) continue;
      const Series rate = builder.rate_of(frame, axis);
      const double size = rms(rate);
      if (size == 0.0) continue;
      std::vector<Series> states;
      for (const double seconds : kReaches) states.push_back(dragged(rate, dt, seconds * size));
      for (const double tau : kRatePasts) {
        states.push_back(
            mapped(lagged(rate, dt, tau), [=](const Vector& v) -> Vector { return v / size; }));
      }
      builder.add_all("past " + words + kLetters[axis], "memory", states, frame == 'b');
    }
  }
}

/// Cosines over the clock whose size falls as those of a random walk.
void add_clock(FieldBuilder& builder) {
  double begin = 1e300, end = -1e300;
  for (const Log& log : builder.study().logs) {
    begin = std::min(begin, log.motion.t(0));
    end = std::max(end, log.motion.t(log.motion.samples() - 1));
  }
  std::vector<Series> waves;
  for (int wave = 1; wave <= kWaves; ++wave) {
    waves.push_back(builder.of_logs([&](const Motion& m, std::size_t) -> Vector {
      const double turns = wave * std::numbers::pi / (end - begin);
      return elementary::cos(turns * (m.t.array() - begin)) / static_cast<double>(wave);
    }));
  }
  builder.add_all("time", "clock", waves, false);
}

}  // namespace

void add_memory_fields(FieldBuilder& builder) {
  if (!builder.study().is_static()) {
    add_past_forces(builder);
    add_past_rates(builder);
  }
  if (builder.study().has_clock()) add_clock(builder);
}

}  // namespace dcnn::evidence
