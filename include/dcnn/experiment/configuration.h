// SPDX-License-Identifier: Apache-2.0
// From a preset, a configuration file and flags to one resolved configuration, with
// defaults for all that none of them says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/features.h"
#include "dcnn/models/model.h"

namespace dcnn {

inline const std::vector<std::string> kPresets{"quick", "standard", "fair", "paper"};

/// What the command line adds to, or puts in place of, the file.
struct ConfigurationFlags {
  std::optional<std::filesystem::path> file;
  std::optional<std::string> preset, model;
  std::optional<std::filesystem::path> system;
  std::optional<Index> epochs;
  std::optional<std::uint64_t> seed;
  bool online = false;
};

struct Configuration {
  Json json;          ///< every key resolved: model files, run directories and reports hold it
  std::string where;  ///< names the file (or the preset) in errors
  const ModelKind* kind = nullptr;
  FeatureSpec features;
  System system;
  std::uint64_t seed = 1;
  double validation = 0.15;  ///< share of every training recording kept for validation
};

/// Preset fills what is missing, flags override, an unknown key is Error(kUsage).
Configuration resolve(const ConfigurationFlags& flags);

/// `over` laid on `under`: objects are merged key by key, everything else is replaced.
Json merged(Json under, const Json& over);

}  // namespace dcnn
