// SPDX-License-Identifier: Apache-2.0
// Time that predictions take, in calls of a few samples (Table I of the paper).
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/experiment/metrics.h"
#include "dcnn/models/identifier.h"

namespace dcnn {

struct Peers;

inline constexpr Index kPaperTestSamples = 32045;

struct BenchRequest {
  std::vector<std::filesystem::path> models;
  std::optional<std::filesystem::path> data;  ///< without: drawn from each model's own statistics
  std::vector<Index> lengths{1, 5, 10};       ///< samples per call
  int repetitions = 10;
  Index samples = kPaperTestSamples;  ///< without data
  Index warm_up = 1000;               ///< calls before the first one that counts
  std::uint64_t seed = 1;
  ReadOptions read;
  Precision precision = Precision::kSingle;  ///< of the models' predictions
};

/// One model at one length; all times in seconds.
struct BenchRow {
  std::string model, file;
  Index length = 1, calls = 0;
  Spread call, total;                          ///< over repetitions
  double p50 = 0.0, p99 = 0.0, maximum = 0.0;  ///< of single calls, over all repetitions
  double per_sample = 0.0;
  /// The call begins at the raw pose and makes the features with the causal filter; else it begins
  /// at the features. Eq. 7 is inside either way, the part of a base simulator is not.
  bool features_included = false;
};

struct Bench {
  std::string source;  ///< where the rows came from
  std::vector<BenchRow> rows;
  std::vector<std::string> notes;
};

/// Calls it takes to predict so many samples; the last one may be shorter.
inline Index call_count(Index samples, Index length) { return (samples + length - 1) / length; }

/// Runs on one thread, pinned to its processor. Rows from the pose are left out, with a note, for
/// models that have none.
Bench bench(const BenchRequest& request, const std::function<void(int done, int total)>& progress);

/// Contract section 5, a table beside the paper's, and a page with figures.
Json to_json(const Bench& bench);
std::string to_text(const Bench& bench);
std::string to_html(const Bench& bench, const BenchRequest& request, const Peers* peers = nullptr);

}  // namespace dcnn
