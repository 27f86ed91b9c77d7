// What is missing in a simulator, by the difference between it and recordings.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"
#include "dcnn/physics/simulator.h"

namespace dcnn {

struct DiagnosisRequest {
  std::optional<std::filesystem::path> simulator;  ///< sim.json; none: columns *_sim
  std::vector<std::filesystem::path> fit, holdout;
  ReadOptions read;
  std::optional<bool> shared_clock;  ///< none: shared where the times do not overlap
};

/// Names what is missing. Error(kData) for recordings or simulators that cannot be used.
Json diagnose(const DiagnosisRequest& request,
              const std::function<void(const std::string&)>& progress);

}  // namespace dcnn
