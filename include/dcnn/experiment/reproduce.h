// SPDX-License-Identifier: Apache-2.0
// The paper's experiments from data to one report (docs/results/paper.md): Fig. 5, Table I, C1 to
// C5.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/cells/run.h"
#include "dcnn/core/json.h"
#include "dcnn/core/parallel.h"

namespace dcnn {

struct ReproductionRequest {
  std::string preset = "standard";
  std::filesystem::path scene;  ///< configuration of the simulated recordings `train` and `test`
  std::vector<std::filesystem::path> data;      ///< instead: a training and a test recording
  std::vector<std::string> read;    ///< how the tools are told to read the recordings
  std::vector<std::string> accept;  ///< what dcnn-train is told of their faults
  std::optional<std::filesystem::path> recipe;  ///< by which they are logs of another format
  std::vector<std::string> models;              ///< empty: all of the preset
  std::string augment_only = "dcnn";  ///< the third reading: only this model was noise-trained
  std::filesystem::path out;
  std::uint64_t seed = 1;
  std::optional<Index> epochs;     ///< instead of the preset's
  std::optional<int> draws;        ///< of the test noise, instead of the preset's
  int trainings = 0;               ///< how many further seeds every model is trained with
  std::string commit = "unknown";  ///< of the code, for the report
  std::filesystem::path programs;  ///< folder of the toolkit's, which cells run
  int jobs = 1;                    ///< cells at a time; those that are timed run alone
  bool prepare = false;  ///< plan the cells of the first stage that is not finished, and stop
};

struct ReproductionOutcome {
  bool finished = false;               ///< false: stopped, or prepared; the same request goes on
  std::filesystem::path prepared;      ///< plan of cells that are to be run
  std::int64_t done = 0, skipped = 0;  ///< cells
  std::filesystem::path report;
  Json summary;  ///< the claims, files and where the numbers come from
};

/// Simulates, trains, scores, times and reports. All but the report are cells (dcnn/cells/plan.h):
/// what is finished, by the same programs on the same files, is not done again.
ReproductionOutcome reproduce(const ReproductionRequest& request, const CellRunObserver& observer);

/// The cells with their expected cost in seconds on one core.
Json reproduction_plan(const ReproductionRequest& request);

}  // namespace dcnn
