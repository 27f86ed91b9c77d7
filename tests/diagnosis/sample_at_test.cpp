// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/sample_at.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

TEST(SampleAt, IsTheNearestOneBehindAGapToo) {
  Motion motion;
  motion.t.resize(5);
  motion.t << 1.0, 1.1, 1.2, 6.2, 6.3;
  EXPECT_EQ(sample_at(motion, 0.0), 0);
  EXPECT_EQ(sample_at(motion, 1.14), 1);
  EXPECT_EQ(sample_at(motion, 3.0), 2);
  EXPECT_EQ(sample_at(motion, 6.21), 3);
  EXPECT_EQ(sample_at(motion, 9.0), 4);
}

}  // namespace
}  // namespace dcnn
