// The time left follows what steps of a kind took here, not what was expected of them elsewhere.
#include <gtest/gtest.h>

#include "experiment/reproduction/ledger.h"

namespace dcnn {
namespace {

Step step(const std::string& name, double seconds) {
  Step made;
  made.name = name;
  made.seconds = seconds;
  return made;
}

/// Seconds left, when `share` of the work is done after so many.
double left(double share, double after) { return after * (1.0 - share) / share; }

TEST(StepTimes, FollowWhatStepsOfAKindTook) {
  const std::vector<Step> steps{step("A/cf: training", 10), step("A/cf: scoring, feature", 10),
                                step("A/dcnn: training", 20), step("A/dcnn: scoring, feature", 10)};
  StepTimes times(steps);
  times.finish(steps[0], 50.0);  // five times as long as expected: so will the other things
  EXPECT_NEAR(left(times.share(steps[1], 0.0), 50.0), 5.0 * 40.0, 1e-9);
  times.finish(steps[1], 10.0);  // but scoring is as fast as expected
  EXPECT_NEAR(left(times.share(steps[2], 0.0), 60.0), 5.0 * 20.0 + 10.0, 1e-9);
  times.finish(steps[2], 100.0);
  times.finish(steps[3], 10.0);
  EXPECT_NEAR(times.share(steps[3], 0.0), 1.0, 1e-12);
}

TEST(StepTimes, LearnFromStepsOfAnEarlierRun) {
  const std::vector<Step> steps{step("A/cf: training", 10), step("A/dcnn: training", 20),
                                step("A/dcnn: scoring, feature", 10)};
  StepTimes times(steps);
  times.skip(steps[0], 30.0);
  times.finish(steps[1], 60.0);
  EXPECT_NEAR(left(times.share(steps[2], 0.0), 60.0), 30.0, 1e-9);
}

}  // namespace
}  // namespace dcnn
