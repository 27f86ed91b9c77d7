// SPDX-License-Identifier: Apache-2.0
// dcnn-run as a user and as an attacker run it.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include "cli/run_bench.h"
#include "dcnn/core/json.h"
#include "dcnn/core/random.h"
#include "dcnn/runtime/udp.h"
#include "runtime/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::bench;
using test::free_ports;
using test::kSanitized;
using test::run;
using testing::contains;

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(RunTool, LinesInLinesOut) {
  const auto result =
      run("run", {"--model", bench().trained("rigid"), "--fallback", bench().simulator, "--stdin"},
          {.input = bench().log});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 6001U);
  EXPECT_EQ(lines[0], "t,fx_ext,fy_ext,fz_ext,state,reason,contact");
  EXPECT_TRUE(contains(lines[1], ",WARMUP,")) << lines[1];
  std::istringstream row(lines[3000]);
  double t, f[3];
  char comma;
  row >> t >> comma >> f[0] >> comma >> f[1] >> comma >> f[2];
  EXPECT_NEAR(t, 2999 * 0.002, 1e-9);
  for (const double force : f) EXPECT_LT(std::abs(force), 0.3) << lines[3000];
  EXPECT_TRUE(lines[3000].ends_with(",NETWORK,none,0")) << lines[3000];
}

/// The same log in millimetres and degrees, of the reaction, is answered alike.
TEST(RunTool, LinesMayBeInOtherUnits) {
  Table table = read_csv(bench().log);
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    const std::string& name = table.columns[j];
    auto column = table.values.col(static_cast<Index>(j));
    if (name == "x" || name == "y" || name == "z") column *= 1e3;
    if (name == "alpha" || name == "beta" || name == "gamma") column *= 180.0 / std::numbers::pi;
    if (name == "fx" || name == "fy" || name == "fz") column *= -1.0;
  }
  const auto input = (bench().folder / "units.csv").string();
  write_csv(input, table);
  const std::vector<std::string> plain{"--model", bench().simulator, "--stdin"};
  auto other = plain;
  for (const char* word : {"--position-unit", "mm", "--angle-unit", "deg", "--force-sign", "-1"}) {
    other.emplace_back(word);
  }
  const auto wanted = lines_of(run("run", plain, {.input = bench().log}).out);
  const auto told = lines_of(run("run", other, {.input = input}).out);
  ASSERT_EQ(told.size(), wanted.size());
  for (std::size_t k = 1000; k < wanted.size(); k += 1000) {
    double a[4], b[4];
    for (const auto& [line, numbers] : {std::pair{wanted[k], a}, std::pair{told[k], b}}) {
      ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", numbers, numbers + 1, numbers + 2,
                            numbers + 3),
                4);
    }
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], 1e-9) << wanted[k] << " " << told[k];
  }
}

