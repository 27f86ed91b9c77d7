// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/file_names.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

TEST(FileNames, TellFilesOfOneNameApartByTheirFolders) {
  const std::vector<std::filesystem::path> list{"out/r1/log.csv", "out/r2/log.csv", "./a.csv",
                                                "b/r1/log.csv"};
  EXPECT_EQ(distinct_name("out/r2/log.csv", list), "r2/log.csv");
  EXPECT_EQ(distinct_name("out/r1/log.csv", list), "out/r1/log.csv");
  EXPECT_EQ(distinct_name("./a.csv", list), "a.csv");
  EXPECT_EQ(distinct_name("x/a.csv", {"x/a.csv", "x/./a.csv"}), "a.csv");  // the same file twice
  EXPECT_EQ(distinct_name("/log.csv", {"/log.csv", "log.csv"}), "/log.csv");
}

}  // namespace
}  // namespace dcnn
