// SPDX-License-Identifier: Apache-2.0
// dcnn-sweep as users, schedulers and misfortunes run it.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "dcnn/core/file.h"
#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::Process;
using test::run;
using test::slurp;

constexpr const char* kSweep = R"({
  "commands": [["bash", "-c", "sleep 0.0{seed}; echo {seed} {model} | tee out/r; head -c 20000 /dev/zero >> out/r"]],
  "grid": {"model": ["a", "b", "c"], "seed": {"from": 1, "count": 9}}})";
constexpr int kCells = 27;

class Sweep : public testing::Test {
 protected:
  Sweep() {
    write_file(at("s.json"), kSweep);
    const auto planned = run("sweep", {at("s.json"), "--plan", at("plain"), "--jobs", "4",
                                       "--merge", at("plain.jsonl")});
    EXPECT_EQ(planned.exit_code, 0) << planned.err;
    wanted_ = slurp(at("plain.jsonl"));
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void plan(const std::string& name) const {
    ASSERT_EQ(run("sweep", {at("s.json"), "--plan", at(name)}).exit_code, 0);
  }
  std::string merged(const std::string& name) const {
    const auto result = run("sweep", {"--plan", at(name), "--merge", at(name + ".jsonl")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return slurp(at(name + ".jsonl"));
  }

  test::TemporaryFolder folder_;
  std::string wanted_;
};

TEST_F(Sweep, AsksForOneDocument) {
  const auto document = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--plan", at("told"), "--json", "-q"});
    const auto result = run("sweep", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out, "sweep", Exit::kFailure);
  };
  EXPECT_EQ(document({at("s.json")})["cells"], kCells);
  EXPECT_EQ(document({"--jobs", "4"})["done"], kCells);
  EXPECT_EQ(document({"--merge", at("told.jsonl")})["left"], 0);
  const Json projection = document({"--project", "100/10"})["projection"];
  EXPECT_EQ(projection["wall_time"]["measured"], kCells);
  EXPECT_EQ(run("sweep", {"--plan", at("told"), "--emit", "slurm", "--json"}).exit_code, 2);
}

TEST_F(Sweep, KilledAtRandomGivesTheBytesOfAPlainRun) {
  plan("killed");
  std::mt19937 random(1);                      // the kills, not the results, depend on it
  const std::string scratch = folder_.path();  // in which a killed worker leaves its folder
  for (int k = 0; k < 20; ++k) {
    const std::vector<std::string> share{"-q",
                                         "--plan",
                                         at("killed"),
                                         "--scratch",
                                         scratch,
                                         "--shard",
                                         std::to_string(1 + k % 2) + "/2"};
    const Process worker("sweep", share);
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 250));
    const int signals[] = {SIGKILL, SIGTERM, SIGUSR1};
    const int signal = signals[k % 3];
    worker.signal(signal);
    const int code = worker.wait().exit_code;
    // Before it looks at signals, and before main, a signal ends it as any program.
    EXPECT_TRUE(code == 0 || code == 75 || code == 128 + signal) << code;
  }
  ASSERT_EQ(run("sweep", {"-q", "--plan", at("killed"), "--jobs", "3"}).exit_code, 0);
  EXPECT_EQ(merged("killed"), wanted_);
}

