// SPDX-License-Identifier: Apache-2.0
// Every system call of a command fails once: the previous result is intact and one line says why,
// or the result is right. By default each call fails with one of its errors; DCNN_ALL_FAULTS=1
// tries all of them.
#include "support/faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cli/run_bench.h"
#include "dcnn/core/file.h"
#include "dcnn/runtime/udp.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

/// A command and the results by which it is judged.
struct Command {
  const char* verb;
  std::vector<std::string> arguments;  ///< "@x" is x in the test's folder
  std::vector<std::string> results;    ///< whose bytes depend on the input alone
  const char* input = nullptr;  ///< for standard input; standard output then is a result, too
};

/// A recording of 8 s at 20 Hz: a point mass of 0.7 kg, turned and hardly accelerated. The
/// simulator below has 0.65 kg, so that a diagnosis finds something, and that soon.
std::string short_log() {
  constexpr double kWeight = 0.7 * 9.80665;
  std::ostringstream text;
  text.precision(9);
  text << "t,x,y,z,alpha,beta,gamma,fx,fy,fz\n";
  for (int i = 0; i < 160; ++i) {
    const double t = 0.05 * i, b = 0.6 * std::sin(1.1 * t), c = 3.0 + 0.5 * std::sin(0.9 * t);
    const auto noise = [t](double shift) {
      return 0.01 * std::sin(1000.0 * std::pow(t + shift, 2));
    };
    text << t << "," << 0.001 * std::sin(0.8 * t) << "," << 0.001 * std::sin(1.7 * t) << ","
         << 0.001 * std::cos(t) << "," << 0.5 * std::sin(0.7 * t) << "," << b << "," << c << ","
         << kWeight * std::sin(b) + noise(0.0) << ","
         << -kWeight * std::cos(b) * std::sin(c) + noise(1.0) << ","
         << -kWeight * std::cos(b) * std::cos(c) + noise(2.0) << "\n";
  }
  return text.str();
}

/// Another program's: semicolons, milliseconds, degrees.
std::string foreign_log() {
  std::ostringstream text;
  text << "Time [ms];Fx [N];Fy [N];Fz [N];X [mm];Y [mm];Z [mm];A [deg];B [deg];C [deg]\n";
  for (int i = 0; i < 200; ++i) {
    const double t = 0.02 * i;
    text << 20 * i << ";" << std::sin(t) << ";0.5;-7;" << 100 * std::sin(t) << ";0;300;"
         << 30 * std::sin(0.7 * t) << ";" << 20 * std::cos(t) << ";170\n";
  }
  return text.str();
}

class Faults : public ::testing::TestWithParam<Command> {
 protected:
  Faults() {
    write_file(folder_ / "a.csv", short_log());
    write_file(folder_ / "log.txt", foreign_log());
    write_file(folder_ / "sim.json", R"({"tool": {"mass_kg": 0.65}})");
  }

  std::vector<std::string> arguments() const {
    std::vector<std::string> placed;
    for (const auto& word : GetParam().arguments) {
      placed.push_back(word.starts_with("@") ? (folder_ / word.substr(1)).string() : word);
    }
    return placed;
  }

  test::Result command(std::vector<std::string> environment = {},
                       std::vector<std::string> wrapper = {}) const {
    const char* input = GetParam().input;
    return test::run(GetParam().verb, arguments(),
                     {.input = input ? (folder_ / input).string() : "",
                      .environment = std::move(environment),
                      .wrapper = std::move(wrapper)});
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
    const auto result = command(test::fault_environment(call, place, error, mark));
    if (!std::filesystem::exists(mark)) return false;
    const std::string fault = test::words_of_fault(call, place, error);
    judge(result, fault);
    return true;
  }

  /// All of them new, or, where the command has failed, all as they were.
  void judge_results(const test::Result& result, const std::string& fault) {
    const auto now = results();
    const auto all = [&](const auto& is) { return std::all_of(now.begin(), now.end(), is); };
    const bool all_new =
        all([&](const auto& file) { return file.second == right_.at(file.first); });
    const bool all_old = all([](const auto& file) { return file.second == "the result before\n"; });
    std::string words;
    for (const auto& [name, bytes] : now) {
      words += " " + name +
               (bytes == right_.at(name)         ? " is new,"
                : bytes == "the result before\n" ? " is old,"
                                                 : " is neither,");
    }
    EXPECT_TRUE(all_new || (result.exit_code != 0 && all_old))
        << fault << ":" << words << " exit " << result.exit_code << "\n"
        << result.err;
  }

  void judge(const test::Result& result, const std::string& fault) {
    judge_results(result, fault);
    if (GetParam().input) {
      EXPECT_TRUE(result.exit_code == 0 ? result.out == printed_ : printed_.starts_with(result.out))
          << fault << ": other rows; exit " << result.exit_code << "\n"
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
    std::vector<std::filesystem::path> aside;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename();
      if (name.find(".tmp") != name.npos || name.starts_with(".dcnn-set")) {
        aside.push_back(entry.path());
      }
    }
    // What cannot be removed stays, for this once.
    const bool stays = fault.starts_with("unlink");
    for (const auto& path : aside) {
      EXPECT_TRUE(stays) << fault << " leaves " << path;
      std::filesystem::remove_all(path);
    }
    ++faults_;
  }

  test::TemporaryFolder folder_;
  std::map<std::string, std::string> right_;
  std::string printed_;
  int faults_ = 0;
};

