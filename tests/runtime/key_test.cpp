// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "dcnn/core/file.h"
#include "dcnn/runtime/packet.h"
#include "support/faults.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

/// A key file with these bytes and this mode.
std::filesystem::path key_with(const test::TemporaryFolder& folder, const std::string& bytes,
                               mode_t mode = 0600) {
  const auto path = folder / "key";
  write_file(path, bytes);
  ::chmod(path.c_str(), mode);
  return path;
}

std::string refusal(const std::filesystem::path& path) {
  try {
    read_packet_key(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage);
    return error.what();
  }
  return "";
}

bool holds(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(PacketKeyFile, APipeIsRefusedAndNotWaitedFor) {
  const test::TemporaryFolder folder;
  const auto pipe = folder / "key";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ::alarm(60);  // the end of a test that waits
  EXPECT_TRUE(holds(refusal(pipe), "exactly 32 bytes"));
  ::alarm(0);
}

TEST(PacketKeyFile, IsReadAsItWasMade) {
  const test::TemporaryFolder folder;
  const auto path = folder / "made";
  make_packet_key(path);
  const PacketKey key = read_packet_key(path);
  const std::string bytes = test::slurp(path);
  EXPECT_EQ(std::string(key.begin(), key.end()), bytes);
  EXPECT_NE(key, PacketKey{});
  struct stat about {};
  ASSERT_EQ(::stat(path.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0600U);
  make_packet_key(folder / "other");
  EXPECT_NE(read_packet_key(folder / "other"), key);
}

/// A process whose standard input is closed gets the number 0 for the file.
TEST(PacketKeyFile, IsMadeAndReadByTheLowestDescriptor) {
  const test::TemporaryFolder folder;
  const int kept = ::dup(STDIN_FILENO);
  ::close(STDIN_FILENO);
  make_packet_key(folder / "key");
  const PacketKey key = read_packet_key(folder / "key");
  if (kept >= 0) {
    ::dup2(kept, STDIN_FILENO);
    ::close(kept);
  }
  EXPECT_EQ(std::string(key.begin(), key.end()), test::slurp(folder / "key"));
}

TEST(PacketKeyFile, IsNeverReplaced) {
  const test::TemporaryFolder folder;
  const auto path = key_with(folder, "precious");
  try {
    make_packet_key(path);
    ADD_FAILURE() << "replaced";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage);
    EXPECT_TRUE(holds(error.what(), "File exists")) << error.what();
  }
  EXPECT_EQ(test::slurp(path), "precious");
  try {
    make_packet_key(folder / "absent/key");
    ADD_FAILURE() << "made";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kFailure);
  }
}

TEST(PacketKeyFile, HasThirtyTwoBytesThatItsOwnerAloneCanReadOrChange) {
  const test::TemporaryFolder folder;
  const std::string right(32, 'k');
  EXPECT_EQ(refusal(key_with(folder, right)), "");
  EXPECT_EQ(refusal(key_with(folder, right, 0400)), "");
  for (const std::size_t size : {0, 31, 33, 64}) {
    EXPECT_TRUE(holds(refusal(key_with(folder, std::string(size, 'k'))), "exactly 32 bytes"))
        << size;
  }
  for (const mode_t mode : {0640, 0620, 0610, 0604, 0602, 0601}) {
    EXPECT_TRUE(holds(refusal(key_with(folder, right, mode)), "others may read or change")) << mode;
  }
  EXPECT_TRUE(holds(refusal(folder / "absent"), "No such file"));
  EXPECT_TRUE(holds(refusal(folder.path()), "exactly 32 bytes"));
  std::filesystem::create_symlink(key_with(folder, right), folder / "link");
  EXPECT_TRUE(holds(refusal(folder / "link"), "cannot open the key"));
}

/// What this program does in a process of its own, where one of its calls may fail.
TEST(DISABLED_KeyInAProcess, IsMadeAndRead) {
  const std::filesystem::path path = std::getenv("DO_PATH");
  std::string text = "whole";
  try {
    make_packet_key(path);
    read_packet_key(path);
  } catch (const Error& error) {
    text = error.what();
  }
  std::cout << "\n<" << text << ">" << std::endl;
  ::_exit(0);
}

TEST(PacketKeyFile, AFaultOfAnyCallIsSaidAndNoHalfKeyStays) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  const test::TemporaryFolder folder;
  const auto path = folder / "key", mark = folder / "mark";
  int faults = 0;
  for (const char* call : {"open", "read", "write", "fsync"}) {
    for (int place = 1; place < 9; ++place) {
      for (const int error : test::errors_of_calls().at(call)) {
        std::filesystem::remove(path);
        std::filesystem::remove(mark);
        auto environment = test::fault_environment(call, place, error, mark);
        environment.push_back("DO_PATH=" + path.string());
        const auto result = test::Process(test::Program{"/proc/self/exe"},
                                          {"--gtest_also_run_disabled_tests",
                                           "--gtest_filter=DISABLED_KeyInAProcess.*"},
                                          {.environment = environment})
                                .wait();
        if (!std::filesystem::exists(mark)) continue;
        const std::string fault = test::words_of_fault(call, place, error) + ": " + result.out;
        if (error == EINTR || error == test::kOneByte) {
          EXPECT_TRUE(holds(result.out, "<whole>")) << fault;
        } else {
          EXPECT_TRUE(holds(result.out, std::strerror(error))) << fault;
          EXPECT_TRUE(holds(result.out, path.string())) << fault;
        }
        if (std::filesystem::exists(path)) {
          EXPECT_EQ(std::filesystem::file_size(path), 32U) << fault;
        }
        ++faults;
      }
    }
  }
  EXPECT_GT(faults, 10);
}

}  // namespace
}  // namespace dcnn
