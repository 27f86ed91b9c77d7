// Every system call of a command fails once: the previous result is intact and one line says why,
// or the result is right. By default each call fails with one of its errors; DCNN_ALL_FAULTS=1
// tries all of them.
#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <map>

#include "dcnn/core/file.h"
#include "support/process.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

constexpr int kShort = 0;  // one byte of what was asked

/// Errors that a call can have.
const std::map<std::string, std::vector<int>> kErrors{
    {"open", {EACCES, EMFILE, EIO, EINTR, ENOSPC}},
    {"read", {EIO, EINTR, kShort}},
    {"write", {ENOSPC, EIO, EINTR, kShort}},
    {"fsync", {EIO, EINTR, ENOSPC}},
    {"rename", {EACCES, EIO, ENOSPC}},
    {"flock", {EINTR, ENOLCK}},
    {"mmap", {ENOMEM}}};

/// A command and the results by which it is judged.
struct Command {
  const char* verb;
  std::vector<std::string> arguments;  ///< "@x" is x in the test's folder
  std::vector<std::string> results;    ///< whose bytes depend on the input alone
};

/// A recording of 8 s at 20 Hz.
std::string short_log() {
  std::ostringstream text;
  text.precision(9);
  text << "t,x,y,z,alpha,beta,gamma,fx,fy,fz\n";
  for (int i = 0; i < 160; ++i) {
    const double t = 0.05 * i, b = 0.6 * std::sin(1.1 * t), c = 3.0 + 0.5 * std::sin(0.9 * t);
    const double noise = 0.01 * std::sin(1000.0 * t * t);
    text << t << "," << 0.1 * std::sin(0.8 * t) << "," << 0.1 * std::sin(1.7 * t) << ","
         << 0.1 * std::cos(t) << "," << 0.5 * std::sin(0.7 * t) << "," << b << "," << c << ","
         << 7.0 * std::sin(b) + noise << "," << -7.0 * std::cos(b) * std::sin(c) + noise << ","
         << -7.0 * std::cos(b) * std::cos(c) - noise << "\n";
  }
  return text.str();
}

class Faults : public testing::TestWithParam<Command> {
 protected:
  Faults() {
    write_file(folder_ / "a.csv", short_log());
    write_file(folder_ / "sim.json", R"({"tool": {"mass_kg": 0.7, "com_m": [0, 0, 0.1]}})");
  }

  std::vector<std::string> arguments() const {
    std::vector<std::string> placed;
    for (const auto& word : GetParam().arguments) {
      placed.push_back(word.starts_with("@") ? (folder_ / word.substr(1)).string() : word);
    }
    return placed;
  }

  std::map<std::string, std::string> results() const {
    std::map<std::string, std::string> bytes;
    for (const auto& name : GetParam().results) bytes[name] = test::slurp(folder_ / name);
    return bytes;
  }

  /// Runs with the fault; false where the command makes no such call.
  bool fails_once(const std::string& call, int place, int error) {
    const auto mark = folder_ / "mark";
    std::filesystem::remove(mark);
    for (const auto& name : GetParam().results) write_file(folder_ / name, "the result before\n");
    const auto result = test::run(
        GetParam().verb, arguments(),
        {.environment = {"LD_PRELOAD=" DCNN_FAIL_CALLS, "FAIL_CALL=" + call,
                         "FAIL_AT=" + std::to_string(place), "FAIL_ERRNO=" + std::to_string(error),
                         "FAIL_MARK=" + mark.string(), "OMP_NUM_THREADS=1"}});
    if (!std::filesystem::exists(mark)) return false;
    const std::string fault = call + " number " + std::to_string(place) + ": " +
                              (error == kShort ? "one byte" : std::strerror(error));
    judge(result, fault);
    return true;
  }

  void judge(const test::Result& result, const std::string& fault) {
    for (const auto& [name, bytes] : results()) {
      EXPECT_TRUE(bytes == right_.at(name) ||
                  (result.exit_code != 0 && bytes == "the result before\n"))
          << fault << ": " << name << " is neither the result nor what was there; exit "
          << result.exit_code << "\n"
          << result.err;
    }
    if (result.exit_code != 0) {
      EXPECT_TRUE(result.exit_code >= 1 && result.exit_code <= 4)
          << fault << ": " << result.exit_code << " " << result.err;
      const bool to_stderr =
          fault.starts_with("write") && result.err.empty();  // the line itself could not be written
      EXPECT_TRUE(to_stderr || std::count(result.err.begin(), result.err.end(), '\n') == 1)
          << fault << ": " << result.err;
      EXPECT_EQ(result.err.find("internal error"), std::string::npos)
          << fault << ": " << result.err;
      EXPECT_EQ(result.err.find("Success"), std::string::npos) << fault << ": " << result.err;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos)
          << fault << " leaves " << entry.path();
    }
    ++faults_;
  }

  test::TemporaryFolder folder_;
  std::map<std::string, std::string> right_;
  int faults_ = 0;
};

TEST_P(Faults, LeaveThePreviousResultAndOneLineOrTheRightResult) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  const auto plain = test::run(GetParam().verb, arguments());
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  right_ = results();
  const bool all = std::getenv("DCNN_ALL_FAULTS") != nullptr;
  constexpr int kMostPlaces = 200;
  for (const auto& [call, errors] : kErrors) {
    for (int place = 1; place <= kMostPlaces; ++place) {
      bool made = true;
      for (std::size_t k = 0; k < (all ? errors.size() : 1); ++k) {
        made = fails_once(call, place,
                          errors[(static_cast<std::size_t>(place - 1) + k) % errors.size()]);
      }
      if (!made) break;
    }
  }
  std::printf("%d faults\n", faults_);
  EXPECT_GT(faults_, 10);
}

/// 1 GB is enough for what is small; 40 MB are for nothing, and that is one line, too.
TEST_P(Faults, OfMemoryAreOneLine) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer needs more";
  for (const char* most : {"--as=40000000", "--as=60000000", "--as=100000000"}) {
    for (const auto& name : GetParam().results) write_file(folder_ / name, "the result before\n");
    const auto result =
        test::run(GetParam().verb, arguments(),
                  {.environment = {"OMP_NUM_THREADS=1"}, .wrapper = {"prlimit", most}});
    if (result.exit_code == 0 || result.exit_code == 127)
      continue;  // enough, or too little for the loader
    EXPECT_EQ(result.exit_code, 1) << most << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

const Command kCommands[] = {
    {"predict", {"@sim.json", "--data", "@a.csv", "--out", "@p.csv", "--force", "-q"}, {"p.csv"}},
    {"train",
     {"--train", "@a.csv", "--model", "rigid", "--preset", "quick", "--out", "@m.dcnn", "--force",
      "-q"},
     {"m.dcnn"}},
    {"diagnose",
     {"--sim", "@sim.json", "--fit", "@a.csv", "--out", "@r", "--force", "-q", "--threads", "1"},
     {"r/report.json", "r/model.json"}},
    {"conceal",
     {"--inject", "bias", "--motion", "@a.csv", "--sim", "@sim.json", "--out", "@set", "--seal",
      "@seal.json", "--force", "-q"},
     {"set/a.csv", "seal.json"}},
};
INSTANTIATE_TEST_SUITE_P(Of, Faults, testing::ValuesIn(kCommands),
                         [](const auto& entry) { return std::string(entry.param.verb); });

}  // namespace
}  // namespace dcnn
