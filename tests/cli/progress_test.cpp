// SPDX-License-Identifier: Apache-2.0
// The time left that the progress bar shows.
#include <gtest/gtest.h>

#include "../tools/support/time_left.h"

namespace dcnn {
namespace {

TEST(TimeLeftOfProgress, IsThatOfTheWorkAtHand) {
  TimeLeft left;
  EXPECT_FALSE(left.update(0.0, 100.0));  // the first update: no rate yet
  EXPECT_DOUBLE_EQ(left.update(0.25, 110.0).value(), 30.0);
  EXPECT_DOUBLE_EQ(left.update(1.0, 140.0).value(), 0.0);
  EXPECT_FALSE(left.update(0.01, 150.0));  // the next candidate: its own time alone counts
  EXPECT_FALSE(left.update(0.02, 150.5));
  EXPECT_NEAR(left.update(0.11, 151.0).value(), 8.9, 1e-9);
}

TEST(TimeLeftOfProgress, IsMeasuredAnewWhereOtherWorkBeginsAtTheSameShare) {
  TimeLeft left;
  left.update(0.0, 0.0);
  left.restart();
  EXPECT_FALSE(left.update(0.0, 50.0));
  EXPECT_DOUBLE_EQ(left.update(0.5, 60.0).value(), 10.0);
}

TEST(TimeLeftOfProgress, OfAResumedRunCountsWhatWasGainedSince) {
  TimeLeft left;
  EXPECT_FALSE(left.update(0.5, 0.0));
  EXPECT_FALSE(left.update(0.51, 5.0));                       // too little and too early
  EXPECT_NEAR(left.update(0.51, 20.0).value(), 980.0, 1e-9);  // slow, but known by now
}

}  // namespace
}  // namespace dcnn
