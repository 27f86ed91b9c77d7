// SPDX-License-Identifier: Apache-2.0
// Stamps that were written with few digits.
#include <gtest/gtest.h>

#include <cmath>

#include "data/clock.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

/// An even clock of `hz`, to so many digits: rounded to multiples of `digit`.
Eigen::VectorXd clock_of(double hz, double digit, Index rows = 4000) {
  Eigen::VectorXd t(rows);
  for (Index k = 0; k < rows; ++k) {
    t[k] = 12.3 + static_cast<double>(k) / hz;
    if (digit > 0.0) t[k] = digit * std::round(t[k] / digit);
  }
  return t;
}

TEST(RoundedClock, IsTheEvenClockThatTheStampsShow) {
  for (const auto& [hz, digit] : {std::pair{3004.8, 1e-4}, {720.0, 1e-3}, {1000.0, 0.01}}) {
    const auto step = step_of_rounded(clock_of(hz, digit));
    ASSERT_TRUE(step) << hz;
    EXPECT_NEAR(*step * hz, 1.0, 1e-4) << hz;
  }
}

TEST(RoundedClock, AnEvenClockStaysAsItIs) {
  EXPECT_FALSE(step_of_rounded(clock_of(500.0, 1e-3)));
  EXPECT_FALSE(step_of_rounded(clock_of(240.0, 1e-6)));
  EXPECT_FALSE(step_of_rounded(clock_of(333.3, 0.0)));
}

TEST(RoundedClock, LostRowsAndJitterAreNoRounding) {
  const Eigen::VectorXd t = clock_of(500.0, 1e-3);
  Eigen::VectorXd lost(t.size() - 1), repeated = t;
  lost << t.head(700), t.tail(t.size() - 701);
  EXPECT_FALSE(step_of_rounded(lost));
  repeated.tail(1300).array() -= 0.002;
  EXPECT_FALSE(step_of_rounded(repeated));
  Eigen::VectorXd jittered = clock_of(500.0, 0.0);
  Rng rng({5u});
  for (double& stamp : jittered) stamp = 1e-4 * std::round((stamp + 5e-4 * rng.normal()) / 1e-4);
  EXPECT_FALSE(step_of_rounded(jittered));
}

TEST(RoundedClock, ARecordingIsReadOnIt) {
  Recording recording;
  recording.name = "a.csv";
  const Eigen::VectorXd t = clock_of(3004.8, 1e-4);
  recording.table.values.resize(t.size(), 0);
  recording.set("t", t);
  set_clock(recording, "a.csv", false);
  check_regular(recording, "a.csv");
  EXPECT_NEAR(recording.dt, 1.0 / 3004.8, 1e-9);
  EXPECT_EQ(recording.segments.size(), 1U);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("few digits"), std::string::npos);
}

}  // namespace
}  // namespace dcnn
