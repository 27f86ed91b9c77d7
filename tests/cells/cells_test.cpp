// SPDX-License-Identifier: Apache-2.0
// Plans, packs, runs and merges of cells, with commands of the system.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "dcnn/cells/emit.h"
#include "dcnn/cells/merge.h"
#include "dcnn/cells/pack.h"
#include "dcnn/cells/plan.h"
#include "dcnn/cells/project.h"
#include "dcnn/cells/run.h"
#include "dcnn/core/file.h"
#include "support/process.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

/// Ten cells: two settings, five seeds, one input, a number in a file and a line printed.
constexpr const char* kSweep = R"({
  "commands": [["bash", "-c", "echo \"{\\\"x\\\": [{x}, {seed}]}\" > out/r.json; cat in/data.txt"]],
  "inputs": ["data.txt"], "grid": {"x": [1, 2.5], "seed": {"from": 3, "count": 5}},
  "columns": {"first": "r.json#/x/0", "second": "r.json#/x/1", "none": "r.json#/y"}})";

class Cells : public testing::Test {
 protected:
  Cells() { write_file(folder_ / "data.txt", "data\n"); }

  CellPlan plan(const std::string& text) const {
    return make_plan(parse_json(text, "sweep.json", Exit::kUsage), "sweep.json", folder_.path(),
                     folder_ / "programs");
  }
  fs::path planned(const std::string& text, const std::string& name = "plan") const {
    write_plan(plan(text), folder_ / name, false);
    return folder_ / name;
  }
  CellRun request(const fs::path& at) const {
    CellRun run;
    run.folder = at;
    run.programs = folder_ / "programs";
    run.scratch = folder_.path();
    return run;
  }
  /// Notes of the run are kept.
  CellRunOutcome run(const CellRun& what, std::function<bool()> stop = {}) {
    CellRunObserver observer;
    observer.stop_wanted = std::move(stop);
    observer.progress = [](double, const std::string&) {};
    observer.note = [&](const std::string& line) { notes_.push_back(line); };
    return run_cells(what, observer);
  }
  std::vector<fs::path> packs(const fs::path& at) const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(at / "packs")) {
      if (entry.is_regular_file()) found.push_back(entry.path());
    }
    return found;
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> notes_;
};

