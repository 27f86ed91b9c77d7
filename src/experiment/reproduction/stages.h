// SPDX-License-Identifier: Apache-2.0
// The long work of a reproduction as cells, which dcnn-sweep runs as well.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/experiment/reproduce.h"
#include "experiment/reproduction/plan.h"

namespace dcnn {

/// Cells that need nothing of each other, but the files of earlier stages.
struct ReproductionStage {
  std::string name;
  Json cells = Json::array();             ///< as make_plan() of dcnn/cells takes them
  std::map<std::string, double> seconds;  ///< expected of each, by its name, on one core
  bool one_at_a_time = false;             ///< their results are times
};

/// In the order in which they must be run.
std::vector<ReproductionStage> reproduction_stages(const ReproductionRequest& request,
                                       const ReproductionPlan& plan);

enum class RecordingPart { kTraining, kTest };

/// Where a recording lies below the output folder.
std::string recording_place(const ReproductionRequest& request, RecordingPart part);

}  // namespace dcnn
