// SPDX-License-Identifier: Apache-2.0
#include "data/repeated_rows.h"

#include <algorithm>
#include <cmath>

#include "data/kept_rows.h"

namespace dcnn {
namespace {

constexpr Index kStretch = 64;         // rows over which the shares are those of one motion
constexpr double kByChance = 0.2;      // of the repeats at most
constexpr double kBeyondChance = 5.0;  // of a Poisson count
constexpr double kMostLeftOut = 0.5;   // of the rows

/// Repeats of a stretch: of each channel, and of all at once.
struct Repeats {
  Eigen::ArrayXd of_channel;
  std::vector<Index> of_all;
};
Repeats repeats_of(const Eigen::MatrixXd& values, Index begin, Index end) {
  Repeats repeats{Eigen::ArrayXd::Zero(values.cols()), {}};
  for (Index i = begin; i < end; ++i) {
    const Eigen::ArrayXd same =
        (values.row(i).array() == values.row(i - 1).array()).cast<double>().transpose();
    repeats.of_channel += same;
    if (same.minCoeff() > 0.0) repeats.of_all.push_back(i);
  }
  return repeats;
}

}  // namespace

void leave_out_repeats(Recording& recording, const std::vector<std::string>& columns) {
  if (recording.dt <= 0.0 || columns.size() < 2) return;
  const Eigen::MatrixXd values = recording.block(columns);
  std::vector<bool> kept(static_cast<std::size_t>(values.rows()), true);
  double expected = 0.0, seen = 0.0;
  for (const Segment& segment : recording.segments) {
    for (Index begin = segment.begin + 1; begin < segment.end; begin += kStretch) {
      const Index end = std::min(segment.end, begin + kStretch);
      const Repeats repeats = repeats_of(values, begin, end);
      const auto rows = static_cast<double>(end - begin);
      expected += rows * (repeats.of_channel / rows).prod();
      seen += static_cast<double>(repeats.of_all.size());
      for (const Index row : repeats.of_all) kept[static_cast<std::size_t>(row)] = false;
    }
  }
  const bool few = seen < kMostLeftOut * static_cast<double>(values.rows());
  if (expected > kByChance * seen || seen < expected + kBeyondChance * std::sqrt(expected + 1.0) ||
      !few) {
    return;
  }
  lose_rows(recording, kept);
  recording.notes.push_back(std::to_string(static_cast<Index>(seen)) + " rows repeat " +
                            columns.front() +
                            " and its companions of the row before: they count as lost");
}

}  // namespace dcnn
