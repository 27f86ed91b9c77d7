// SPDX-License-Identifier: Apache-2.0
#include "design/proposals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace dcnn::design {
namespace {

constexpr Index kEnds = 5;           // points at either end that are the start
constexpr Index kFewestPoints = 11;  // one of them is free
constexpr double kShortest = 0.05;   // s between points: a robot's path follows no faster

/// The range in which a coordinate moves; that of an unlimited one is nothing.
Range range_of(const Limits& limits, Index k) {
  const auto i = static_cast<std::size_t>(k);
  return limits.joints ? limits.joints->range[i] : limits.pose.range[i];
}

/// Seconds that a stroke of `size` takes under limits of speed, acceleration and jerk, as a sine of
/// that amplitude: speed s/T·pi, acceleration 2 s (pi/T)², jerk 4 s (pi/T)³ for a half period T.
double stroke_seconds(double size, double speed, double acceleration, double jerk) {
  const double pi = std::numbers::pi, half = 0.5 * size;
  return pi * std::max({half / speed, std::sqrt(half / acceleration),
                        elementary::pow(half / jerk, 1.0 / 3.0)});
}

/// Seconds for the whole range of a coordinate.
double natural_seconds(const Limits& limits, Index k) {
  const Range range = range_of(limits, k);
  const double size = range.high - range.low;
  if (limits.joints) {
    return stroke_seconds(size, limits.joints->speed(k), limits.joints->acceleration(k),
                          limits.joints->jerk(k));
  }
  const PoseLimits& pose = limits.pose;
  return k < 3 ? stroke_seconds(size, pose.speed, pose.acceleration, pose.jerk)
               : stroke_seconds(size, pose.rate, pose.angular_acceleration, pose.angular_jerk);
}

/// Values for points first … first + count - 1 of a coordinate.
void draw_piece(Spline& spline, Index k, Index first, Index count, const Limits& limits, Rng& rng) {
  const Range range = range_of(limits, k);
  const double middle = 0.5 * (range.low + range.high), half = 0.5 * (range.high - range.low);
  // Points that lie this far apart use the limits: closer ones take part of the range.
  const double natural = std::max(spline.spacing, natural_seconds(limits, k));
  const auto stroke = [&] {  // points of a half period: the fastest possible to ten times as slow
    return std::max(1.0, natural / spline.spacing * elementary::pow(10.0, rng.uniform()));
  };
  const int manner = static_cast<int>(rng.below(4));
  Index i = first;
  double phase = rng.uniform(0.0, 2.0 * std::numbers::pi);
  while (i < first + count) {
    const double length = stroke();
    const Index end = std::min(
        first + count, i + std::max<Index>(1, std::llround(length * rng.uniform(1.0, 4.0))));
    const double target = rng.uniform(range.low, range.high), size = half * rng.uniform(),
                 pace = std::numbers::pi / length;
    for (; i < end; ++i) {
      double& value = spline.points(i, k);
      if (manner == 0) {  // to a target, and rest there
        value = target;
      } else if (manner == 3) {  // at random about the place before
        value = target + 0.3 * half * rng.uniform(-1.0, 1.0);
      } else {  // to and fro, over all of the range or some of it
        value = middle + (manner == 1 ? half : size) * elementary::sin(phase);
        phase += pace;
      }
      value = std::clamp(value, range.low, range.high);
    }
  }
}

void rest_at_ends(Spline& spline, const Limits& limits) {
  spline.points.topRows(kEnds).rowwise() = limits.start.transpose();
  spline.points.bottomRows(kEnds).rowwise() = limits.start.transpose();
}

/// Coordinates that may move.
std::vector<Index> free_coordinates(const Limits& limits) {
  std::vector<Index> list;
  for (Index k = 0; k < limits.start.size(); ++k) {
    const Range range = range_of(limits, k);
    if (range.high > range.low) list.push_back(k);
  }
  return list;
}

}  // namespace

Spline draw_spline(const Limits& limits, double seconds, Rng& rng) {
  const std::vector<Index> movable = free_coordinates(limits);
  double shortest = seconds / 4.0;
  for (const Index k : movable) shortest = std::min(shortest, natural_seconds(limits, k));
  Spline spline;
  // Strokes of a fifth of the range, and up to four times as long.
  const double wanted = std::max(kShortest, 0.3 * shortest * elementary::pow(4.0, rng.uniform()));
  const Index points = std::max(kFewestPoints, static_cast<Index>(seconds / wanted) + kEnds);
  spline.spacing = seconds / static_cast<double>(points - kEnds);
  spline.points = limits.start.transpose().replicate(points, 1);
  for (const Index k : movable) draw_piece(spline, k, 0, points, limits, rng);
  rest_at_ends(spline, limits);
  return spline;
}

Spline changed(const Spline& spline, const Limits& limits, Rng& rng) {
  const std::vector<Index> movable = free_coordinates(limits);
  Spline out = spline;
  if (movable.empty()) return out;
  const Index points = out.points.rows();
  const int coordinates = 1 + static_cast<int>(rng.below(2));
  for (int c = 0; c < coordinates; ++c) {
    const Index k = movable[rng.below(movable.size())];
    if (rng.uniform() < 0.3) {
      const Range range = range_of(limits, k);
      const double factor = elementary::pow(2.0, rng.uniform(-1.0, 1.0));
      for (Index i = 0; i < points; ++i) {
        out.points(i, k) = std::clamp(
            limits.start(k) + factor * (out.points(i, k) - limits.start(k)), range.low, range.high);
      }
      continue;
    }
    const Index count =
        1 +
        static_cast<Index>(rng.below(static_cast<std::uint64_t>(std::max<Index>(1, points / 2))));
    const Index first =
        static_cast<Index>(rng.below(static_cast<std::uint64_t>(points - count + 1)));
    draw_piece(out, k, first, count, limits, rng);
  }
  rest_at_ends(out, limits);
  return out;
}

}  // namespace dcnn::design
