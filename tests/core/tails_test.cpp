// SPDX-License-Identifier: Apache-2.0
#include "core/tails.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dcnn {
namespace {

// By the sums of their definition.
double poisson_sum(int count, double mean) {
  double fewer = 0.0, term = std::exp(-mean);
  for (int k = 0; k < count; term *= mean / ++k) fewer += term;
  return 1.0 - fewer;
}

TEST(Tails, OfPoissonAreTheSumOfItsTerms) {
  for (const double mean : {0.01, 0.5, 3.0, 12.7}) {
    for (const int count : {0, 1, 2, 5, 13, 20}) {
      EXPECT_NEAR(poisson_tail(count, mean), poisson_sum(count, mean), 1e-14) << count;
    }
  }
  // Far out the first term is nearly all: 0.01^5/5! exp(-0.01) (1 + 0.01/6 + ...).
  EXPECT_NEAR(poisson_tail(5, 0.01) / (1e-10 / 120.0 * std::exp(-0.01)), 1.0 + 0.01 / 6.0, 3e-6);
  EXPECT_EQ(poisson_tail(5.9, 2.0), poisson_tail(5.0, 2.0));
  EXPECT_EQ(poisson_tail(1.0, 0.0), 0.0);
}

// Above 50 events their number once counted no more.
TEST(Tails, OfPoissonFallWithEveryEvent) {
  double before = 1.0;
  for (int count = 10; count < 200; count += 10) {
    const double tail = poisson_tail(count, 40.0);
    EXPECT_LT(tail, before) << count;
    before = tail;
  }
  EXPECT_LT(before, 1e-60);
}

TEST(Tails, OfLargeCountsAreThoseOfTheNormal) {
  const double mean = 1e6;
  for (const double z : {-1.0, 0.0, 1.0}) {
    const double normal = 0.5 * std::erfc(z / std::sqrt(2.0));
    EXPECT_NEAR(poisson_tail(mean + 1e3 * z, mean), normal, 1e-3);
    EXPECT_NEAR(binomial_tail(2.0 * mean + 1e3 * z, 4.0 * mean, 0.5), normal, 1e-3);
  }
}

TEST(Tails, OfTheBinomialAreTheSumOfItsTerms) {
  for (const double p : {0.03, 0.4, 0.9}) {
    double tail = 0.0;
    for (int k = 12; k >= 0; --k) {
      const double ways = std::tgamma(13.0) / std::tgamma(k + 1.0) / std::tgamma(13.0 - k);
      tail += ways * std::pow(p, k) * std::pow(1.0 - p, 12 - k);
      EXPECT_NEAR(binomial_tail(k, 12.0, p), tail, 1e-13) << k << " of 12 at " << p;
    }
  }
  EXPECT_NEAR(binomial_tail(20.0, 20.0, 0.25) / std::pow(0.25, 20), 1.0, 1e-12);
  EXPECT_EQ(binomial_tail(13.0, 12.0, 0.4), 0.0);
}

TEST(Tails, OfTheNormalDistribution) {
  for (double z = -6.0; z < 37.0; z += 0.0625) {
    const double exact = 0.5 * std::erfc(z / std::sqrt(2.0));
    EXPECT_NEAR(normal_tail(z) / exact, 1.0, 1e-13 * (1.0 + z * z)) << z;
  }
  EXPECT_EQ(normal_tail(0.0), 0.5);
  EXPECT_EQ(normal_tail(std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_EQ(normal_tail(-std::numeric_limits<double>::infinity()), 1.0);
}

}  // namespace
}  // namespace dcnn
