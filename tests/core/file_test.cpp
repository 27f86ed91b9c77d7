// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/file.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <thread>

#include "dcnn/core/ranks.h"
#include "support/faults.h"
#include "support/sanitizer.h"

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

TEST(FolderLock, LeavesNoFolderThatItMadeAndNobodyWroteTo) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "there");
  { const FolderLock lock(folder / "new/deep/"); }
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
  {
    const FolderLock lock(folder / "new/deep");
    write_file(folder / "new/x", "x");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "new/deep"));
  EXPECT_EQ(test::slurp(folder / "new/x"), "x");
  { const FolderLock lock(folder / "there"); }
  EXPECT_TRUE(std::filesystem::exists(folder / "there")) << "it was there before";
}

TEST(FolderLock, FollowsALinkToAFolderThatIsStillToBeMade) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("named/by/it", folder / "link");
  {
    const FolderLock lock(folder / "link");
    write_file(folder / "link/x", "x");
  }
  EXPECT_EQ(test::slurp(folder / "named/by/it/x"), "x");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
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

std::string error_text(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(WriteFile, KeepsTheModeOfWhatItReplaces) {
  const test::TemporaryFolder folder;
  const auto mode_of = [](const std::filesystem::path& path) {
    struct stat about {};
    ::stat(path.c_str(), &about);
    return about.st_mode & 07777;
  };
  const mode_t before = ::umask(022);
  write_file(folder / "new", "x");
  write_file(folder / "secret", "x");
  ::chmod((folder / "secret").c_str(), 0600);
  write_file(folder / "secret", "y");
  ::umask(before);
  EXPECT_EQ(mode_of(folder / "new"), 0644U);
  EXPECT_EQ(mode_of(folder / "secret"), 0600U);
}

TEST(WriteFile, FollowsLinksBesideThemAsFarAsTheSystemDoes) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a/b");
  std::filesystem::create_symlink("../real", folder / "a/link");
  std::filesystem::create_symlink(folder / "a/link", folder / "absolute");
  write_file(folder / "absolute", "text");
  EXPECT_EQ(test::slurp(folder / "a/../real"), "text");
  for (int k = 1; k <= 41; ++k) {
    std::filesystem::create_symlink(k == 1 ? "end" : "l" + std::to_string(k - 1),
                                    folder / ("l" + std::to_string(k)));
  }
  write_file(folder / "l40", "through forty");
  EXPECT_EQ(test::slurp(folder / "end"), "through forty");
  EXPECT_TRUE(says(error_text([&] { write_file(folder / "l41", "x"); }), "too many links"));
}

TEST(WriteFile, WritesIntoDescriptorsByTheirNames) {
  const test::TemporaryFolder folder;
  const auto path = folder / "by-number";
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT, 0600);
  const std::string number = std::to_string(file);
  write_file("/dev/fd/" + number, "one ");
  write_file("/proc/self/fd/" + number, "two");
  EXPECT_EQ(test::slurp(path), "one two");
  EXPECT_EQ(replaced_file("/dev/fd/" + number), std::nullopt);
  // A name that begins like a number is none.
  EXPECT_NE(error_text([&] { write_file("/proc/self/fd/" + number + "x", "no"); }), "");
  EXPECT_EQ(test::slurp(path), "one two");
  ::close(file);
  // A file whose name is a number is a file.
  write_file(folder / "1", "a file");
  EXPECT_EQ(test::slurp(folder / "1"), "a file");
  EXPECT_EQ(replaced_file(folder / "1"), folder / "1");
  EXPECT_EQ(replaced_file(folder / "absent"), std::nullopt);
  EXPECT_EQ(replaced_file(folder.path()), std::nullopt);
  const auto first = folder / "zero";
  const int kept = ::dup(0), zero = ::open(first.c_str(), O_WRONLY | O_CREAT, 0600);
  ::dup2(zero, 0);
  write_file("/dev/fd/0", "into ");
  write_file("/dev/fd/0", "the lowest");
  ::dup2(kept, 0);
  ::close(kept), ::close(zero);
  EXPECT_EQ(test::slurp(first), "into the lowest");
}

TEST(WriteFile, SaysWhyAFolderCannotBeMadeAndWhyAStreamIsFull) {
  const test::TemporaryFolder folder;
  write_file(folder / "file", "x");
  EXPECT_TRUE(says(error_text([&] { write_file(folder / "file/below/x", "y"); }),
                   "cannot make this folder"));
  EXPECT_TRUE(says(error_text([&] { write_file("/dev/full", "y"); }),
                   "/dev/full: cannot write: No space left on device"));
  EXPECT_EQ(test::slurp(folder / "file"), "x");
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = (folder / "socket").string();
  ASSERT_LT(name.size(), sizeof address.sun_path);
  name.copy(address.sun_path, name.size());
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_TRUE(says(error_text([&] { write_file(name, "y"); }),
                   "socket: cannot write: No such device or address"));
  ::close(socket);
}

