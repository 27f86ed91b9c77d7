// SPDX-License-Identifier: Apache-2.0
#include "check/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dcnn::check {
namespace {

// exp(800) is infinite, and infinity over infinity no number.
TEST(CheckStatistics, LogOddsOfAnySizeAreProbabilities) {
  EXPECT_EQ(probability_of_log_odds(800.0), 1.0);
  EXPECT_EQ(probability_of_log_odds(-800.0), 0.0);
  EXPECT_EQ(probability_of_log_odds(INFINITY), 1.0);
  EXPECT_EQ(probability_of_log_odds(-INFINITY), 0.0);
  EXPECT_EQ(probability_of_log_odds(0.0), 0.5);
  EXPECT_NEAR(probability_of_log_odds(log_odds_of(0.004)), 0.004, 1e-17);
}

TEST(CheckStatistics, ASumOfExponentialsBeyondDoubleHasALogarithm) {
  EXPECT_NEAR(log_sum(Eigen::Vector3d(1000.0, 1000.0, -1000.0)), 1000.0 + std::log(2.0), 1e-12);
  EXPECT_NEAR(log_sum(Eigen::Vector2d(-2000.0, -INFINITY)), -2000.0, 1e-12);
}

// The bound on the Bayes factor is 1 at p = 1/e and grows as 1/p below.
TEST(CheckStatistics, PosteriorsFollowThePValue) {
  EXPECT_NEAR(posterior_of_p(std::exp(-1.0)), kFaultPrior, 1e-15);
  const double odds = kFaultPrior / (1.0 - kFaultPrior) / (std::exp(1.0) * 1e-6 * std::log(1e6));
  EXPECT_NEAR(posterior_of_p(1e-6), odds / (1.0 + odds), 1e-12);
  EXPECT_EQ(posterior_of_p(0.0), 1.0);
}

}  // namespace
}  // namespace dcnn::check
