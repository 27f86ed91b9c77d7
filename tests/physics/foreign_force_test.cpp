// SPDX-License-Identifier: Apache-2.0
#include "physics/foreign_force.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

TEST(ForeignForce, IsWhatNeitherToolNorNoiseMakes) {
  EXPECT_DOUBLE_EQ(foreign_share(6.0, 1.0, 10.0), 0.5);
  EXPECT_EQ(foreign_share(1.0, 2.0, 10.0), 0.0);   // less than the noise
  EXPECT_EQ(foreign_share(30.0, 0.0, 10.0), 1.0);  // a fit worse than the mean
  EXPECT_EQ(foreign_share(0.0, 0.0, 0.0), 0.0);    // a force that never changes
}

TEST(ForeignForce, IsSaidWhereItIsMoreThanHalf) {
  EXPECT_EQ(foreign_force_note(0.5, "so"), "");
  EXPECT_EQ(foreign_force_note(0.625, "look"),
            "62 % of what the force varies by is no rigid tool's: look");
}

}  // namespace
}  // namespace dcnn
