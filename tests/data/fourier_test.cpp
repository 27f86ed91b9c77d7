// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/fourier.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

Eigen::VectorXd noise(Index n) {
  Rng rng({4, static_cast<std::uint64_t>(n)});
  return Eigen::VectorXd::NullaryExpr(n, [&] { return rng.normal(); });
}

/// The definition, term by term.
std::complex<double> sum(const Eigen::VectorXd& x, Index k) {
  std::complex<double> sum;
  for (Index n = 0; n < x.size(); ++n) {
    const double turn = static_cast<double>(k * n % x.size()) / static_cast<double>(x.size());
    sum += x(n) * std::polar(1.0, -2.0 * std::numbers::pi * turn);
  }
  return sum;
}

class FourierOfLength : public testing::TestWithParam<Index> {};

TEST_P(FourierOfLength, IsTheSumThatDefinesIt) {
  const Eigen::VectorXd x = noise(GetParam());
  const Eigen::VectorXcd X = fourier(x);
  ASSERT_EQ(X.size(), GetParam() / 2 + 1);
  for (Index k = 0; k < X.size(); ++k) EXPECT_LT(std::abs(X(k) - sum(x, k)), 1e-13 * x.size());
}

TEST_P(FourierOfLength, IsUndoneByItsInverse) {
  const Eigen::VectorXd x = noise(GetParam());
  EXPECT_LT((Fourier(GetParam()).inverse(fourier(x)) - x).cwiseAbs().maxCoeff(), 1e-14);
}

TEST_P(FourierOfLength, GivesTheCosineTransform) {
  const Index n = GetParam();
  const Eigen::VectorXd x = noise(n), X = cosine_transform(x);
  for (const Index k : {Index{0}, n / 3, n / 2, n - 1}) {
    double sum = 0.0;
    for (Index i = 0; i < n; ++i) {
      const double turn = static_cast<double>(k) * (static_cast<double>(i) + 0.5);
      sum += x(i) * std::cos(std::numbers::pi * turn / static_cast<double>(n));
    }
    EXPECT_NEAR(X(k), sum, 1e-12 * static_cast<double>(n)) << k;
  }
}

// Every radix, products of them, primes and powers of a prime that has no step of its own.
INSTANTIATE_TEST_SUITE_P(Lengths, FourierOfLength,
                         testing::Values(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 13, 14, 15, 16, 22, 25,
                                         49, 60, 67, 97, 98, 134, 360, 1000, 4003, 8006));

}  // namespace
}  // namespace dcnn
