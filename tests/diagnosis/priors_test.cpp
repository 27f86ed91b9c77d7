// SPDX-License-Identifier: Apache-2.0
// The table of priors in the docs is the one in the code.
#include <gtest/gtest.h>

#include <cstdlib>

#include "support/process.h"

namespace dcnn::test {
namespace {

TEST(Priors, TheTableInTheDocsIsThatOfTheCode) {
  const std::string root = DCNN_SOURCE_DIR;
  const TemporaryFolder folder;
  const auto made = folder / "priors.md";
  ASSERT_EQ(std::system((root + "/tools/support/priors > " + made.string()).c_str()), 0);
  EXPECT_EQ(slurp(made), slurp(root + "/docs/develop/priors.md"));
}

}  // namespace
}  // namespace dcnn::test
