// SPDX-License-Identifier: Apache-2.0
// The scripts of tools/ as a user mistypes them.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/process.h"

namespace dcnn {
namespace {

std::vector<std::filesystem::path> scripts() {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(DCNN_SOURCE_DIR "/tools")) {
    if (entry.is_regular_file() && test::slurp(entry.path()).starts_with("#!")) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(Scripts, RefuseAnOptionThatTheyDoNotHaveBeforeAnythingElse) {
  EXPECT_GT(scripts().size(), 20U);
  for (const auto& script : scripts()) {
    const auto result = test::Process(test::Program{script}, {"--bogus"}).wait();
    EXPECT_EQ(result.exit_code, 2) << script;
    EXPECT_EQ(result.out, "") << script;
    EXPECT_EQ(result.err,
              "tools/" + script.filename().string() + ": unknown option '--bogus'; see --help\n");
  }
}

TEST(Scripts, ThatNeedAnArgumentSayWhich) {
  for (const char* name : {"real", "records", "real-identifiers", "fuzz", "live-picture"}) {
    const auto result =
        test::Process(test::Program{DCNN_SOURCE_DIR "/tools/" + std::string(name)}, {}).wait();
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_TRUE(result.err.starts_with("tools/" + std::string(name) + ": ")) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

}  // namespace
}  // namespace dcnn
