// SPDX-License-Identifier: Apache-2.0
#include "experiment/thinning.h"

#include <algorithm>
#include <cmath>

namespace dcnn {
namespace {

constexpr double kLargest = 1e300;    // beyond, differences of two values are infinite
constexpr double kSmallest = 1e-290;  // below, the decade's power of ten is no normal number

/// The column of every point.
std::vector<double> columns_of(const Series& series, const std::vector<std::size_t>& points,
                               int columns) {
  const auto x = [&](std::size_t k) { return series.x[points[k]]; };
  const double first = x(0), range = x(points.size() - 1) - first;
  bool ordered = range > 0;
  for (std::size_t k = 1; k < points.size(); ++k) ordered = ordered && x(k) >= x(k - 1);
  std::vector<double> column(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double part = ordered ? (x(k) - first) / range
                                : static_cast<double>(k) / static_cast<double>(points.size());
    column[k] = std::min(std::floor(part * columns), columns - 1.0);
  }
  return column;
}

}  // namespace

std::vector<std::size_t> drawable_points(const Series& series, bool positive) {
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    const bool shown = std::abs(series.x[i]) < kLargest && std::abs(series.y[i]) < kLargest;
    if (shown && (!positive || series.y[i] > kSmallest)) points.push_back(i);
  }
  return points;
}

std::vector<std::size_t> thinned(const Series& series, const std::vector<std::size_t>& points,
                                 int columns) {
  if (points.size() <= 2 * static_cast<std::size_t>(columns)) return points;
  const auto column = columns_of(series, points, columns);
  const auto below = [&](std::size_t a, std::size_t b) { return series.y[a] < series.y[b]; };
  std::vector<std::size_t> kept;
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    while (end < points.size() && column[end] == column[begin]) ++end;
    const auto [low, high] =
        std::minmax_element(points.begin() + static_cast<std::ptrdiff_t>(begin),
                            points.begin() + static_cast<std::ptrdiff_t>(end), below);
    kept.push_back(std::min(*low, *high));
    if (*low != *high) kept.push_back(std::max(*low, *high));
  }
  return kept;
}

}  // namespace dcnn
