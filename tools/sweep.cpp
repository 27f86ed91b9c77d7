// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <iostream>

#include "dcnn/cells/emit.h"
#include "dcnn/cells/merge.h"
#include "dcnn/cells/plan.h"
#include "dcnn/cells/project.h"
#include "dcnn/cells/run.h"
#include "dcnn/core/file.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;
namespace fs = std::filesystem;

constexpr const char* kExamples =
    "  dcnn-sweep sweep.json --plan out/sweep                  # cells and their keys\n"
    "  dcnn-sweep --plan out/sweep --jobs 2                    # run them here; again: goes on\n"
    "  dcnn-sweep --plan out/sweep --emit slurm > job.sh       # or there: sbatch job.sh\n"
    "  dcnn-sweep --plan out/sweep --status\n"
    "  dcnn-sweep --plan out/sweep --merge results.jsonl\n";

/// "3/40".
Shard parse_shard(const std::string& text) {
  Shard shard;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%ld/%ld%c", &shard.index, &shard.count, &rest);
  require(read == 2 && shard.count >= 1 && shard.index >= 1 && shard.index <= shard.count,
          Exit::kUsage, "--shard: ", text, " is not i/n with 1 <= i <= n");
  return shard;
}

/// Prints the time that `text`, "cells/workers", takes, or gives it for --json.
Json project(const std::filesystem::path& folder, const std::string& text, bool print) {
  long cells = 0, workers = 0;
  char rest = 0;
  require(std::sscanf(text.c_str(), "%ld/%ld%c", &cells, &workers, &rest) == 2 && cells >= 1 &&
              workers >= 1 && cells <= 10'000'000 && workers <= cells,
          Exit::kUsage, "--project: ", text, " is not cells/workers, such as 1721/100");
  Json json = Json::object();
  for (const CellTime time : {CellTime::kWall, CellTime::kProcessor}) {
    const CellProjection p = project_cells(folder, cells, workers, time);
    json[time == CellTime::kWall ? "wall_time" : "processor_time"] = {{"measured", p.measured},
                                                                      {"mean_s", p.mean_s},
                                                                      {"longest_s", p.longest_s},
                                                                      {"median_s", p.median_s},
                                                                      {"late_s", p.late_s}};
    if (!print) continue;
    std::cout << (time == CellTime::kWall ? "wall time" : "processor time") << ": " << p.measured
              << " cells took " << std::lround(p.mean_s * 10.0) / 10.0
              << " s on average, the longest " << std::lround(p.longest_s * 10.0) / 10.0 << " s; "
              << cells << " such cells on " << workers << " workers " << clock_text(p.median_s)
              << ", 95 of 100 times less than " << clock_text(p.late_s) << "\n";
  }
  return json;
}

Exit run(const CellRun& request, bool failures_allowed, const Tool& tool) {
  catch_interrupts(tool.common().quiet);
  Progress bar(tool.common().quiet);
  CellRunObserver observer;
  observer.stop_wanted = [] { return interrupted(); };
  observer.progress = [&](double done, const std::string& text) { bar.update(done, text); };
  observer.note = [&](const std::string& line) {
    bar.clear();
    std::cerr << line << "\n";
  };
  const CellRunOutcome outcome = run_cells(request, observer);
  bar.clear();
  tool.note(std::to_string(outcome.done) + " cells done, " + std::to_string(outcome.skipped) +
            " skipped, since they were finished, " + std::to_string(outcome.failed) + " failed");
  if (!outcome.finished) {
    tool.note("interrupted; what is finished is kept in " + request.folder.string() +
              ", the same command goes on");
    return Exit::kInterrupted;
  }
  return outcome.failed == 0 || failures_allowed ? Exit::kDone : Exit::kFailure;
}

void print_status(const Json& status) {
  std::cout << status["done"] << " of " << status["cells"] << " cells done, "
            << status["running"].size() << " running, " << status["failed"].size() << " failed\n";
  if (!status["eta_s"].is_null()) {
    std::cout << "time left: " << clock_text(status["eta_s"].get<double>()) << "\n";
  }
  for (const Json& cell : status["running"]) {
    std::cout << "running: " << cell["name"].get<std::string>() << " on "
              << cell["host"].get<std::string>() << "\n";
  }
  for (const Json& cell : status["failed"]) {
    std::cout << "failed: " << cell["name"].get<std::string>() << ": exit " << cell["exit"] << ": "
              << cell["command"].get<std::string>() << "\n"
              << cell["log"].get<std::string>();
  }
}

struct MergeRequest {
  fs::path folder, table, files;
  bool partial = false, failures_allowed = false, force = false;
};

