// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dcnn/conceal/scenario.h"

namespace dcnn::conceal {
namespace {

TEST(RecordOn, IsTheSameToolWithTheSameEffectsOnThatMotion) {
  const Scenario plain = draw("single:2/mass/1", 5);
  const Recorded& first = plain.recordings.front();
  constexpr Eigen::Index kRows = 5000;
  Recording motion;
  motion.name = "motion.csv";
  motion.table.columns = {"t", "x", "y", "z", "alpha", "beta", "gamma"};
  motion.table.values.resize(kRows, 7);
  motion.table.values << first.t.head(kRows), first.pose.topRows(kRows);
  motion.dt = 0.002;
  motion.segments = {{0, kRows}};
  Scenario more = plain;
  record_on(more, motion, 5);
  ASSERT_EQ(more.recordings.size(), plain.recordings.size() + 1);
  const Recorded& next = more.recordings.back();
  EXPECT_FALSE(next.holdout);
  for (const Recorded& r : plain.recordings) {
    EXPECT_NE(r.name, next.name);
    EXPECT_GT(next.t(0), r.t.maxCoeff() + 4.0);
  }
  EXPECT_LT((next.pose.topRows(4000) - first.pose.topRows(4000)).cwiseAbs().maxCoeff(), 0.01);
  // The mean over the inner rows of what the force differs by: that of the smoothed pose alone.
  const Eigen::MatrixXd difference =
      (next.clean - first.clean.topRows(next.clean.rows())).middleRows(500, 4000);
  EXPECT_LT(difference.colwise().mean().norm(), 0.01);
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 0.5);
  EXPECT_NE(next.measured, next.clean);
  // Noise is that of a stream of its own.
  EXPECT_GT((next.measured - first.measured.topRows(next.measured.rows())).norm(),
            0.5 * plain.noise.sigma * std::sqrt(3.0 * kRows));
}

TEST(RecordOn, AStepOfTheOffsetStays) {
  Scenario s = draw("single:2/step_bias/1", 5);
  const double before = s.hidden[0].interval_s->second;
  Recording motion;
  motion.name = "motion.csv";
  motion.table.columns = {"t", "x", "y", "z", "alpha", "beta", "gamma"};
  motion.table.values = Eigen::MatrixXd::Zero(1000, 7);
  motion.table.values.col(0).setLinSpaced(0.0, 1.998);
  motion.dt = 0.002;
  motion.segments = {{0, 1000}};
  record_on(s, motion, 5);
  EXPECT_GT(s.hidden[0].interval_s->second, before);
}

}  // namespace
}  // namespace dcnn::conceal
