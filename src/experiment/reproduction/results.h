// SPDX-License-Identifier: Apache-2.0
// The numbers of a reproduction, read back from the files its steps wrote.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/data/csv.h"
#include "dcnn/experiment/metrics.h"
#include "experiment/reproduction/layout.h"
#include "experiment/reproduction/plan.h"

namespace dcnn {

/// One model at one noise level, over draws.
struct LevelScore {
  SnrLevel snr_db;
  int runs = 0;
  std::vector<Spread> rmse;       ///< per target
  std::optional<Spread> overall;  ///< Eq. 6
};

struct ModelScores {
  std::string entry;
  std::vector<LevelScore> levels;
  std::vector<Json> rows;  ///< of every draw, as `dcnn-eval --json` lists them
};

/// All models under one training protocol and one noise mode, in the order of Fig. 5.
struct Scores {
  std::vector<std::string> targets, units;
  Index samples = 0;
  std::vector<ModelScores> models;

  const ModelScores* find(const std::string& entry) const;
  int target(const std::string& name) const;  ///< its place, -1 where absent
};

/// A row of Table I.
struct Timing {
  std::string entry;
  int length = 1;
  Index calls = 0;
  double mean_s = 0, std_s = 0, total_s = 0, total_std_s = 0, p50_s = 0, p99_s = 0, max_s = 0;
  bool from_pose = false;  ///< the call makes the features too; else it begins with them
};

struct Results {
  std::map<std::string, Scores> scores;  ///< by "mode/series"
  std::vector<Timing> timings;
  std::map<std::string, Table> traces;  ///< by entry
};

Results read_results(const OutputLayout& layout, const ReproductionPlan& plan);

/// The reading "only `augmented` was trained with noise": that model from `with`, the others from
/// `without`.
Scores only_one_augmented(const Scores& with, const Scores& without, const std::string& augmented);

/// The scores in one evaluation document.
ModelScores parse_scores(const Json& document, const std::string& entry);
/// NS of the same document: the same at every level.
ModelScores unidentified(const Json& document, const ModelScores& like);

}  // namespace dcnn