/// Table and files of all cells; says which are missing or failed.
Exit merge(const MergeRequest& request) {
  const MergedCells merged = merge_cells(request.folder);
  const auto& missing = merged.missing;
  for (const std::string& line : merged.warnings) std::cerr << line << "\n";
  for (const std::string& line : merged.failed) std::cerr << "failed: " << line << "\n";
  require(request.partial || missing.empty(), Exit::kFailure, request.folder.string(), ": ",
          missing.size(), " cells have no result, ", missing.empty() ? "" : missing[0],
          " among them; run them, or merge what there is with --partial");
  if (!request.table.empty()) write_file(request.table, merged.table);
  if (!request.files.empty()) unpack_cells(request.folder, request.files, request.force);
  const bool whole = merged.failed.empty() || request.failures_allowed;
  return whole && missing.empty() ? Exit::kDone : Exit::kFailure;
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool(
      "dcnn-sweep",
      "Cuts long work into cells, runs them here or writes what Slurm or GNU parallel run, and "
      "merges their results to the same bytes whoever ran them.",
      kExamples);
  fs::path description, folder;
  MergeRequest merging;
  EngineRequest engine;
  CellRun work;
  std::string shard, emit, projected;
  bool status = false;
  tool.option("description", description,
              "settings, seeds, recordings, models and the commands (JSON)")
      .holds({FileKind::kSweep});
  tool.option("--plan", folder, "folder of the plan and its results").required().called("DIR");
  auto jobs = tool.option("--jobs", work.jobs, "cells at a time").between(1, 1024).with_default();
  auto share = tool.option("--shard", shard, "run share i of n, such as 3/40").called("I/N");
  tool.option("--limit", work.limit, "run this many cells and no more").positive();
  tool.flag("--again", work.again, "run cells that failed again");
  tool.flag("--status", status, "what is done, running, failed, and the time left");
  tool.option("--project", projected, "the time that N such cells take on W workers").called("N/W");
  tool.output("--merge", merging.table,
              "the table of all results, one line of JSON each, in the order of keys")
      .replaces(is_merged_table);
  tool.option("--unpack", merging.files, "write every cell's files to DIR/NAME").called("DIR");
  tool.flag("--partial", merging.partial, "merge though cells are missing");
  tool.flag("--allow-failures", merging.failures_allowed,
            "cells that failed are results: no exit code for them");
  tool.option("--emit", emit, "print what the engine runs").one_of({"slurm", "parallel"});
  tool.option("--hosts", engine.hosts, "ssh hosts for --emit parallel, to which files are copied")
      .separated_by_commas();
  tool.option("--tasks", engine.tasks, "for --emit (default: of five minutes each)")
      .between(1, 100000);
  tool.option("--cell-seconds", engine.cell_seconds,
              "for --emit (default: the mean of the cells that have run)")
      .positive();
  tool.option("--root", work.root, "folder of the inputs, where it is not the one of the plan")
      .called("DIR");
  std::error_code no_folder;  // TMPDIR may name anything
  work.scratch = fs::temp_directory_path(no_folder);
  tool.option("--scratch", work.scratch, "cells run in folders below it")
      .called("DIR")
      .with_default();

  return tool.run(argc, argv, [&] {
    const bool runs = jobs.given() || share.given();
    require(
        runs || status || !projected.empty() || !description.empty() || !emit.empty() ||
            !merging.table.empty() || !merging.files.empty(),
        Exit::kUsage,
        "give a description, --jobs, --shard, --status, --project, --emit, --merge or --unpack");
    require(!work.scratch.empty(), Exit::kUsage,
            "TMPDIR names no folder; --scratch DIR says where cells run");
    require(emit.empty() || !tool.common().json, Exit::kUsage,
            "--json and --emit both go to standard output; give one of them");
    engine.program = fs::canonical("/proc/self/exe");
    work.programs = engine.program.parent_path();
    work.folder = engine.folder = merging.folder = folder;
    merging.force = tool.common().force;
    if (!description.empty()) {
      const fs::path root = work.root.empty() ? fs::current_path() : work.root;
      const CellPlan plan = make_plan(read_json(description, Exit::kUsage), description.string(),
                                      root, work.programs);
      write_plan(plan, folder, tool.common().force);
      tool.note(std::to_string(plan.cells.size()) + " cells in " + folder.string());
    }
    Exit exit = Exit::kDone;
    if (runs) {
      if (share.given()) work.shard = parse_shard(shard);
      exit = run(work, merging.failures_allowed, tool);
    }
    if (exit == Exit::kInterrupted) return exit;
    if (!emit.empty())
      std::cout << (emit == "slurm" ? slurm_script(engine) : parallel_script(engine));
    if (!merging.table.empty() || !merging.files.empty()) exit = merge(merging);
    const bool json = tool.common().json;
    Json said = status || json ? cells_status(folder) : Json();
    if (status && !json) print_status(said);
    if (!projected.empty()) {
      const Json projection = project(folder, projected, !json);
      if (json) said["projection"] = projection;
    }
    if (json) Tool::print(said);
    return exit;
  });
}
