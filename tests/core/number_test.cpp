// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/number.h"

#include <gtest/gtest.h>

#include <limits>

namespace dcnn {
namespace {

TEST(Brief, HasThreeDigitsAndNoExponentWhereAReaderNeedsNone) {
  EXPECT_EQ(brief(0.0), "0");
  EXPECT_EQ(brief(0.041234), "0.0412");
  EXPECT_EQ(brief(-3.0), "-3");
  EXPECT_EQ(brief(999.4), "999");
  EXPECT_EQ(brief(999.6), "1000");
  EXPECT_EQ(brief(-12345.0), "-12300");
  EXPECT_EQ(brief(999400.0), "999000");
  EXPECT_EQ(brief(999600.0), "1e+06");
  EXPECT_EQ(brief(1.234e-7), "1.23e-07");
  EXPECT_EQ(brief(std::numeric_limits<double>::infinity()), "inf");
}

}  // namespace
}  // namespace dcnn
