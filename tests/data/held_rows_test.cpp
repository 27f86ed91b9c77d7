// SPDX-License-Identifier: Apache-2.0
#include "data/held_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

/// A force read every `held` rows of 2 ms, noise rounded to `step`, every 250th row lost.
Recording slow_force(Index held, double step) {
  Rng rng({7});
  std::vector<double> times, values;
  double now = 0.0;
  for (Index i = 0; i < 5000; ++i) {
    if (i % held == 0) now = step > 0.0 ? step * std::round(rng.normal() / step) : rng.normal();
    if (i % 250 == 249) continue;
    times.push_back(0.002 * static_cast<double>(i));
    values.push_back(now);
  }
  Recording recording;
  const auto rows = static_cast<Index>(times.size());
  recording.table.columns = {"t", "fx"};
  recording.table.values.resize(rows, 2);
  for (Index i = 0; i < rows; ++i) {
    recording.table.values(i, 0) = times[static_cast<std::size_t>(i)];
    recording.table.values(i, 1) = values[static_cast<std::size_t>(i)];
  }
  recording.dt = 0.002;
  recording.segments = {{0, rows}};
  return recording;
}

TEST(HeldRows, AreCountedOnTheClock) {
  for (const Index held : {1, 2, 3, 8}) {
    EXPECT_EQ(held_rows(slow_force(held, 0.0), {"fx"}), held);
    EXPECT_EQ(held_rows(slow_force(held, 1.0), {"fx"}), held) << "rounded";
  }
}

TEST(HeldRows, AreLeftOut) {
  Recording recording = slow_force(4, 0.0);
  const Recording all = recording;
  keep_new_rows({&recording}, System());
  EXPECT_DOUBLE_EQ(recording.dt, 0.008);
  EXPECT_EQ(recording.notes.size(), 1u);
  ASSERT_GT(recording.samples(), 1240);
  EXPECT_EQ(recording.segments.front().end, recording.samples());
  for (Index i = 0; i < recording.samples(); ++i) {  // the instants at which the force was read
    const double reads = recording.table.values(i, 0) / 0.008;
    EXPECT_NEAR(reads, std::round(reads), 1e-9);
  }
  Recording fresh = slow_force(1, 0.0);
  keep_new_rows({&fresh}, System());
  EXPECT_EQ(fresh.table.values, slow_force(1, 0.0).table.values);
}

TEST(HeldRows, KeepOneRateOfAllRecordings) {
  Recording two = slow_force(2, 0.0), three = slow_force(3, 0.0);
  keep_new_rows({&two, &three}, System());
  EXPECT_DOUBLE_EQ(two.dt, 0.012);
  EXPECT_DOUBLE_EQ(three.dt, 0.012);
}

// A pose that is new in one row in eight, beside a force in every row: 3 Hz of it pass, noise above
// 25 Hz does not, and a spike is no part of what is averaged.
TEST(HeldRows, OfAPoseLeaveTheForceAveraged) {
  Recording recording = slow_force(1, 0.0);
  Rng rng({8});
  const Eigen::VectorXd t = recording.column("t");
  Eigen::VectorXd x(t.size()), force(t.size()), slow(t.size());
  for (Index i = 0; i < t.size(); ++i) {
    x[i] = std::sin(std::floor(t[i] / 0.016 + 1e-9));
    slow[i] = std::sin(2.0 * M_PI * 3.0 * t[i]);
    force[i] = slow[i] + 0.1 * rng.normal();
  }
  force[1000] = 50.0;
  for (const char* name : {"x", "y", "z"}) recording.set(name, x);
  recording.set("fx", force);
  recording.set("slow", slow);
  keep_new_rows({&recording}, System());
  EXPECT_DOUBLE_EQ(recording.dt, 0.016);
  const Eigen::VectorXd left = recording.column("fx") - recording.column("slow");
  const double rms = std::sqrt(left.squaredNorm() / static_cast<double>(left.size()));
  EXPECT_NEAR(rms, 0.1 * std::sqrt(2.0 * 25.0 / 500.0), 0.007);
  EXPECT_LT(left.cwiseAbs().maxCoeff(), 0.3);
  for (Index i = 0; i < recording.samples(); ++i) {  // where the pose is new
    const double reads = recording.table.values(i, 0) / 0.016;
    EXPECT_NEAR(reads, std::round(reads), 1e-9);
  }
}

TEST(HeldRows, AColumnThatNeverChangesHasOneValue) {
  Eigen::VectorXd column = Eigen::VectorXd::Constant(50, -0.3);
  EXPECT_TRUE(never_changes(column));
  column[49] = std::nextafter(-0.3, 0.0);
  EXPECT_FALSE(never_changes(column));
  EXPECT_TRUE(never_changes(column.head(1)));
}

}  // namespace
}  // namespace dcnn
