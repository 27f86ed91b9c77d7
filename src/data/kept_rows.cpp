// SPDX-License-Identifier: Apache-2.0
#include "data/kept_rows.h"

#include "data/clock.h"

namespace dcnn {

void keep_rows(Recording& recording, const std::vector<bool>& kept) {
  std::vector<Index> rows;
  std::vector<Segment> segments;
  for (const Segment& segment : recording.segments) {
    const auto begin = static_cast<Index>(rows.size());
    for (Index row = segment.begin; row < segment.end; ++row) {
      if (kept[static_cast<std::size_t>(row)]) rows.push_back(row);
    }
    const auto end = static_cast<Index>(rows.size());
    if (end > begin) segments.push_back({begin, end});
  }
  recording.table.values = Eigen::MatrixXd(recording.table.values(rows, Eigen::all));
  recording.segments = std::move(segments);
}

void lose_rows(Recording& recording, const std::vector<bool>& kept) {
  keep_rows(recording, kept);
  recording.segments = split_at_gaps(recording.column("t"), recording.segments, recording.dt);
  drop_short_stretches(recording);
}

}  // namespace dcnn
