// SPDX-License-Identifier: Apache-2.0
// Which taps of a window lie inside the image.
#pragma once

#include <algorithm>
#include <vector>

#include "nn/kernels/convolution.h"
#include "nn/kernels/tile.h"

namespace dcnn {

/// Taps [begin, end) of a window that lie inside the input when it produces output `at`.
struct Taps {
  Index begin, end;
  bool operator==(const Taps&) const = default;
};

inline Taps taps_inside(Index at, Index before, Index window, Index in) {
  return {std::max<Index>(0, before - at), std::min(window, in + before - at)};
}

inline Taps row_taps(const ConvShape& s, Index row) {
  return taps_inside(row, s.before_h, s.window_h, s.in_h);
}
inline Taps column_taps(const ConvShape& s, Index column) {
  return taps_inside(column, s.before_w, s.window_w, s.in_w);
}

/// The products of one output position: a run per window row, as taps and channels lie side by
/// side.
inline void position_runs(const ConvShape& s, Index row, Index column, std::vector<Run>& runs) {
  const Taps rows = row_taps(s, row), columns = column_taps(s, column);
  runs.clear();
  for (Index tap = rows.begin; tap < rows.end; ++tap) {
    const Index in_row = row - s.before_h + tap;
    const Index in_column = column - s.before_w + columns.begin;
    runs.push_back({(in_row * s.in_w + in_column) * s.in_c,
                    (tap * s.window_w + columns.begin) * s.in_c * s.out_c,
                    (columns.end - columns.begin) * s.in_c});
  }
}

}  // namespace dcnn
