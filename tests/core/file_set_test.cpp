// SPDX-License-Identifier: Apache-2.0
// Several files are replaced as one, whatever fails and wherever the process ends.
#include "dcnn/core/file_set.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <iostream>
#include <map>

#include "dcnn/core/claims.h"
#include "dcnn/core/file.h"
#include "support/faults.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMost = 1000;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

class FileSets : public testing::Test {
 protected:
  using Files = std::map<std::string, std::string>;

  static Files earlier() {
    return {{"out/a", "old"}, {"out/deep/b", "old"}, {"out/part_9", "old"}, {"seal", "old"}};
  }
  static Files later() {
    return {{"out/a", "new"}, {"out/deep/b", "new"}, {"out/c", "new"}, {"seal", "new"}};
  }
  void lay(const Files& files) const {
    fs::remove_all(folder_ / "out");
    for (const auto& [name, bytes] : files) write_file(folder_ / name, bytes);
  }
  static void write_later(const fs::path& folder) {
    FileSet files(folder / "out");
    files.replaces("part_*");
    for (const auto& [name, bytes] : later()) write_file(folder / name, bytes);
    files.commit();
  }
  /// All files but hidden ones and the seal's temporaries.
  Files there() const {
    Files files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      const std::string name = entry.path().lexically_relative(folder_.path()).string();
      if (!entry.is_regular_file() || name.find("seal.tmp") == 0 || name == "mark") continue;
      files[name] = read_file(entry.path(), kMost, Exit::kData);
    }
    return files;
  }

  test::TemporaryFolder folder_;
};

TEST_F(FileSets, BecomeOneResultAtOnce) {
  lay(earlier());
  {
    FileSet files(folder_ / "out");
    write_file(folder_ / "out/a", "of a set that is given up");
    EXPECT_EQ(read_file(folder_ / "out/a", kMost, Exit::kData), "of a set that is given up");
  }
  EXPECT_EQ(there(), earlier());
  write_later(folder_.path());
  EXPECT_EQ(there(), later());
  for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().string().find(".dcnn-set"), std::string::npos) << entry.path();
    EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
  }
}

TEST_F(FileSets, WithinOneAnotherAreOne) {
  lay(earlier());
  {
    FileSet outer(folder_ / "out");
    write_later(folder_.path());
    EXPECT_EQ(read_file(folder_ / "out/a", kMost, Exit::kData), "new");
  }
  EXPECT_EQ(there(), earlier()) << "the outer one was not committed";
}

TEST_F(FileSets, KeepWhatSomebodyElseHasMadeMeanwhile) {
  claim_new(folder_ / "out/a");
  FileSet files(folder_ / "out");
  write_file(folder_ / "out/0", "new");
  write_file(folder_ / "out/a", "new");
  std::ofstream(folder_ / "out/a") << "somebody's";
  EXPECT_NE(error_of([&] { files.commit(); }).find("out/a: was made by somebody else"),
            std::string::npos);
  EXPECT_EQ(test::slurp(folder_ / "out/a"), "somebody's");
  EXPECT_FALSE(fs::exists(folder_ / "out/0"));
}

/// What this program does in a process of its own, where one of its calls may fail or end it.
TEST(DISABLED_ASetInAProcess, IsWritten) {
  struct Access : FileSets {
    using FileSets::write_later;
    void TestBody() override {}
  };
  std::string text = "done";
  try {
    Access::write_later(std::getenv("DO_PATH"));
  } catch (const Error& error) {
    text = std::string("error: ") + error.what();
  }
  std::cout << "\n<" << text << ">" << std::endl;
  ::_exit(0);
}

TEST_F(FileSets, AreAllOldOrAllNewWhateverFailsAndWhereverTheProcessEnds) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  int faults = 0, kills_undone = 0, kills_finished = 0;
  for (const char* call :
       {"open", "write", "fsync", "rename", "link", "unlink", "mkdir", "flock"}) {
    std::vector<int> errors = test::errors_of_calls().at(call);
    errors.push_back(test::kKill);
    for (int place = 1;; ++place) {
      bool made = false;
      for (const int error : errors) {
        lay(earlier());
        const fs::path mark = folder_ / "mark";
        fs::remove(mark);
        auto environment = test::fault_environment(call, place, error, mark);
        environment.push_back("DO_PATH=" + folder_.path().string());
        const auto result = test::Process(test::Program{"/proc/self/exe"},
                                          {"--gtest_also_run_disabled_tests",
                                           "--gtest_filter=DISABLED_ASetInAProcess.*"},
                                          {.environment = environment})
                                .wait();
        made = fs::exists(mark);
        if (!made) break;
        ++faults;
        SCOPED_TRACE(test::words_of_fault(call, place, error) + " " + result.out);
        if (error == test::kKill) {
          ASSERT_EQ(result.exit_code, 128 + SIGKILL);
          recover_file_sets(folder_ / "out");
          ++(there() == earlier() ? kills_undone : kills_finished);
        }
        const Files now = there();
        const bool done = result.out.find("<done>") != std::string::npos;
        const bool failed = result.out.find("<error: ") != std::string::npos;
        EXPECT_TRUE(failed ? now == earlier()
                    : done ? now == later()
                           : now == earlier() || now == later())
            << testing::PrintToString(now);
        EXPECT_TRUE(done || failed || error == test::kKill);
      }
      if (!made) break;
    }
  }
  EXPECT_GT(faults, 50);
  EXPECT_GT(kills_undone, 5);
  EXPECT_GT(kills_finished, 3);
}

