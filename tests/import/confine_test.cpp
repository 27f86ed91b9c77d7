// SPDX-License-Identifier: Apache-2.0
// What a library may do in the process that reads a file with it.
#include "import/confine.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "dcnn/core/error.h"
#include "support/process.h"

namespace dcnn {
namespace {

/// What `work` sends from its confinement.
std::string sent(const ConfinedWork& work) {
  std::string all;
  run_confined(
      work, [&](std::string_view bytes) { all += bytes; }, "a.mat");
  return all;
}

// A file may not grow there, and what a library says on stderr must not end it.
TEST(Confined, AWordOnAStderrThatIsAFileEndsNothing) {
  const test::TemporaryFolder folder;
  const int before = ::dup(STDERR_FILENO);
  const int file = ::open((folder / "err").c_str(), O_WRONLY | O_CREAT, 0600);
  ::dup2(file, STDERR_FILENO);
  std::string bytes;
  try {
    bytes = sent([](const auto& seal, const auto& send) {
      seal();
      const ssize_t put = ::write(STDERR_FILENO, "warning", 7);
      send(put < 0 ? "nothing written" : "written");
    });
  } catch (const Error& error) {
    bytes = error.what();
  }
  ::dup2(before, STDERR_FILENO);
  ::close(before);
  ::close(file);
  EXPECT_EQ(bytes, "nothing written");
}

TEST(Confined, OpensNothingOnceSealedAndMakesNoFile) {
  const test::TemporaryFolder folder;
  const std::string made = folder / "made", source = DCNN_SOURCE_DIR "/LICENSE";
  EXPECT_EQ(sent([&](const auto& seal, const auto& send) {
              send(::open(made.c_str(), O_WRONLY | O_CREAT, 0600) < 0 ? "no " : "yes ");
              send(::open(source.c_str(), O_RDONLY) < 0 ? "no " : "yes ");
              seal();
              send(::open(source.c_str(), O_RDONLY) < 0 ? "no" : "yes");
            }),
            "no yes no");
}

TEST(Confined, AnErrorComesBackAndADeathIsAnError) {
  const auto error_of = [](const ConfinedWork& work) {
    try {
      sent(work);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error_of([](const auto&, const auto&) { fail(Exit::kData, "no such variable"); }),
            "a.mat: no such variable");
  EXPECT_NE(error_of([](const auto&, const auto&) { ::_exit(7); }).find("(exit 7)"),
            std::string::npos);
}

}  // namespace
}  // namespace dcnn
