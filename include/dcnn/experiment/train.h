// SPDX-License-Identifier: Apache-2.0
// Training an identifier from recordings, in a run directory that survives anything.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "dcnn/experiment/configuration.h"
#include "dcnn/models/identifier.h"

namespace dcnn {

struct TrainingRequest {
  ConfigurationFlags configuration;
  std::vector<std::filesystem::path> training,
      validation;  ///< validation empty: a tail of each training file
  ReadOptions read;
  std::optional<std::filesystem::path> base;  ///< simulator whose remainder is learned
  std::filesystem::path out;  ///< model.dcnn; the run directory is model.run beside it
  bool resume = false;
};

struct TrainingProgress {
  Index epoch = 0, epochs = 0, step = 0, steps = 0;
  double loss = 0.0;
  std::optional<EpochRecord> finished;  ///< set once at the end of every epoch
};

struct TrainingObserver {
  std::function<bool()> stop_wanted;
  std::function<void(const std::string&)> note;
  std::function<void(const TrainingProgress&)> progress;
};

struct TrainingOutcome {
  bool finished = false;  ///< false: stopped, state saved
  Json summary;           ///< rows, epochs, best epoch, validation RMSE, parameters, files
};

/// Reads, splits, learns and writes. Rows of a training recording's last `validation` share, after
/// a gap of 1 s, are for validation only; statistics come from the training rows alone.
TrainingOutcome train(const TrainingRequest& request, const TrainingObserver& observer);

/// What --model auto does: train() for the rigid tool and for networks, and a simulator that a
/// diagnosis of the training rows corrects, in folders of the run directory; the one with the least
/// error on the validation rows is `out`. The summary is that
/// one's, with `choice`: the errors of all and the reason in words.
TrainingOutcome train_best(const TrainingRequest& request, const TrainingObserver& observer);

/// The run directory of a model file: its name with the extension .run.
std::filesystem::path run_directory(const std::filesystem::path& model);

}  // namespace dcnn
