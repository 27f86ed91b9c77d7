// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace dcnn {
namespace {

TEST(Rng, TheSameKeyGivesTheSameStreamAndAnotherKeyAnother) {
  Rng a({1, 2}), b({1, 2}), c({2, 1});
  for (int i = 0; i < 100; ++i) {
    const auto bits = a.bits();
    EXPECT_EQ(bits, b.bits());
    EXPECT_NE(bits, c.bits());
  }
}

TEST(Rng, NormalsHaveTheMomentsOfANormal) {
  Rng rng(3);
  constexpr int kCount = 200000;
  double m1 = 0, m2 = 0, m4 = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = rng.normal();
    m1 += x;
    m2 += x * x;
    m4 += x * x * x * x;
  }
  EXPECT_NEAR(m1 / kCount, 0.0, 4.0 / std::sqrt(kCount));
  EXPECT_NEAR(m2 / kCount, 1.0, 4.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(m4 / kCount, 3.0, 4.0 * std::sqrt(96.0 / kCount));
}

TEST(Rng, BelowIsUniform) {
  Rng rng(4);
  std::vector<int> counts(7);
  for (int i = 0; i < 70000; ++i) ++counts[rng.below(7)];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 400);
}

TEST(Permutation, HoldsEveryNumberOnceInRandomOrder) {
  Rng rng(5);
  const auto order = permutation(1000, rng);
  EXPECT_EQ(std::set<std::int64_t>(order.begin(), order.end()).size(), 1000u);
  EXPECT_EQ(*std::max_element(order.begin(), order.end()), 999);
  EXPECT_FALSE(std::is_sorted(order.begin(), order.end()));
}

}  // namespace
}  // namespace dcnn
