// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "design/path.h"
#include "design/proposals.h"
#include "support/design.h"

namespace dcnn::design {
namespace {

Spline some_spline(std::uint64_t seed) {
  Rng rng({seed});
  return draw_spline(test::tool_limits(), 8.0, rng);
}

TEST(DesignSpline, BeginsAndEndsAtRestInTheStart) {
  const Limits limits = test::tool_limits();
  const SplineSamples s = sample(some_spline(3), 500.0);
  for (const Index k : {Index(0), s.t.size() - 1}) {
    EXPECT_LT((s.value.row(k).transpose() - limits.start).norm(), 1e-12);
    EXPECT_LT(s.first.row(k).norm(), 1e-9);
    EXPECT_LT(s.second.row(k).norm(), 1e-7);
    EXPECT_LT(s.third.row(k).norm(), 1e-5);
  }
  EXPECT_NEAR(s.t(s.t.size() - 1), 8.0, 1e-9);
}

TEST(DesignSpline, DerivativesAreThoseOfFiniteDifferences) {
  constexpr double kHz = 20000.0;
  const SplineSamples s = sample(some_spline(4), kHz);
  const Eigen::MatrixXd* const blocks[] = {&s.value, &s.first, &s.second, &s.third};
  for (int d = 0; d < 3; ++d) {
    const Eigen::MatrixXd& f = *blocks[d];
    const Index n = f.rows();
    const Eigen::MatrixXd central = (f.bottomRows(n - 2) - f.topRows(n - 2)) * (0.5 * kHz);
    const double scale = blocks[d + 1]->cwiseAbs().maxCoeff();
    ASSERT_GT(scale, 0.0);
    EXPECT_LT((central - blocks[d + 1]->middleRows(1, n - 2)).cwiseAbs().maxCoeff(), 1e-3 * scale)
        << d;
  }
}

TEST(DesignSpline, PlayedMotionHasTheDerivativesOfItsPose) {
  const Limits limits = test::tool_limits();
  const Played p = play(some_spline(5), limits, ToolModel(), 5000.0, 0.0);
  const Index n = p.pose.rows();
  const Eigen::MatrixXd v =
      (p.pose.leftCols(3).bottomRows(n - 2) - p.pose.leftCols(3).topRows(n - 2)) * 2500.0;
  EXPECT_LT((v - p.motion.v_B.middleRows(1, n - 2)).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace dcnn::design
