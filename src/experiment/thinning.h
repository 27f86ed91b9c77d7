// SPDX-License-Identifier: Apache-2.0
// Which points of a long line are drawn.
#pragma once

#include <vector>

#include "dcnn/experiment/report.h"

namespace dcnn {

/// Indices of points a chart can show: finite, and positive where `positive`.
std::vector<std::size_t> drawable_points(const Series& series, bool positive);

/// At most two of `points` per column, the lowest and the highest, in their order. Columns are
/// equal parts of x where x never decreases, else of the order of points.
std::vector<std::size_t> thinned(const Series& series, const std::vector<std::size_t>& points,
                                 int columns);

}  // namespace dcnn
