// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/pace.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

/// What a bar makes of the share: time so far times what is left over what is done.
double time_left(double share, double now) { return now * (1.0 - share) / share; }

TEST(Pace, TellsNothingBeforeSomethingIsMeasured) {
  Pace pace({10.0, 100.0});
  EXPECT_EQ(pace.share(0, 0.0, 0.0), 0.0);
  EXPECT_EQ(pace.share(0, 0.0, 5.0), 0.0);
}

TEST(Pace, ScalesPlannedTimesByMeasuredOnes) {
  Pace pace({10.0, 100.0, 200.0});
  // The first stage takes twice its time, so the others are thought to.
  EXPECT_NEAR(time_left(pace.share(0, 0.5, 10.0), 10.0), 10.0 + 600.0, 1e-9);
  EXPECT_NEAR(time_left(pace.share(0, 1.0, 20.0), 20.0), 600.0, 1e-9);
  // The second one is fast: what is left of it goes by itself, the third by all that was measured.
  const double overall = (20.0 + 5.0) / (10.0 + 50.0);
  EXPECT_NEAR(time_left(pace.share(1, 0.5, 25.0), 25.0), 5.0 + 200.0 * overall, 1e-9);
  EXPECT_NEAR(pace.share(2, 1.0, 100.0), 1.0, 1e-12);
}

TEST(Pace, DoesNotCountAStageThatWasFinishedBefore) {
  Pace pace({1000.0, 10.0, 10.0});
  EXPECT_EQ(pace.share(1, 0.0, 0.1), 0.0);
  EXPECT_NEAR(time_left(pace.share(1, 0.5, 5.1), 5.1), 5.1 + 10.0 * 5.1 / 5.0, 1e-9);
}

}  // namespace
}  // namespace dcnn
