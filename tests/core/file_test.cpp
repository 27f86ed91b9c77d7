#include "dcnn/core/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <thread>

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

TEST(WriteFile, FollowsLinksAndWritesToStreams) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("real.txt", folder / "link");
  write_file(folder / "link", "through a dangling link");
  write_file(folder / "link", "again");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(test::slurp(folder / "real.txt"), "again");
  EXPECT_EQ(replaced_file(folder / "link"), folder / "real.txt");

  ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = test::slurp(folder / "fifo"); });
  write_file(folder / "fifo", "through a pipe");
  reader.join();
  EXPECT_EQ(got, "through a pipe");
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "fifo"));
  EXPECT_EQ(replaced_file(folder / "fifo"), std::nullopt);
  EXPECT_EQ(replaced_file("-"), std::nullopt);
}

TEST(FolderLock, IsHeldByOneAtATime) {
  const test::TemporaryFolder folder;
  {
    const FolderLock first(folder / "out");
    EXPECT_THROW(FolderLock(folder / "out"), Error);
  }
  EXPECT_NO_THROW(FolderLock(folder / "out"));
}

/// Who can write into the folder could foresee PATH.tmp<process> and put a link there.
TEST(WriteFile, FollowsNoLinkThatWaitsUnderATemporaryName) {
  const test::TemporaryFolder folder;
  write_file(folder / "victim", "precious");
  std::filesystem::create_symlink(folder / "victim",
                                  folder / ("x.tmp" + std::to_string(::getpid())));
  write_file(folder / "x", "new");
  EXPECT_EQ(read_file(folder / "x", 100, Exit::kData), "new");
  EXPECT_EQ(read_file(folder / "victim", 100, Exit::kData), "precious");
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