class SecondRank : public Ranks {
 public:
  SecondRank() : Ranks(1, 2) { set_ranks(this); }
  ~SecondRank() override { set_ranks(nullptr); }
  void share(std::byte*, const std::vector<Index>&) override {}
};

TEST(WriteFile, IsOfTheFirstRankAlone) {
  const test::TemporaryFolder folder;
  {
    const SecondRank second;
    write_file(folder / "x", "of the second");
    const FolderLock lock(folder / "out");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "x"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(ReadFile, TakesUpToTheMostAndNoByteMore) {
  const test::TemporaryFolder folder;
  write_file(folder / "x", std::string(100, 'x'));
  write_file(folder / "empty", "");
  EXPECT_EQ(read_file(folder / "x", 100, Exit::kData).size(), 100U);
  EXPECT_EQ(read_file(folder / "empty", 0, Exit::kData), "");
  EXPECT_TRUE(
      says(error_text([&] { read_file(folder / "x", 99, Exit::kModel); }), "larger than 99 bytes"));
  EXPECT_TRUE(says(error_text([&] { read_file(folder / "none", 9, Exit::kModel); }),
                   "cannot open: No such file or directory"));
  EXPECT_TRUE(
      says(error_text([&] { read_file("/dev/null", 9, Exit::kModel); }), "is not a regular file"));
}

/// What this program does in a process of its own, where one of its calls may fail.
TEST(DISABLED_InAProcess, DoesWhatItIsTold) {
  const std::string what = std::getenv("DO_WHAT"), path = std::getenv("DO_PATH");
  std::string text;
  try {
    if (what.ends_with(" without input")) ::close(STDIN_FILENO);
    if (what.starts_with("write")) write_file(path, "the new bytes");
    if (what.starts_with("read")) text = read_file(path, 13, Exit::kData);
    if (what.starts_with("lock")) {
      {
        const FolderLock held(path);
        text = error_text([&] { const FolderLock again(path); });
      }
      const FolderLock free_again(path);
    }
    text = "done: " + text;
  } catch (const Error& error) {
    text = std::string("error: ") + error.what();
  }
  std::cout << "\n<" << text << ">" << std::endl;
  ::_exit(0);
}

/// Its words between < and >.
std::string told(const std::string& what, const std::filesystem::path& path,
                 std::vector<std::string> environment = {}, const std::string& input = {}) {
  environment.push_back("DO_WHAT=" + what);
  environment.push_back("DO_PATH=" + path.string());
  const auto result =
      test::Process(test::Program{"/proc/self/exe"},
                    {"--gtest_also_run_disabled_tests", "--gtest_filter=DISABLED_InAProcess.*"},
                    {.input = input, .environment = environment})
          .wait();
  const auto begin = result.out.find("\n<"), end = result.out.rfind('>');
  if (begin == std::string::npos || end == std::string::npos) return result.out + result.err;
  return result.out.substr(begin + 2, end - begin - 2);
}

class FileFaults : public testing::Test {
 protected:
  /// What `what` says for every error of every call of this name, with the place of the call.
  template <class Judge>
  int each(const std::string& what, const std::string& call, const Judge& judge) {
    if (test::kSanitized) return 1;  // the sanitizer must be loaded first
    int faults = 0;
    for (int place = 1;; ++place) {
      for (const int error : test::errors_of_calls().at(call)) {
        const auto mark = folder_ / "mark";
        std::filesystem::remove(mark);
        write_file(path_, "the old bytes");
        const std::string said =
            told(what, path_, test::fault_environment(call, place, error, mark));
        if (!std::filesystem::exists(mark)) return faults;
        SCOPED_TRACE(test::words_of_fault(call, place, error) + " -> " + said);
        judge(place, error, said);
        ++faults;
      }
    }
  }
  static bool harmless(int error) { return error == EINTR || error == test::kOneByte; }
  /// The old bytes and why, and no file beside them.
  void expect_old(const std::string& said, const std::string& words, int error) {
    EXPECT_EQ(said, "error: " + path_.string() + ": " + words + ": " + std::strerror(error));
    EXPECT_EQ(test::slurp(path_), "the old bytes");
    expect_alone();
  }
  void expect_new(const std::string& said) {
    EXPECT_EQ(said, "done: ");
    EXPECT_EQ(test::slurp(path_), "the new bytes");
    expect_alone();
  }
  void expect_alone() {
    for (const auto& entry : std::filesystem::directory_iterator(path_.parent_path())) {
      EXPECT_EQ(entry.path(), path_);
    }
  }

  test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "in/x";
};

TEST_F(FileFaults, OfOpeningLeaveTheOldFileOrCostOnlyTheFoldersSync) {
  EXPECT_GT(each("write", "open",
                 [&](int place, int error, const std::string& said) {
                   if (place == 1 && !harmless(error)) {
                     expect_old(said, "cannot write", error);
                   } else {
                     expect_new(said);
                   }
                 }),
            0);
}

TEST_F(FileFaults, OfWritingLeaveTheOldFile) {
  EXPECT_GT(each("write", "write",
                 [&](int, int error, const std::string& said) {
                   harmless(error) ? expect_new(said) : expect_old(said, "cannot write", error);
                 }),
            0);
}

TEST_F(FileFaults, OfSyncingAreSaid) {
  EXPECT_GT(each("write", "fsync",
                 [&](int place, int error, const std::string& said) {
                   if (harmless(error)) return expect_new(said);
                   if (place == 1) return expect_old(said, "cannot write", error);
                   EXPECT_EQ(said, "error: " + path_.parent_path().string() +
                                       ": cannot write: " + std::strerror(error));
                   EXPECT_EQ(test::slurp(path_), "the new bytes");
                 }),
            0);
  if (test::kSanitized) return;
  // Folders that cannot be synced at all are those of some file systems.
  for (const int error : {EINVAL, ENOTSUP}) {
    expect_new(told("write", path_, test::fault_environment("fsync", 2, error, folder_ / "mark")));
  }
}

TEST_F(FileFaults, OfRenamingLeaveTheOldFile) {
  EXPECT_GT(each("write", "rename",
                 [&](int, int error, const std::string& said) {
                   expect_old(said, "cannot replace", error);
                 }),
            0);
}

TEST_F(FileFaults, OfReadingAreSaidAndShortReadsGoOn) {
  for (const char* call : {"open", "read"}) {
    const bool opening = call == std::string("open");
    EXPECT_GT(each("read", call,
                   [&](int, int error, const std::string& said) {
                     EXPECT_EQ(said, harmless(error) ? "done: the old bytes"
                                                     : "error: " + path_.string() + ": cannot " +
                                                           (opening ? "open: " : "read: ") +
                                                           std::strerror(error));
                   }),
              0);
  }
}

TEST_F(FileFaults, OfStandardInputAreSaidAndShortReadsGoOn) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  write_file(path_, "thirteen byte");
  for (const int error : test::errors_of_calls().at("read")) {
    const std::string said =
        told("read", "-", test::fault_environment("read", 1, error, folder_ / "mark"), path_);
    EXPECT_EQ(said, harmless(error) ? "done: thirteen byte"
                                    : std::string("error: standard input: cannot read: ") +
                                          std::strerror(error));
  }
  write_file(path_, "fourteen bytes");
  EXPECT_EQ(told("read", "-", {}, path_), "error: standard input: larger than 13 bytes");
}

/// Files are then opened as descriptor 0.
TEST_F(FileFaults, WithoutStandardInputAreTheSame) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  write_file(path_, "the old bytes");
  EXPECT_EQ(told("read without input", path_), "done: the old bytes");
  expect_new(told("write without input", path_));
  EXPECT_EQ(told("write without input", "/dev/null"), "done: ");
  EXPECT_TRUE(says(told("lock without input", folder_ / "out"), "done: "));
  EXPECT_TRUE(says(told("lock without input", folder_ / "out"), "another process is writing here"));
  for (const int place : {1, 2}) {
    write_file(path_, "the old bytes");
    const auto fault = test::fault_environment("fsync", place, EIO, folder_ / "mark");
    const std::string said = told("write without input", path_, fault);
    EXPECT_TRUE(says(said, "cannot write: Input/output error")) << place << said;
    EXPECT_EQ(test::slurp(path_), place == 1 ? "the old bytes" : "the new bytes");
  }
}

/// Two processes would otherwise share a folder.
TEST_F(FileFaults, OfLockingThatASignalCausesAreTriedAgain) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  const auto locked = folder_ / "out";
  EXPECT_TRUE(says(told("lock", locked), "another process is writing here"));
  for (const char* call : {"flock", "open"}) {
    EXPECT_TRUE(
        says(told("lock", locked, test::fault_environment(call, 1, EINTR, folder_ / "mark")),
             "another process is writing here"))
        << call;
  }
  EXPECT_TRUE(says(told("lock", locked, test::fault_environment("open", 1, EACCES, folder_ / "m")),
                   "cannot open this folder: Permission denied"));
  EXPECT_EQ(told("lock", locked, test::fault_environment("flock", 1, ENOLCK, folder_ / "m")),
            "done: ")
      << "a file system that cannot lock is not refused";
}

}  // namespace
}  // namespace dcnn
