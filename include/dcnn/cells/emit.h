// SPDX-License-Identifier: Apache-2.0
// Scripts by which other engines run the cells of a plan.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dcnn {

struct EngineRequest {
  std::filesystem::path folder, program;  ///< of the plan; dcnn-sweep
  double cell_seconds = 0.0;              ///< of a cell; 0: as measured by those that have run
  int tasks = 0;                          ///< 0: as many as last five minutes each
  std::vector<std::string> hosts;         ///< for ssh; none: this machine
};

/// A job array for sbatch.
std::string slurm_script(const EngineRequest& request);
/// Lines for GNU parallel; with hosts a script that runs it over ssh and copies files.
std::string parallel_script(const EngineRequest& request);

}  // namespace dcnn
