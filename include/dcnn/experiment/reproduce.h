// The paper's experiments from data to one report (docs/results/paper.md): Fig. 5, Table I, C1 to C5.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"

namespace dcnn {

struct ReproductionRequest {
  std::string preset = "standard";
  std::filesystem::path scene;  ///< configuration of the simulated recordings `train` and `test`
  std::vector<std::filesystem::path> data;  ///< instead: a training and a test recording
  ReadOptions read;
  std::vector<std::string> models;    ///< empty: all of the preset
  std::string augment_only = "dcnn";  ///< the third reading: only this model was noise-trained
  std::filesystem::path out;
  std::uint64_t seed = 1;
  std::optional<Index> epochs;     ///< instead of the preset's
  std::optional<int> draws;        ///< of the test noise, instead of the preset's
  int trainings = 0;               ///< how many further seeds every model is trained with
  std::string commit = "unknown";  ///< of the code: finished work of another one is not used
};

struct ReproductionObserver {
  std::function<bool()> stop_wanted;
  std::function<void(const std::string&)> note;
  std::function<void(double done, const std::string& step)> progress;  ///< done in [0, 1]
};

struct ReproductionOutcome {
  bool finished = false;      ///< false: stopped; the same request goes on
  int done = 0, skipped = 0;  ///< steps
  std::filesystem::path report;
  Json summary;  ///< the claims, files and where the numbers come from
};

/// Simulates, trains, scores, times and reports, step by step: one that was finished with the same
/// inputs is not done again. Errors as those of train() and evaluate().
ReproductionOutcome reproduce(const ReproductionRequest& request,
                              const ReproductionObserver& observer);

/// The steps with their expected cost in seconds on two cores.
Json reproduction_plan(const ReproductionRequest& request);

}  // namespace dcnn
