// SPDX-License-Identifier: Apache-2.0
#include "core/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// |value - exact| in units in the last place of the exact value.
double ulps(double value, long double exact) {
  const double size = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(size, kInfinite) - size;
  return static_cast<double>(std::abs(value - exact)) / unit;
}

/// The largest error of a function against the C library's in long double over random arguments.
template <class Ours, class Exact>
double worst(double low, double high, Ours ours, Exact exact) {
  Rng rng({1});
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double x = rng.uniform(low, high);
    worst = std::max(worst, ulps(ours(x), exact(static_cast<long double>(x))));
  }
  return worst;
}

#define EXPECT_ACCURATE(function, low, high)                                 \
  EXPECT_LT(worst(                                                           \
                low, high, [](double x) { return elementary::function(x); }, \
                [](long double x) { return std::function(x); }),             \
            3.0)                                                             \
      << #function << " in [" << (low) << ", " << (high) << "]"

TEST(Elementary, FunctionsAreAccurateToThreeUnitsInTheLastPlace) {
  EXPECT_ACCURATE(exp, -1.0, 1.0);
  EXPECT_ACCURATE(exp, -745.0, 709.0);
  EXPECT_ACCURATE(expm1, -1.0, 1.0);
  EXPECT_ACCURATE(expm1, -1e-5, 1e-5);
  EXPECT_ACCURATE(expm1, -45.0, 45.0);
  EXPECT_ACCURATE(log, 0.5, 2.0);
  EXPECT_ACCURATE(log, 1e-300, 1e300);
  EXPECT_ACCURATE(log, 1e-310, 1e-309);
  EXPECT_ACCURATE(log1p, -0.5, 1.0);
  EXPECT_ACCURATE(log1p, -1e-4, 1e-4);
  EXPECT_ACCURATE(tanh, -1.0, 1.0);
  EXPECT_ACCURATE(tanh, -25.0, 25.0);
  EXPECT_ACCURATE(sin, -4.0, 4.0);
  EXPECT_ACCURATE(sin, -1e8, 1e8);
  EXPECT_ACCURATE(cos, -4.0, 4.0);
  EXPECT_ACCURATE(cos, -1e8, 1e8);
  EXPECT_ACCURATE(tan, -1.5, 1.5);
  EXPECT_ACCURATE(acos, -1.0, 1.0);
}

TEST(Elementary, AnglesOfAllQuadrantsAndSizes) {
  Rng rng({2});
  for (int i = 0; i < 20000; ++i) {
    const double y = rng.uniform(-1.0, 1.0) * (i % 3 ? 1.0 : 1e-6);
    const double x = rng.uniform(-1.0, 1.0) * (i % 5 ? 1.0 : 1e-9);
    EXPECT_LT(ulps(elementary::atan2(y, x), atan2l(y, x)), 3.0) << y << " " << x;
  }
  for (const double x : {0.0, -0.0, 1.0, -1.0, kInfinite, -kInfinite}) {
    for (const double y : {0.0, -0.0, 1.0, -1.0, kInfinite, -kInfinite}) {
      const double angle = elementary::atan2(y, x);
      EXPECT_DOUBLE_EQ(angle, std::atan2(y, x)) << y << " " << x;
      EXPECT_EQ(std::signbit(angle), std::signbit(y));
    }
  }
}

TEST(Elementary, PowersAreAsAccurateAsTheirExponentAllows) {
  Rng rng({3});
  for (int i = 0; i < 20000; ++i) {
    const double x = rng.uniform(0.0, 3.0), y = rng.uniform(-9.0, 9.0);
    const double allowed = 2.0 * (1.0 + std::abs(y * std::log(x)));
    EXPECT_LT(ulps(elementary::pow(x, y), powl(x, y)), allowed) << x << " " << y;
  }
  EXPECT_EQ(elementary::pow(-3.0, 3), -27.0);
  EXPECT_EQ(elementary::pow(2.0, -2), 0.25);
  EXPECT_EQ(elementary::pow(0.0, 0), 1.0);
}

TEST(Elementary, LimitsAndDomains) {
  EXPECT_EQ(elementary::exp(1000.0), kInfinite);
  EXPECT_EQ(elementary::exp(-kInfinite), 0.0);
  EXPECT_EQ(elementary::log(0.0), -kInfinite);
  EXPECT_EQ(elementary::log(kInfinite), kInfinite);
  EXPECT_TRUE(std::isnan(elementary::log(-1.0)));
  EXPECT_TRUE(std::isnan(elementary::sin(kInfinite)));
  EXPECT_TRUE(std::isnan(elementary::exp(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(elementary::tanh(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_EQ(elementary::tanh(-kInfinite), -1.0);
  EXPECT_EQ(elementary::log1p(-1.0), -kInfinite);
  EXPECT_EQ(elementary::expm1(-kInfinite), -1.0);
}

TEST(Elementary, HugeAnglesStayOnTheCircle) {
  for (const double angle : {1e9, -3e12, 1e300}) {
    const auto wave = elementary::polar(1.0, angle);
    EXPECT_NEAR(std::norm(wave), 1.0, 1e-15);
  }
  EXPECT_NEAR(elementary::sin(1e9), std::sin(1e9), 1e9 * 1.2e-16);
}

}  // namespace
}  // namespace dcnn
