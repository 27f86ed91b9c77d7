// SPDX-License-Identifier: Apache-2.0
// dcnn-run while its peer's address sends packets under a wrong key: none of them is acted on.
#include <gtest/gtest.h>

#include "cli/run_bench.h"
#include "dcnn/core/json.h"

namespace dcnn {
namespace {

TEST(Flood, OfAWrongKeyChangesNoAnswer) {
  const test::TemporaryFolder folder;
  const auto key = (folder / "key").string();
  ASSERT_EQ(test::run("run", {"--make-key", key}).exit_code, 0);
  const auto [server, robot] = test::free_ports();
  const test::Process process(
      "run", {"--model", DCNN_SOURCE_DIR "/data/sample/sim.json", "--contact", "0.5", "--late",
              "1000", "-q", "--json", "--listen", server, "--peer", robot, "--key-file", key});
  const auto sent =
      test::Process(test::Program{DCNN_FLOOD}, {server, robot, key, "1", "20000"}).wait();
  process.signal(SIGTERM);
  const auto done = process.wait();
  ASSERT_EQ(sent.exit_code, 0) << sent.err;
  const Json told = Json::parse(sent.out), report = Json::parse(done.out);
  EXPECT_GT(told["flood"].get<int>(), 1000);
  EXPECT_GT(report["packets"]["tag"].get<int>(), 1000) << report.dump();
  EXPECT_EQ(told["wrong"], 0);
  EXPECT_EQ(report["packets"]["hello"].get<int>() >= 1, true);
  // Every sample that dcnn-run took is one of the robot's, each once; time is no matter here.
  EXPECT_LE(report["packets"]["accepted"].get<int>(), told["samples"].get<int>());
  EXPECT_GT(report["packets"]["accepted"].get<int>(), told["samples"].get<int>() / 2);
  for (const char* none : {"replay", "session", "lead", "length", "format", "value"}) {
    EXPECT_EQ(report["packets"][none], 0) << none;
  }
}

}  // namespace
}  // namespace dcnn