void expect_refused(const std::function<void()>& work, const std::string& words) {
  try {
    work();
    ADD_FAILURE() << "not refused: " << words;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST_F(Cells, AreKeyedByWhatTheyDependOnAndByNothingElse) {
  const auto key = [&](const std::string& text) { return plan(text).cells.at(0).key; };
  const std::string base = key(R"({"commands": [["cat", "in/data.txt"]]})");
  EXPECT_EQ(base.size(), 64U);
  EXPECT_EQ(base, key(R"({"commands": [["cat", "in/data.txt"]], "name": "other", "threads": 2})"));
  EXPECT_NE(base, key(R"({"commands": [["cat", "-n", "in/data.txt"]]})"));
  EXPECT_NE(base, key(R"({"commands": [["cat", "in/data.txt"]], "files": {"c.json": {"a": 1}}})"));
  EXPECT_NE(base, key(R"({"commands": [["cat", "in/data.txt"]], "keep": ["r.json"]})"));
  write_file(folder_ / "programs/cat", "a program of the toolkit");
  const std::string ours = key(R"({"commands": [["cat", "in/data.txt"]]})");
  EXPECT_NE(base, ours);
  write_file(folder_ / "programs/cat", "its next version");
  EXPECT_NE(ours, key(R"({"commands": [["cat", "in/data.txt"]]})"));
  fs::remove(folder_ / "programs/cat");
  write_file(folder_ / "data.txt", "other data\n");
  EXPECT_NE(base, key(R"({"commands": [["cat", "in/data.txt"]]})"));
}

TEST_F(Cells, OfAGridAreEveryCombinationInTheOrderOfTheirKeys) {
  const auto cells = plan(kSweep).cells;
  ASSERT_EQ(cells.size(), 10U);
  std::set<std::string> names;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    names.insert(cells[i].name);
    EXPECT_TRUE(i == 0 || cells[i - 1].key < cells[i].key);
    EXPECT_EQ(cells[i].inputs.size(), 1U);
  }
  EXPECT_EQ(names.size(), 10U);
  EXPECT_TRUE(names.contains("x=2.5,seed=7")) << *names.begin();
  const auto typed = plan(
      R"({"commands": [["true"]], "list": [{"lr": 0.1, "n": "{"}], "files": {"c.json": {"lr": "{lr}", "t": "a{lr}${lr}"}}})");
  EXPECT_EQ(typed.cells[0].files["c.json"], Json({{"lr", 0.1}, {"t", "a0.1${lr}"}}));
}

TEST_F(Cells, OfADescriptionWithAFaultAreRefusedWithTheRemedy) {
  const auto refused = [&](const std::string& text, const std::string& words) {
    expect_refused([&] { plan(text); }, words);
  };
  refused(R"({"commands": "true"})", "must be a list of commands");
  refused(R"({"commands": [["cat", "in/nothing.txt"]]})", "is not there");
  refused(R"({"commands": [["cat", "in/../x"]]})", "not below the folder");
  refused(R"({"commands": [["echo", "{sed}"]], "grid": {"seed": [1]}})", "names {sed}");
  refused(R"({"commands": [["true"]], "grid": {"seed": [1, 2]}})", "do the same");
  refused(R"({"commands": [["echo", "{seed}"]], "grid": {"seed": [1, 2]}, "name": "a"})",
          "are called 'a'");
  refused(R"({"commands": [["true"]], "name": "../a"})", "no name of a folder");
  refused(R"({"commands": [["true"]], "files": {"out": 1}})", "no name of a file");
  refused(R"({"commands": [["true"]], "comands": 1})", "comands");
  refused(R"({"commands": [["true"]], "grid": {"a": []}})", "has no values");
}

TEST_F(Cells, GiveTheSameTableWhoeverRunsThemInWhateverOrder) {
  const fs::path plain = planned(kSweep, "plain"), shards = planned(kSweep, "shards");
  EXPECT_EQ(run(request(plain)).done, 10);
  for (const int index : {3, 1, 2}) {
    CellRun share = request(shards);
    share.shard = {index, 3};
    share.jobs = 3;
    EXPECT_EQ(run(share).done, index == 1 ? 4 : 3);
  }
  EXPECT_TRUE(notes_.empty());
  const std::string table = merge_cells(plain).table;
  EXPECT_EQ(table, merge_cells(shards).table);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 11);
  EXPECT_NE(table.find(R"("exit":0,"first":2.5,"second":7,"none":null)"), std::string::npos)
      << table;
  EXPECT_EQ(run(request(shards)).skipped, 10);
  EXPECT_EQ(packs(shards).size(), 3U);  // who had nothing to do leaves nothing
  write_file(folder_ / "t.jsonl", table);
  EXPECT_TRUE(is_merged_table(folder_ / "t.jsonl"));
  EXPECT_FALSE(is_merged_table(folder_ / "data.txt"));
}

TEST_F(Cells, FinishedBeforeACrashOfTheirPackAreKeptTheOthersRunAgain) {
  const fs::path at = planned(kSweep);
  ASSERT_EQ(run(request(at)).done, 10);
  const std::string table = merge_cells(at).table;
  const fs::path pack = packs(at).at(0);
  const std::string whole = test::slurp(pack);
  // Every length to which a killed process can have come, some of them.
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    write_file(pack, whole.substr(0, size));
    const MergedCells merged = merge_cells(at);
    EXPECT_EQ(std::count(merged.table.begin(), merged.table.end(), '\n') + merged.missing.size(),
              11U);
    EXPECT_TRUE(merged.failed.empty() && merged.warnings.empty());
  }
  const auto again = run(request(at));
  EXPECT_GE(again.done, 1);
  EXPECT_EQ(again.done + again.skipped, 10);
  EXPECT_EQ(merge_cells(at).table, table);
}

