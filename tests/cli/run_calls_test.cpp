// SPDX-License-Identifier: Apache-2.0
// What dcnn-run does after start-up: it waits, receives, sends and reads the clock; nothing else.
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "cli/run_bench.h"
#include "dcnn/runtime/udp.h"
#include "runtime/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::bench;
using test::kSanitized;
using test::run;
using test::Surroundings;

constexpr long kSamples = 400;

/// Which model serves, and whether over UDP or line by line.
struct Service {
  std::string model;
  bool udp = false;
  bool plot = false;  ///< with a thread that sends every cycle to a plotting program
};

void PrintTo(const Service& service, std::ostream* out) {
  *out << service.model << (service.udp ? " over UDP" : " line by line")
       << (service.plot ? " with plots" : "");
}

/// Sends samples and waits for each answer.
void drive(RobotLink& link) {
  ASSERT_TRUE(link.connect(60.0));
  const Recording recording = test::free_motion(kSamples);
  for (Index k = 0; k < kSamples; ++k) {
    const auto sequence = link.send(test::sample_of(recording, k));
    const double patience = monotonic_seconds() + 10.0;
    bool answered = false;
    while (!answered) {
      const auto result = link.receive(patience);
      ASSERT_TRUE(result) << "no answer to sample " << k;
      answered = result->answers == sequence;
    }
  }
}

class RunCalls : public ::testing::TestWithParam<Service> {
 protected:
  test::Result serve(Surroundings around) {
    std::vector<std::string> arguments{"--model",      bench().trained(GetParam().model),
                                       "--fallback",   bench().simulator,
                                       "--average",    "4",
                                       "--track-bias", "10"};
    if (GetParam().plot) arguments.insert(arguments.end(), {"--plot", "59870"});
    if (!GetParam().udp) {
      arguments.emplace_back("--stdin");
      around.input = bench().log;
      return run("run", arguments, around);
    }
    const auto key_file = (bench().folder / "calls.key").string();
    if (!std::filesystem::exists(key_file)) run("run", {"--make-key", key_file});
    const auto [server, robot] = test::free_ports();
    for (const char* word : {"--listen", server.c_str(), "--peer", robot.c_str(), "--key-file",
                             key_file.c_str(), "--late", "1000", "--seconds", "60"}) {
      arguments.emplace_back(word);
    }
    const test::Process process("run", arguments, around);
    RobotLink link(robot, server, read_packet_key(key_file));
    drive(link);
    process.signal(SIGTERM);
    return process.wait();
  }

  static int right_end() { return GetParam().udp ? 128 + SIGTERM : 0; }
};

TEST_P(RunCalls, NoAllocationAndNoLock) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  const auto counts = bench().folder / "counts";
  const std::string last = GetParam().udp ? std::to_string(kSamples - 10) : "1000000";
  const auto result =
      serve({.environment = {"LD_PRELOAD=" DCNN_COUNT_CALLS, "COUNT_FILE=" + counts.string(),
                             "COUNT_FROM=3", "COUNT_TO=" + last}});
  ASSERT_EQ(result.exit_code, right_end()) << result.err;
  std::ifstream file(counts);
  long reads = 0, allocations = -1, locks = -1;
  file >> reads >> allocations >> locks;
  EXPECT_GT(reads, 20);
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

TEST_P(RunCalls, NoSystemCallButThoseOfWaitingReceivingSendingAndTheClock) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer makes calls of its own";
  if (GetParam().plot) GTEST_SKIP() << "the thread that sends makes calls of its own";
  const auto trace = bench().folder / "trace";
  std::filesystem::remove(trace);
  // -D: the program is our child, which a signal reaches, and strace its grandchild.
  const auto result = serve({.wrapper = {"strace", "-D", "-f", "-o", trace.string()}});
  if (result.exit_code != right_end()) GTEST_SKIP() << "strace does not run here";
  const double patience = monotonic_seconds() + 10.0;
  while (!test::slurp(trace).ends_with("+++\n") && monotonic_seconds() < patience) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const std::string receives = GetParam().udp ? " recvfrom(" : " read(0, ";
  std::set<std::string> calls;
  int received = 0;
  std::ifstream file(trace);
  for (std::string line; std::getline(file, line);) {
    const bool input = line.find(receives) != std::string::npos;
    if (input && line.ends_with("= 0") && !GetParam().udp) break;
    received += input;
    if (GetParam().udp && received > kSamples) break;
    const auto begin = line.find_first_not_of("0123456789 ");
    if (received > 3) calls.insert(line.substr(begin, line.find('(') - begin));
  }
  EXPECT_GT(received, 20);
  const std::set<std::string> allowed =
      GetParam().udp ? std::set<std::string>{"recvfrom", "sendto", "ppoll", "clock_gettime"}
                     : std::set<std::string>{"read", "write", "clock_gettime"};
  for (const auto& call : calls) EXPECT_TRUE(allowed.contains(call)) << call;
}

INSTANTIATE_TEST_SUITE_P(, RunCalls,
                         ::testing::Values(Service{"rigid", false}, Service{"rigid", true},
                                           Service{"rigid", true, true}, Service{"dcnn", false},
                                           Service{"dcnn", true}));

}  // namespace
}  // namespace dcnn
