// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/outlying.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "diagnosis/one_joint.h"

namespace dcnn {
namespace {

/// Of two recordings of noise, of 30 s and 6.5 s, where six times as much is left of the second
/// from one time to another, in s.
std::vector<Span> spans_beside(double from, double to) {
  std::vector<Table> tables;
  for (const double seconds : {30.0, 6.5}) {
    Rng rng({7, tables.size()});
    Table table = test::joint_table(static_cast<Index>(200.0 * seconds));
    for (Index i = 0; i < table.values.rows(); ++i) {
      const double t = 0.005 * static_cast<double>(i);
      table.values.row(i) << t, std::sin(3.0 * t), rng.normal();
    }
    tables.push_back(std::move(table));
  }
  Search search = test::search_of_joint(tables);
  search.settle({});
  Signals left;
  for (const Log& log : search.study().logs) left.push_back(log.measured);
  const Eigen::VectorXd& t = search.study().logs[1].motion.t;
  for (Index i = 0; i < t.size(); ++i) {
    if (t(i) >= from && t(i) < to) left[1].row(i) *= 6.0;
  }
  return outlying(search.setting(), left, {});
}

TEST(Outlying, AHandIsLeftOut) {
  const auto spans = spans_beside(3.0, 4.0);
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_EQ(spans[0].log, 1U);
  EXPECT_NEAR(spans[0].begin, 2.5, 1e-9);
  EXPECT_NEAR(spans[0].end, 4.5, 1e-9);
}

// One that is louder throughout shows other motion, even where it is less than a fifth of all.
TEST(Outlying, ARecordingIsNoCollision) { EXPECT_TRUE(spans_beside(0.0, 6.5).empty()); }

}  // namespace
}  // namespace dcnn
