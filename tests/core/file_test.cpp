#include "dcnn/core/file.h"

#include <gtest/gtest.h>

#include "support/process.h"

namespace dcnn {
namespace {

TEST(WriteFile, ReplacesTheWholeFileAndMakesItsFolder) {
  const test::TemporaryFolder folder;
  const auto path = folder / "a/b/c.txt";
  write_file(path, "first");
  write_file(path, "second");
  EXPECT_EQ(read_file(path, 100, Exit::kData), "second");
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path.parent_path()))
    ++entries;
  EXPECT_EQ(entries, 1) << "no temporary file stays";
}

TEST(WriteFile, FailsWithoutTouchingTheOldFile) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "taken");
  write_file(folder / "taken/x", "old");
  EXPECT_THROW(write_file(folder / "taken", "new"), Error)
      << "a folder cannot be replaced by a file";
  EXPECT_EQ(read_file(folder / "taken/x", 100, Exit::kData), "old");
}

TEST(ReadFile, RefusesFoldersMissingAndOversizedFiles) {
  const test::TemporaryFolder folder;
  write_file(folder / "big", std::string(101, 'x'));
  EXPECT_THROW(read_file(folder.path(), 100, Exit::kData), Error);
  EXPECT_THROW(read_file(folder / "none", 100, Exit::kData), Error);
  EXPECT_THROW(read_file(folder / "big", 100, Exit::kData), Error);
}

}  // namespace
}  // namespace dcnn