TEST_P(Faults, LeaveThePreviousResultAndOneLineOrTheRightResult) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  const auto plain = command();
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  right_ = results();
  printed_ = plain.out;
  const bool all = std::getenv("DCNN_ALL_FAULTS") != nullptr;
  constexpr int kMostPlaces = 200;
  for (const auto& [call, errors] : test::errors_of_calls()) {
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

/// The next command in the folder finishes or undoes what it finds.
TEST_P(Faults, OfTheProcessItselfLeaveAllOldOrAllNew) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  if (GetParam().results.size() < 2) GTEST_SKIP() << "one file";
  ASSERT_EQ(command().exit_code, 0);
  right_ = results();
  const auto folder = (folder_ / GetParam().results.front()).parent_path();
  int kills = 0;
  for (const char* call : {"write", "fsync", "link", "rename", "unlink", "mkdir"}) {
    for (int place = 1;; ++place) {
      const auto mark = folder_ / "mark";
      std::filesystem::remove(mark);
      for (const auto& name : GetParam().results) write_file(folder_ / name, "the result before\n");
      const auto result = command(test::fault_environment(call, place, test::kKill, mark));
      if (!std::filesystem::exists(mark)) break;
      { const FolderLock next(folder); }
      judge_results(result, test::words_of_fault(call, place, test::kKill));
      ++kills;
    }
  }
  EXPECT_GT(kills, 10);
}

/// 1 GB is enough for what is small; 36 MB are for nothing, and that is one line, too. (Where the
/// loader just fits, nothing is left to throw with before main.)
TEST_P(Faults, OfMemoryAreOneLine) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer needs more";
  for (const char* most : {"--as=36000000", "--as=60000000", "--as=100000000"}) {
    for (const auto& name : GetParam().results) write_file(folder_ / name, "the result before\n");
    const auto result = command({"OMP_NUM_THREADS=1"}, {"prlimit", most});
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
    {"import", {"@log.txt", "--out", "@imp", "--force", "-q"}, {"imp/log.csv", "imp/import.json"}},
    {"run", {"--model", "@sim.json", "--contact", "0.5", "--stdin", "-q"}, {}, "a.csv"},
};
INSTANTIATE_TEST_SUITE_P(Of, Faults, ::testing::ValuesIn(kCommands),
                         [](const auto& entry) { return std::string(entry.param.verb); });

/// dcnn-run at the network, where one call of a socket fails: at the start one line; later one
/// answer at most is missing.
class SocketFaults : public ::testing::Test {
 protected:
  SocketFaults() { make_packet_key(key_); }

  /// Samples without an answer of a server whose 8th CALL fails; the rest in `result`. A server
  /// that finds the next sample waiting does not poll, so that the number of samples until then is
  /// not fixed.
  Index unanswered(const char* call, int error, test::Result& result) const {
    const auto [server, robot] = test::free_ports();
    const test::Process process(
        "run",
        {"--model", test::bench().simulator, "--contact", "0.5", "-q", "--listen", server, "--peer",
         robot, "--key-file", key_, "--late", "1000", "--seconds", "20"},
        {.environment = test::fault_environment(call, 8, error, mark_)});
    RobotLink link(robot, server, read_packet_key(key_));
    Index end_of_samples = kSamples;
    Index answers = 0;
    if (link.connect(2.0)) {
      const Recording recording = test::free_motion(kMostSamples);
      for (Index k = 0; k < end_of_samples; ++k) {
        const auto asked = link.send(test::sample_of(recording, k));
        const double end = monotonic_seconds() + 1.0;
        while (const auto wire = link.receive(end)) {
          if (wire->answers != asked || wire->result.t != 0.002 * double(k)) continue;
          ++answers;
          break;
        }
        if (!std::filesystem::exists(mark_)) {
          end_of_samples = std::min(std::max(end_of_samples, k + kSamples), kMostSamples);
        }
      }
      process.signal(SIGTERM);
    }
    result = process.wait();
    return end_of_samples - answers;
  }

  static constexpr Index kSamples = 20;  // at least, and after the fault
  static constexpr Index kMostSamples = 500;
  test::TemporaryFolder folder_;
  const std::string mark_ = folder_ / "mark";
  const std::string key_ = folder_ / "key";
};

TEST_F(SocketFaults, AtTheStartAreOneLine) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  for (const char* call : {"socket", "bind", "connect"}) {
    for (const int error : test::errors_of_calls().at(call)) {
      const auto [server, robot] = test::free_ports();
      const auto result =
          test::run("run",
                    {"--model", test::bench().simulator, "--contact", "0.5", "-q", "--listen",
                     server, "--peer", robot, "--key-file", key_, "--seconds", "0.1"},
                    {.environment = test::fault_environment(call, 1, error, mark_)});
      const std::string fault = test::words_of_fault(call, 1, error) + ": " + result.err;
      EXPECT_EQ(result.exit_code, 1) << fault;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << fault;
      EXPECT_NE(result.err.find(std::strerror(error)), std::string::npos) << fault;
    }
  }
}

TEST_F(SocketFaults, LaterCostOneAnswerAtMost) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer must be loaded first";
  for (const char* call : {"recv", "send", "ppoll"}) {
    for (const int error : test::errors_of_calls().at(call)) {
      std::filesystem::remove(mark_);
      test::Result result;
      const Index lost = unanswered(call, error, result);
      const std::string fault = test::words_of_fault(call, 8, error) + ": " + result.err;
      EXPECT_TRUE(std::filesystem::exists(mark_)) << fault;
      EXPECT_LE(lost, 1) << fault;
      EXPECT_EQ(result.exit_code, 128 + SIGTERM) << fault;
    }
  }
}

}  // namespace
}  // namespace dcnn