TEST_F(Cells, WhoseResultIsDamagedRunAgain) {
  const fs::path at = planned(kSweep);
  ASSERT_EQ(run(request(at)).done, 10);
  const std::string table = merge_cells(at).table;
  const fs::path pack = packs(at).at(0);
  std::string bytes = test::slurp(pack);
  const std::size_t payload = bytes.find("\ndata\n");  // what a cell printed
  ASSERT_NE(payload, std::string::npos);
  bytes[payload + 2] = 'A';
  write_file(pack, bytes);
  const MergedCells damaged = merge_cells(at);
  EXPECT_EQ(damaged.missing.size(), 1U);
  ASSERT_EQ(damaged.warnings.size(), 1U);
  EXPECT_NE(damaged.warnings[0].find("damaged"), std::string::npos);
  EXPECT_EQ(run(request(at)).done, 1);
  EXPECT_EQ(merge_cells(at).table, table);
}

TEST_F(Cells, ThatFailAreTriedTwiceAndReportedWithTheirCommand) {
  const fs::path at = planned(
      R"({"commands": [["bash", "-c", "echo tried >> in/tries; echo 'no luck' >&2; [ {x} != 2 ] || exit 3"]], "grid": {"x": [1, 2, 3]}})");
  const auto outcome = run(request(at));
  EXPECT_EQ(outcome.done, 2);
  EXPECT_EQ(outcome.failed, 1);
  EXPECT_EQ(test::slurp(folder_ / "tries"), "tried\ntried\ntried\ntried\n");
  const MergedCells merged = merge_cells(at);
  EXPECT_TRUE(merged.missing.empty());
  ASSERT_EQ(merged.failed.size(), 1U);
  EXPECT_EQ(merged.failed[0].substr(0, 24), "x=2: exit 3: bash -c 'ec") << merged.failed[0];
  EXPECT_NE(merged.failed[0].find(": no luck"), std::string::npos) << merged.failed[0];
  EXPECT_NE(merged.table.find("\"settings\":{\"x\":2},\"exit\":3"), std::string::npos)
      << merged.table;
  const Json status = cells_status(at);
  EXPECT_EQ(status["done"], 2);
  EXPECT_EQ(status["failed"][0]["log"], Json("no luck\n"));
  EXPECT_EQ(run(request(at)).skipped, 3);
  CellRun again = request(at);
  again.again = true;
  EXPECT_EQ(run(again).failed, 1);
}

TEST_F(Cells, ThatFailOnceAreForgiven) {
  const fs::path at = planned(
      R"({"commands": [["bash", "-c", "[ -e in/been ] || { touch in/been; exit 9; }; echo fine"]]})");
  const auto outcome = run(request(at));
  EXPECT_EQ(outcome.done, 1);
  EXPECT_EQ(outcome.failed, 0);
  EXPECT_TRUE(merge_cells(at).failed.empty());
}

TEST_F(Cells, ThatAreEndedFromOutsideLeaveNoResult) {
  const fs::path at = planned(R"({"commands": [["bash", "-c", "kill -TERM $$"]]})");
  EXPECT_EQ(run(request(at)).failed, 1);
  EXPECT_EQ(merge_cells(at).missing.size(), 1U);
}

TEST_F(Cells, ThatTakeTooLongOrAreNotThereFail) {
  const fs::path at = planned(
      R"({"cells": [{"name": "slow", "commands": [["sleep", "60"]], "timeout_s": 0.3},
                    {"name": "none", "commands": [["no-such-program"]]},
                    {"name": "second", "commands": [["true"], ["false"], ["touch", "out/never"]]}]})");
  EXPECT_EQ(run(request(at)).failed, 3);
  const std::string table = merge_cells(at).table;
  for (const char* end : {R"("slow","key")", R"("none","key")", R"("second","key")"}) {
    EXPECT_NE(table.find(end), std::string::npos) << table;
  }
  for (const char* exit : {"\"exit\":124", "\"exit\":127", "\"exit\":1,"}) {
    EXPECT_NE(table.find(exit), std::string::npos) << table;
  }
  EXPECT_EQ(table.find("never"), std::string::npos);
}

