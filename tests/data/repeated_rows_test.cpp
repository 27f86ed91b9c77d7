// SPDX-License-Identifier: Apache-2.0
#include "data/repeated_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

/// Three forces of noise 1 about a slow wave, rounded to `step`, 5000 rows of 2 ms; at rest without
/// noise for the last `still` rows.
Recording three_forces(double step, Index still = 0) {
  Rng rng({9});
  Recording recording;
  recording.table.columns = {"t", "fx", "fy", "fz"};
  recording.table.values.resize(5000, 4);
  for (Index i = 0; i < 5000; ++i) {
    recording.table.values(i, 0) = 0.002 * static_cast<double>(i);
    for (Index j = 1; j < 4; ++j) {
      const double noise = i < 5000 - still ? rng.normal() : 0.0;
      recording.table.values(i, j) = step * std::round((noise + std::sin(0.01 * i)) / step);
      if (i >= 5000 - still) recording.table.values(i, j) = 1.0;
    }
  }
  recording.dt = 0.002;
  recording.segments = {{0, 5000}};
  return recording;
}

void repeat(Recording& recording, Index row, Index times) {
  for (Index k = 1; k <= times; ++k) {
    recording.table.values.row(row + k).tail(3) = recording.table.values.row(row).tail(3);
  }
}

const std::vector<std::string> kForces{"fx", "fy", "fz"};

TEST(RepeatedRows, OfAllChannelsAtOnceCountAsLost) {
  for (const double step : {1e-9, 0.1, 0.5}) {
    Recording recording = three_forces(step);
    for (Index row = 100; row < 4900; row += 100) repeat(recording, row, 1 + row / 100 % 4);
    leave_out_repeats(recording, kForces);
    EXPECT_NEAR(static_cast<double>(recording.samples()), 5000.0 - 48.0 * 2.5, step < 0.5 ? 2 : 40);
    if (step < 0.5) {
      EXPECT_EQ(recording.segments.size(), 1u) << "lost rows are bridged";
    }
    EXPECT_EQ(recording.notes.size(), 1u);
  }
}

TEST(RepeatedRows, ByChanceAndAtRestStay) {
  for (const double step : {1e-9, 0.5, 2.0, 10.0}) {
    for (const Index still : {0, 1000}) {
      Recording recording = three_forces(step, still);
      leave_out_repeats(recording, kForces);
      EXPECT_EQ(recording.samples(), 5000) << step << " " << still;
      EXPECT_TRUE(recording.notes.empty());
    }
  }
}

TEST(RepeatedRows, ASensorThatStopsLeavesAGap) {
  Recording recording = three_forces(1e-9);
  repeat(recording, 2000, 10);
  leave_out_repeats(recording, kForces);
  EXPECT_EQ(recording.samples(), 4990);
  ASSERT_EQ(recording.segments.size(), 2u);
  EXPECT_EQ(recording.segments[0].end, 2001);
}

}  // namespace
}  // namespace dcnn