/// A folder of somebody else's may hold anything under that name.
TEST_F(FileSets, LeftBehindTouchNothingOutsideTheirFolder) {
  const std::string zero(1, '\0');
  write_file(folder_ / "victim", "precious");
  fs::create_directories(folder_ / "out");
  fs::create_symlink(folder_.path(), folder_ / "out/link");
  for (const std::string& path :
       {std::string("../victim"), std::string("link/victim"), (folder_ / "victim").string()}) {
    for (const char* kind : {"r", "d", "n", "o"}) {
      write_file(folder_ / "out/.dcnn-set-1/0", "hostile");
      write_file(folder_ / "out/.dcnn-set-1/journal",
                 "dcnn-set 1" + zero + kind + zero + "0" + zero + path + zero + "end" + zero);
      recover_file_sets(folder_ / "out");
      EXPECT_EQ(test::slurp(folder_ / "victim"), "precious") << kind << " " << path;
      EXPECT_FALSE(fs::exists(folder_ / "out/.dcnn-set-1"));
    }
  }
}

TEST_F(FileSets, OfALivingProcessAreLeftAlone) {
  FileSet living(folder_ / "out");
  write_file(folder_ / "out/a", "new");
  recover_file_sets(folder_ / "out");
  living.commit();
  EXPECT_EQ(test::slurp(folder_ / "out/a"), "new");
}

TEST(Claims, OfNewNamesReplaceNothingAndKeepBoth) {
  const test::TemporaryFolder folder;
  claim_new(folder / "m.dcnn");
  claim_new(folder.path(), "*.csv");
  std::ofstream(folder / "m.dcnn") << "somebody's";
  const std::string words = error_of([&] { write_file(folder / "m.dcnn", "of an hour's work"); });
  EXPECT_NE(words.find("was made by somebody else meanwhile and is kept"), std::string::npos)
      << words;
  EXPECT_EQ(test::slurp(folder / "m.dcnn"), "somebody's");
  EXPECT_EQ(test::slurp(folder / "m.dcnn.2"), "of an hour's work");
  write_file(folder / "a.csv", "first");
  write_file(folder / "a.csv", "again: it is ours");
  EXPECT_EQ(test::slurp(folder / "a.csv"), "again: it is ours");
}

TEST(Claims, OfResultsThatMayBeReplacedHoldAgainstOthersAlone) {
  const test::TemporaryFolder folder;
  const auto is_short = +[](const fs::path& file) { return fs::file_size(file) < 10; };
  claim_new(folder / "a", is_short);
  claim_new(folder / "b", is_short);
  std::ofstream(folder / "a") << "made";
  std::ofstream(folder / "b") << "somebody's own text";
  write_file(folder / "a", "made again");
  EXPECT_EQ(test::slurp(folder / "a"), "made again");
  EXPECT_NE(error_of([&] { write_file(folder / "b", "made"); }).find("is kept"), std::string::npos);
  EXPECT_EQ(test::slurp(folder / "b"), "somebody's own text");
}

TEST(NameLock, IsHeldByOneAtATimeAndLeavesNothing) {
  const test::TemporaryFolder folder;
  {
    const NameLock first(folder / "seal.json");
    EXPECT_NE(error_of([&] {
                const NameLock second(folder / "seal.json");
              }).find("another process is writing this file"),
              std::string::npos);
    EXPECT_NO_THROW(NameLock(folder / "other.json"));
  }
  EXPECT_NO_THROW(NameLock(folder / "seal.json"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(FolderLock, RemovesTemporariesOfEndedProcessesAlone) {
  using namespace std::chrono_literals;
  const test::TemporaryFolder folder;
  const std::string stale = "report.json.tmp01234567890123456789",
                    fresh = "a.tmp11234567890123456789";
  for (const std::string& name : {stale, fresh, std::string("mine.tmp1")}) {
    write_file(folder / name, "x");
    if (name != fresh) fs::last_write_time(folder / name, fs::file_time_type::clock::now() - 1h);
  }
  const FolderLock lock(folder.path());
  EXPECT_FALSE(fs::exists(folder / stale));
  EXPECT_TRUE(fs::exists(folder / fresh));
  EXPECT_TRUE(fs::exists(folder / "mine.tmp1"));
}

/// Known at the start, not after an hour's work. Root may write everywhere: this process is nobody.
TEST(FolderLock, RefusesAFolderThatMayNotBeWritten) {
  const test::TemporaryFolder folder;
  ::chmod(folder.path().c_str(), 0555);
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && ::seteuid(kNobody) != 0) ::_exit(2);
    const bool told =
        error_of([&] {
          const FolderLock lock(folder.path());
        }).find("cannot write in this folder: Permission denied") != std::string::npos;
    ::_exit(told ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  ::chmod(folder.path().c_str(), 0755);
}

}  // namespace
}  // namespace dcnn