TEST_F(Cells, StopWhenAskedToAndGoOn) {
  const fs::path at = planned(
      R"({"commands": [["bash", "-c", "echo {k}; sleep 0.1"]], "grid": {"k": {"from": 1, "count": 6}}})");
  int asked = 0;
  const auto stopped = run(request(at), [&] { return ++asked > 3; });
  EXPECT_FALSE(stopped.finished);
  EXPECT_LT(stopped.done, 6);
  const auto rest = run(request(at));
  EXPECT_TRUE(rest.finished);
  EXPECT_EQ(rest.skipped, stopped.done);
  EXPECT_TRUE(merge_cells(at).missing.empty());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2)
      << "scratch folders are gone";
}

TEST_F(Cells, DoNotRunOnOtherFilesOrProgramsThanPlanned) {
  write_file(folder_ / "programs/ours", "#!/bin/sh\necho 1\n");
  fs::permissions(folder_ / "programs/ours", fs::perms::owner_all);
  const fs::path at = planned(R"({"commands": [["ours"], ["cat", "in/data.txt"]]})");
  write_file(folder_ / "data.txt", "changed\n");
  expect_refused([&] { run(request(at)); }, "another file than when the plan was made");
  write_file(folder_ / "data.txt", "data\n");
  write_file(folder_ / "programs/ours", "#!/bin/sh\necho 2\n");
  expect_refused([&] { run(request(at)); }, "is not the program that the plan was made with");
  write_file(folder_ / "programs/ours", "#!/bin/sh\necho 1\n");
  EXPECT_EQ(run(request(at)).done, 1);
}

TEST_F(Cells, ThatContradictThemselvesAreNamed) {
  const std::string random = R"({"commands": [["bash", "-c", "echo $RANDOM$RANDOM$RANDOM"]]})";
  const fs::path at = planned(random), other = planned(random, "other");
  ASSERT_EQ(run(request(at)).done + run(request(other)).done, 2);
  fs::copy(packs(other).at(0), packs(at).at(0).parent_path());
  const MergedCells merged = merge_cells(at);
  ASSERT_EQ(merged.warnings.size(), 1U);
  EXPECT_NE(merged.warnings[0].find("two runs gave different bytes"), std::string::npos);
}

TEST_F(Cells, OfAnotherPlanAreKeptAndThoseOfBothPlansNotRunAgain) {
  const std::string one = R"({"commands": [["echo", "{k}"]], "grid": {"k": [1, 2]}})";
  const std::string two = R"({"commands": [["echo", "{k}"]], "grid": {"k": [2, 3]}})";
  const fs::path at = planned(one);
  ASSERT_EQ(run(request(at)).done, 2);
  write_plan(plan(one), at, false);  // the same: nothing to refuse
  expect_refused([&] { write_plan(plan(two), at, false); }, "holds another plan, which is kept");
  write_plan(plan(two), at, true);
  const auto outcome = run(request(at));
  EXPECT_EQ(outcome.done, 1);
  EXPECT_EQ(outcome.skipped, 1);
}

TEST_F(Cells, AreUnpackedWithTheirTimesAndOtherResultsKept) {
  const fs::path at =
      planned(R"({"commands": [["bash", "-c", "mkdir out/a; echo {k} | tee out/a/f out/g"]],
    "grid": {"k": [1, 2]}, "name": "n/{k}", "drop": ["g"]})");
  ASSERT_EQ(run(request(at)).done, 2);
  const fs::path into = folder_ / "results";
  unpack_cells(at, into, false);
  EXPECT_EQ(test::slurp(into / "n/2/a/f"), "2\n");
  EXPECT_EQ(test::slurp(into / "n/2/stdout"), "2\n");
  EXPECT_FALSE(fs::exists(into / "n/2/g"));
  EXPECT_GT(read_json(into / "n/1/run.json", Exit::kData)["seconds"].get<double>(), 0.0);
  const auto before = fs::last_write_time(into / "n/1/run.json");
  unpack_cells(at, into, false);
  EXPECT_EQ(fs::last_write_time(into / "n/1/run.json"), before);
  write_file(into / "n/2/a/f", "precious\n");
  expect_refused([&] { unpack_cells(at, into, false); }, "which is kept");
  unpack_cells(at, into, true);
  EXPECT_EQ(test::slurp(into / "n/2/a/f"), "2\n");
}

