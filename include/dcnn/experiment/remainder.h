// SPDX-License-Identifier: Apache-2.0
// What a network makes of the force that a simulator leaves: it fits, and names nothing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn {

struct RemainderRequest {
  std::string model, preset;        ///< as of dcnn-train
  std::filesystem::path simulator;  ///< sim.json of a wrist tool
  std::vector<std::filesystem::path> fit, holdout;
  std::filesystem::path out;  ///< folder for model.dcnn
};

/// Trains on what the simulator leaves; a report in the form of dcnn-diagnose's
/// without findings: `fit_only` true, `fit.holdout_rmse_before` and `_after` per axis
/// without the first and last 0.5 s of each recording, and `seconds`. Errors are those of train().
Json learn_remainder(const RemainderRequest& request);

}  // namespace dcnn
