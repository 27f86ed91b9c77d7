// SPDX-License-Identifier: Apache-2.0
#include "dcnn/cells/emit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "dcnn/cells/merge.h"
#include "dcnn/cells/plan.h"
#include "dcnn/core/digest.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

constexpr double kLeastTask_s =
    300.0;                        // schedulers ask for tasks of minutes; starting one takes seconds
constexpr int kMostTasks = 1000;  // Slurm's MaxArraySize is 1001 unless a site raises it
constexpr int kWarning_s = 60;    // from the warning to the end of a task's time

/// How the cells that are left are cut into tasks.
struct Tasks {
  int count = 1;
  double seconds = 0.0;    ///< expected of one task
  double longest_s = 0.0;  ///< longest cell so far
  double memory_mb = 0.0;  ///< largest so far
  int threads = 1;
  fs::path root;
};

Tasks cut(const EngineRequest& request) {
  const Json status = cells_status(request.folder);
  const auto left = status["left"].get<double>();
  const bool measured = !status["mean_s"].is_null();
  require(
      request.cell_seconds > 0.0 || measured, Exit::kUsage, request.folder.string(),
      ": no cell has run, so its time is unknown; run some with --limit 3, or give --cell-seconds");
  const double mean =
      request.cell_seconds > 0.0 ? request.cell_seconds : status["mean_s"].get<double>();
  Tasks tasks;
  const double most = std::clamp(std::floor(left * mean / kLeastTask_s), 1.0, double{kMostTasks});
  tasks.count = request.tasks > 0 ? request.tasks : static_cast<int>(most);
  tasks.seconds = std::ceil(left / tasks.count) * mean;
  tasks.longest_s = std::max(mean, status["longest_s"].get<double>());
  tasks.memory_mb = status["memory_kb"].get<double>() / 1024.0;
  const CellPlan plan = read_plan(request.folder, {1, 1'000'000'000});
  tasks.threads = plan.threads;
  tasks.root = plan.root;
  return tasks;
}

std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// Twice what is expected, and two of the longest cell: a task that takes longer is begun anew and
/// goes on, so too short a time costs its unfinished cells and no more.
std::string time_limit(const Tasks& tasks) {
  const double minutes =
      std::ceil((2.0 * (tasks.seconds + tasks.longest_s) + 2 * kWarning_s) / 60.0);
  const auto whole = static_cast<long>(minutes);
  char text[32];
  std::snprintf(text, sizeof text, "%ld:%02ld:00", whole / 60, whole % 60);
  return text;
}

std::string files_below(const fs::path& folder, const fs::path& root) {
  const CellPlan plan = read_plan(folder);
  std::map<std::string, int> inputs;
  for (const Cell& cell : plan.cells) {
    for (const auto& input : cell.inputs) inputs[input.first];
  }
  std::string lines;
  for (const auto& [file, unused] : inputs) lines += " --basefile " + in_quotes(root / "." / file);
  return lines;
}

}  // namespace

std::string slurm_script(const EngineRequest& request) {
  const Tasks tasks = cut(request);
  // Half as much again as the largest cell so far, at least what programs and libraries take.
  const long memory = std::max(512L, static_cast<long>(std::ceil(1.5 * tasks.memory_mb)));
  const fs::path folder = fs::absolute(request.folder).lexically_normal();
  std::ostringstream out;
  out << "#!/bin/bash\n"
      << "# " << tasks.count << " tasks of about " << std::ceil(tasks.seconds)
      << " s. sbatch this file; again after a failure: what is finished is not run again.\n"
      << "#SBATCH --job-name=dcnn-sweep\n"
      << "#SBATCH --array=1-" << tasks.count << "\n"
      << "#SBATCH --cpus-per-task=" << tasks.threads << "\n"
      << "#SBATCH --time=" << time_limit(tasks) << "\n"
      << "#SBATCH --mem=" << memory << "M\n"
      << "#SBATCH --requeue\n"
      << "#SBATCH --signal=B:USR1@" << kWarning_s << "\n"
      << "#SBATCH --open-mode=append\n"
      << "#SBATCH --output=" << folder.string() << "/slurm-%a.log\n"
      << "#SBATCH --chdir=" << tasks.root.string() << "\n"
      << "trap 'kill -TERM $worker' USR1 TERM\n"
      << in_quotes(request.program) << " --quiet --plan " << in_quotes(folder)
      << " --shard \"$SLURM_ARRAY_TASK_ID/" << tasks.count << "\" &\n"
      << "worker=$!\n"
      << "wait $worker; code=$?\n"
      << "while kill -0 $worker 2>/dev/null; do wait $worker; code=$?; done  # a signal ends wait, "
         "not the worker\n"
      << "# Out of time or preempted: this task is begun again and goes on.\n"
      << "[ $code -ne 75 ] || scontrol requeue \"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID\"\n"
      << "exit $code\n";
  return out.str();
}

std::string parallel_script(const EngineRequest& request) {
  const Tasks tasks = cut(request);
  const fs::path folder = fs::absolute(request.folder).lexically_normal();
  std::ostringstream out;
  if (request.hosts.empty()) {
    for (int k = 1; k <= tasks.count; ++k) {
      out << in_quotes(request.program) << " --quiet --plan " << in_quotes(folder) << " --shard "
          << k << "/" << tasks.count << "\n";
    }
    return out.str();
  }
  std::string hosts;
  for (const std::string& host : request.hosts) hosts += (hosts.empty() ? "" : ",") + host;
  // Files stay on the hosts, so that a second call finds there what the first one finished.
  const std::string place = "dcnn-sweep-" + sha256_hex({folder.string()}).substr(0, 12);
  out << "#!/bin/bash\n"
      << "# " << tasks.count << " tasks of about " << std::ceil(tasks.seconds) << " s on " << hosts
      << ", which have dcnn-sweep in their PATH. Run it again after a failure: what is finished is "
         "not run again.\n"
      << "mkdir -p " << in_quotes(folder / "packs") << " && cd " << in_quotes(folder) << " &&\n"
      << "exec parallel --sshlogin " << in_quotes(hosts) << " --workdir " << place << " --joblog "
      << in_quotes(folder / "parallel.log") << " --retries 2 --basefile "
      << in_quotes(folder / "." / "plan.jsonl") << files_below(folder, tasks.root)
      << " --return './packs/{}-of-" << tasks.count << "' \\\n"
      << "  'dcnn-sweep --quiet --plan . --root . --shard {}/" << tasks.count << "' ::: {1.."
      << tasks.count << "}\n";
  return out.str();
}

}  // namespace dcnn