TEST_F(Cells, AtWorkAreToldUntilTheirProcessEnds) {
  const fs::path at = planned(kSweep);
  const std::string key = plan(kSweep).cells[0].key;
  {
    PackWriter pack(at, {1, 1});
    pack.begin(key);
    const Json status = cells_status(at);
    ASSERT_EQ(status["running"].size(), 1U);
    EXPECT_EQ(status["running"][0]["name"].get<std::string>(), plan(kSweep).cells[0].name);
  }
  EXPECT_TRUE(cells_status(at)["running"].empty());
}

TEST_F(Cells, AreProjectedFromTheTimesOfThoseThatRan) {
  const fs::path at = planned(R"({"commands": [["true"]]})");
  expect_refused([&] { project_cells(at, 10, 2, CellTime::kWall); }, "no cell has run");
  {
    PackWriter pack(at, {1, 1});
    for (const auto& [key, seconds] : {std::pair("a", 1.0), std::pair("b", 3.0)}) {
      CellResult result;
      result.key = key;
      result.seconds = seconds;
      pack.append(result);
    }
  }
  const CellProjection one = project_cells(at, 100, 1, CellTime::kWall),
                       many = project_cells(at, 100, 100, CellTime::kWall);
  EXPECT_EQ(one.measured, 2);
  EXPECT_EQ(one.mean_s, 2.0);
  // A sum of 100 times of 1 or 3 s: mean 200 s, standard deviation 10 s.
  EXPECT_NEAR(one.median_s, 200.0, 3.0);
  EXPECT_NEAR(one.late_s, 200.0 + 1.645 * 10.0, 4.0);
  EXPECT_EQ(many.median_s, 3.0);  // the longest of 100
}

TEST_F(Cells, AreCutIntoTasksOfFiveMinutesAtLeast) {
  const fs::path at = planned(
      R"({"commands": [["echo", "{k}"]], "grid": {"k": {"from": 1, "count": 1000}}, "threads": 3})");
  EngineRequest engine;
  engine.folder = at;
  engine.program = "/opt/dcnn sweep";
  expect_refused([&] { slurm_script(engine); }, "--cell-seconds");
  engine.cell_seconds = 3.0;  // ten tasks of 100 cells; twice 300 + 3 s, and two minutes
  const std::string script = slurm_script(engine);
  for (const char* line : {"#SBATCH --array=1-10\n", "#SBATCH --cpus-per-task=3\n",
                           "#SBATCH --time=0:13:00\n", "#SBATCH --requeue\n",
                           "'/opt/dcnn sweep' --quiet", "--shard \"$SLURM_ARRAY_TASK_ID/10\""}) {
    EXPECT_NE(script.find(line), std::string::npos) << line << script;
  }
  const std::string lines = parallel_script(engine);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 10);
  EXPECT_NE(lines.find("--shard 10/10\n"), std::string::npos);
  engine.cell_seconds = 1e4;  // no more tasks than schedulers take
  EXPECT_NE(slurm_script(engine).find("--array=1-1000\n"), std::string::npos);
  engine.cell_seconds = 1e-3;
  EXPECT_NE(slurm_script(engine).find("--array=1-1\n"), std::string::npos);
  engine.hosts = {"one", "two"};
  EXPECT_NE(parallel_script(engine).find("--sshlogin 'one,two'"), std::string::npos);
}

}  // namespace
}  // namespace dcnn
