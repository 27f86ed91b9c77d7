// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/line_filter.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

Eigen::MatrixXd draw(Index rows, Index columns, std::uint64_t seed) {
  Rng rng(seed);
  Eigen::MatrixXd x(rows, columns);
  for (double& value : x.reshaped()) value = 3.0 + rng.normal();
  return x;
}

/// The newest value of the least-squares line through the last n rows, from its normal equations.
double brute_force(const Eigen::VectorXd& x, Index row, Index begin, Index n) {
  double s1 = 0.0, st = 0.0, stt = 0.0, sx = 0.0, stx = 0.0;
  for (Index i = 0; i < n; ++i) {
    const double value = x[std::max(begin, row - i)], t = -static_cast<double>(i);
    s1 += 1.0, st += t, stt += t * t, sx += value, stx += t * value;
  }
  return (sx * stt - st * stx) / (s1 * stt - st * st);
}

TEST(LineFilter, IsTheLeastSquaresLineOfEverySegment) {
  const Eigen::MatrixXd x = draw(300, 2, 1);
  std::vector<Index> begins(300, 0);
  std::fill(begins.begin() + 170, begins.end(), 170);
  for (const Index n : {2, 8, 24, 64, 128}) {
    const Eigen::MatrixXd fit = line_filtered(x, begins, n);
    for (Index i = 0; i < x.rows(); ++i) {
      const Index begin = begins[static_cast<std::size_t>(i)];
      for (Index j = 0; j < 2; ++j) {
        EXPECT_NEAR(fit(i, j), brute_force(x.col(j), i, begin, n), 1e-10) << n << " at " << i;
      }
    }
  }
}

TEST(LineFilter, FollowsARampWithoutLag) {
  const Eigen::MatrixXd x = Eigen::VectorXd::LinSpaced(200, 5.0, -7.0);
  const Eigen::MatrixXd fit = line_filtered(x, std::vector<Index>(200, 0), 64);
  EXPECT_LT((fit - x).bottomRows(200 - 63).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(LineFilter, WhiteNoiseLeavesWithItsKnownPower) {
  const Eigen::MatrixXd x = draw(200000, 1, 2);
  const Index n = 24;
  const Eigen::MatrixXd fit = line_filtered(x, std::vector<Index>(200000, 0), n);
  const double power = (fit.array() - 3.0).square().mean();
  EXPECT_NEAR(power, (4.0 * n - 2.0) / (n * (n + 1.0)), 0.05 * power);
}

TEST(LineFilter, KnowsNothingOfTheFuture) {
  Eigen::MatrixXd x = draw(100, 1, 3);
  const std::vector<Index> begins(100, 0);
  const Eigen::MatrixXd before = line_filtered(x, begins, 16);
  x.bottomRows(40).setConstant(1e6);
  EXPECT_EQ(line_filtered(x, begins, 16).topRows(60), before.topRows(60));
}

}  // namespace
}  // namespace dcnn