TEST_F(Sweep, AskedToStopEndsWith75AndKeepsWhatIsFinished) {
  plan("stopped");
  const Process worker("sweep", {"--plan", at("stopped"), "--jobs", "1"});
  const auto done = [&] {
    const auto status = run("sweep", {"--plan", at("stopped"), "--status", "--json"});
    return Json::parse(status.out)["done"].get<int>();
  };
  for (int k = 0; k < 200 && done() < 3; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  worker.signal(SIGUSR1);
  const auto result = worker.wait();
  EXPECT_EQ(result.exit_code, 75);
  EXPECT_NE(result.err.find("the same command goes on"), std::string::npos) << result.err;
  const int kept = done();
  EXPECT_GE(kept, 3);
  EXPECT_LT(kept, kCells);
  const auto rest = run("sweep", {"--plan", at("stopped"), "--jobs", "4"});
  EXPECT_NE(rest.err.find(std::to_string(kCells - kept) + " cells done, " + std::to_string(kept) +
                          " skipped"),
            std::string::npos)
      << rest.err;
  EXPECT_EQ(merged("stopped"), wanted_);
}

TEST_F(Sweep, OnADiskThatIsFullEndsWithOneLineAndGoesOnElsewhere) {
  plan("full");
  const auto full =
      run("sweep", {"-q", "--plan", at("full"), "--jobs", "2"},
          {.wrapper = {"bash", "-c", "ulimit -f 60; trap '' XFSZ; exec \"$@\"", "-"}});
  EXPECT_EQ(full.exit_code, 1) << full.err;
  EXPECT_NE(full.err.find("cannot write: File too large"), std::string::npos) << full.err;
  ASSERT_EQ(run("sweep", {"-q", "--plan", at("full"), "--jobs", "2"}).exit_code, 0);
  EXPECT_EQ(merged("full"), wanted_);
}

TEST_F(Sweep, MergedTwiceAtOnceGivesOneWholeTable) {
  const std::vector<std::string> merge{"--plan",          at("plain"), "--merge",
                                       at("twice.jsonl"), "--unpack",  at("files")};
  const Process one("sweep", merge), two("sweep", merge);
  EXPECT_EQ(one.wait().exit_code, 0);
  EXPECT_EQ(two.wait().exit_code, 0);
  EXPECT_EQ(slurp(at("twice.jsonl")), wanted_);
  EXPECT_EQ(slurp(at("files/model=b,seed=4/stdout")), "4 b\n");
}

TEST_F(Sweep, TellsWhatIsMissingFailedOrInTheWay) {
  plan("partial");
  ASSERT_EQ(run("sweep", {"-q", "--plan", at("partial"), "--limit", "5", "--jobs", "2"}).exit_code,
            0);
  const auto missing = run("sweep", {"--plan", at("partial"), "--merge", at("m.jsonl")});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("22 cells have no result"), std::string::npos) << missing.err;
  EXPECT_EQ(
      run("sweep", {"--plan", at("partial"), "--merge", at("m.jsonl"), "--partial"}).exit_code, 1);
  EXPECT_EQ(std::ranges::count(slurp(at("m.jsonl")), '\n'), 6);
  write_file(at("precious"), "precious\n");
  EXPECT_EQ(run("sweep", {"--plan", at("plain"), "--merge", at("precious")}).exit_code, 2);
  EXPECT_EQ(slurp(at("precious")), "precious\n");
  for (const char* shard : {"0/2", "3/2", "1", "1/2x"}) {
    EXPECT_EQ(run("sweep", {"--plan", at("plain"), "--shard", shard}).exit_code, 2) << shard;
  }
  const auto nowhere = run("sweep", {"--plan", at("nowhere"), "--jobs", "1"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_NE(nowhere.err.find("holds no plan"), std::string::npos) << nowhere.err;
  const auto nothing = run("sweep", {"--plan", at("plain")});
  EXPECT_EQ(nothing.exit_code, 2) << nothing.out;
}

TEST_F(Sweep, LinesForGnuParallelRunInAnyShell) {
  plan("lines");
  const auto lines = run("sweep", {"--plan", at("lines"), "--emit", "parallel", "--tasks", "4",
                                   "--cell-seconds", "1"});
  ASSERT_EQ(lines.exit_code, 0) << lines.err;
  write_file(at("lines.sh"), lines.out);
  ASSERT_EQ(std::system(("sh -e " + at("lines.sh")).c_str()), 0);
  EXPECT_EQ(merged("lines"), wanted_);
  // The script of a job array, its environment as Slurm sets it.
  plan("array");
  const auto script = run(
      "sweep", {"--plan", at("array"), "--emit", "slurm", "--tasks", "3", "--cell-seconds", "1"});
  write_file(at("job.sh"), script.out);
  for (const char* task : {"2", "3", "1"}) {
    ASSERT_EQ(
        std::system(("SLURM_ARRAY_TASK_ID=" + std::string(task) + " bash " + at("job.sh")).c_str()),
        0);
  }
  EXPECT_EQ(merged("array"), wanted_);
}

}  // namespace
}  // namespace dcnn
