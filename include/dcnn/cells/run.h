// SPDX-License-Identifier: Apache-2.0
// Runs the cells of a plan, or a share of them, on this machine.
#pragma once

#include <functional>

#include "dcnn/cells/plan.h"

namespace dcnn {

struct CellRun {
  std::filesystem::path folder;  ///< of the plan
  Shard shard;
  int jobs = 1;                    ///< cells at a time
  int limit = 0;                   ///< most cells to run; 0: all
  bool again = false;              ///< cells that failed, too
  std::function<double(const Cell&)> weight;  ///< of a cell in what progress says; none: 1
  std::filesystem::path root;      ///< instead of the plan's
  std::filesystem::path programs;  ///< folder of the toolkit's
  std::filesystem::path scratch;   ///< cells run in folders below it
};

struct CellRunObserver {
  std::function<bool()> stop_wanted;
  std::function<void(double done, const std::string& text)> progress;
  std::function<void(const std::string& line)> note;
};

struct CellRunOutcome {
  std::int64_t done = 0, skipped = 0, failed = 0;  ///< skipped: finished before
  bool finished = true;                            ///< false where it was stopped
};

/// A cell that fails is run once more, after the others; the second failure is its result. A cell
/// that is ended from outside (SIGTERM, SIGINT, SIGHUP, exit code 75) leaves none.
CellRunOutcome run_cells(const CellRun& request, const CellRunObserver& observer);

}  // namespace dcnn