TEST(RunTool, ALineThatIsNoSampleIsABadCycleAndNotTheEnd) {
  std::string text = test::slurp(bench().log);
  auto lines = lines_of(text);
  lines.resize(300);
  lines[200] = "hello";
  lines[201] = std::string(40000, '7');
  lines[202] = std::string(40, ',');
  std::string changed;
  for (const auto& line : lines) changed += line + "\n";
  const auto input = testing::temporary_file("bad.csv", changed);
  const auto result =
      run("run", {"--model", bench().trained("rigid"), "--fallback", bench().simulator, "--stdin"},
          {.input = input.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto out = lines_of(result.out);
  ASSERT_EQ(out.size(), 300U);
  for (std::size_t k = 200; k < 203; ++k) {
    EXPECT_TRUE(contains(out[k], ",HOLD,not_finite,")) << out[k];
  }
  EXPECT_TRUE(contains(out[250], ",NETWORK,")) << out[250];
}

TEST(RunTool, WrongUseIsOneLine) {
  const auto code = [](std::vector<std::string> arguments, const test::Surroundings& around = {}) {
    const auto result = run("run", std::move(arguments), around);
    EXPECT_EQ(lines_of(result.err).size(), 1U) << result.err;
    return result.exit_code;
  };
  const auto empty = testing::temporary_file("empty.csv", "");
  const auto foreign = testing::temporary_file("foreign.csv", "a,b\n1,2\n");
  EXPECT_EQ(code({}), 2);
  EXPECT_EQ(code({"--model", bench().trained("rigid")}), 2);
  EXPECT_EQ(code({"--model", "absent.dcnn", "--stdin"}), 4);
  EXPECT_EQ(code({"--model", "absent.json", "--stdin"}), 3);
  EXPECT_EQ(code({"--model", bench().trained("rigid"), "-q", "--stdin"}, {.input = empty.string()}),
            3);
  EXPECT_EQ(
      code({"--model", bench().trained("rigid"), "-q", "--stdin"}, {.input = foreign.string()}), 3);
  EXPECT_EQ(code({"--model", bench().trained("rigid"), "--listen", "5000"}), 2);
  const auto key = bench().folder / "code.key";
  EXPECT_EQ(run("run", {"--make-key", key.string()}).exit_code, 0);
  EXPECT_EQ(code({"--make-key", key.string()}), 2);  // never replaced
  const std::vector<std::string> serve{"--model",
                                       bench().trained("rigid"),
                                       "-q",
                                       "--listen",
                                       "127.0.0.1:nine",
                                       "--peer",
                                       "127.0.0.1:9",
                                       "--key-file",
                                       key.string()};
  EXPECT_EQ(code(serve), 2);
  ::chmod(key.c_str(), 0644);
  EXPECT_EQ(code(serve), 2);
  ::chmod(key.c_str(), 0600);
  std::filesystem::resize_file(key, 31);
  EXPECT_EQ(code(serve), 2);
}

TEST(RunTool, AnswersItsPeerAndNobodyElse) {
  const auto key_file = (bench().folder / "udp.key").string();
  ASSERT_EQ(run("run", {"--make-key", key_file}).exit_code, 0);
  const auto [server, robot] = free_ports();
  test::Process process(
      "run", {"--model", bench().trained("rigid"), "--fallback", bench().simulator, "--listen",
              server, "--peer", robot, "--key-file", key_file, "--late", "1000", "--json"});
  RobotLink link(robot, server, read_packet_key(key_file));
  ASSERT_TRUE(link.connect(20.0));
  UdpSocket stranger("127.0.0.1:" + std::to_string(19000 + ::getpid() % 1000), server);
  Rng rng(1);
  const Recording recording = test::free_motion(300);
  std::uint64_t served = 0;
  WireResult last;
  for (Index k = 0; k < 300; ++k) {
    for (int flood = 0; flood < 20; ++flood) {
      std::array<std::uint8_t, kSampleBytes> bytes;
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(rng.bits());
      stranger.send(bytes);
    }
    const auto sequence = link.send(test::sample_of(recording, k));
    const double patience = monotonic_seconds() + 10.0;
    while (const auto result = link.receive(patience)) {
      if (result->answers != sequence || result->result.t != 0.002 * static_cast<double>(k))
        continue;
      last = *result;
      ++served;
      break;
    }
  }
  EXPECT_EQ(served, 300U);
  EXPECT_TRUE(last.result.external.allFinite());
  // Silence: the robot is told of every cycle, until the fault.
  RunState state = last.result.state;
  const double end = monotonic_seconds() + 10.0;
  while (state != RunState::kFault) {
    const auto result = link.receive(end);
    if (!result) break;
    state = result->result.state;
  }
  EXPECT_EQ(state, RunState::kFault);
  process.signal(SIGTERM);
  const auto done = process.wait();
  ASSERT_EQ(done.exit_code, 128 + SIGTERM) << done.err;
  EXPECT_NE(("\n" + done.err).find("\nlistening    " + server + " (UDP), for packets of " + robot),
            std::string::npos)
      << done.err;
  const Json report = parse_json(done.out, "report", Exit::kFailure);
  EXPECT_EQ(report["packets"]["accepted"], 300);
  EXPECT_EQ(report["packets"]["tag"], 0);  // the kernel dropped them
}

TEST(RunTool, ARehearsalTellsTimesStatesAndMemory) {
  const auto result =
      run("run", {"--model", bench().trained("rigid"), "--fallback", bench().simulator,
                  "--rehearse", bench().log, "--hours", "0.02", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json report = parse_json(result.out, "report", Exit::kFailure);
  EXPECT_EQ(report["cpu"]["cycles"], 36000);
  EXPECT_GT(report["states"]["NETWORK"].get<int>(), 30000) << report;
  // A sanitizer keeps what was freed for a while.
  if (kSanitized) return;
  EXPECT_LE(report["memory_growth_bytes"].get<double>(), 65536.0);
}

TEST(RunTool, PrintsWordsWhereNoJsonIsAskedFor) {
  const auto result =
      run("run", {"--model", bench().simulator, "--rehearse", bench().log, "--hours", "0.001"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("cycles      ")) << result.out;
  for (const char* words : {" PHYSICS", "time        p50 ", "rehearsed   0.001 h"}) {
    EXPECT_NE(result.out.find(words), std::string::npos) << words << " in\n" << result.out;
  }
}

}  // namespace
}  // namespace dcnn
