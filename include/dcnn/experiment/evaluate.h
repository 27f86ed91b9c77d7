// SPDX-License-Identifier: Apache-2.0
// RMSE of trained identifiers over levels of input noise.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/experiment/metrics.h"
#include "dcnn/models/identifier.h"

namespace dcnn {

struct EvaluationRequest {
  std::vector<std::filesystem::path> models, data;
  std::vector<SnrLevel> levels{std::nullopt, 40.0, 30.0, 20.0, 10.0};
  int runs = 20;  ///< noise draws per level; a clean level has one
  std::uint64_t seed = 1;
  bool matlab_noise =
      false;  ///< awgn(X, snr, 'measured'): one power over the whole matrix, with its mean
  /// kPose: on the pose before it is differentiated; the part of a base simulator stays clean.
  NoiseSpec::Signal noise_on = NoiseSpec::Signal::kFeatures;
  /// On the entries of X* instead, of models on the map of Eq. 7: a leak. Others see it on X.
  bool noisy_entries = false;
  Index every = 1;  ///< the first and every so manyth row after it are scored
  ReadOptions read;
  Precision precision = Precision::kSingle;  ///< of the models' predictions
};

/// One model scored once.
struct EvaluationRow {
  std::string model, file;
  SnrLevel snr_db;
  int run = 0;
  Score score;
};

/// All runs of one model at one level.
struct EvaluationSummary {
  std::string model, file;
  SnrLevel snr_db;
  int runs = 0;
  std::vector<Spread> rmse;
  std::optional<Spread> overall, overall_torque;
  Score first;  ///< of run 0: largest error, R^2
  /// Share of the rows whose motion is unlike the training (Model::novelty() above 1), of run 0.
  std::optional<double> beyond;
  /// The rigid tool that it is judged by, as RigidReference::file; empty where there is none.
  std::string rigid_file = {};
};

/// A rigid tool that dcnn-train fitted beside a model, on the model's own features.
struct RigidReference {
  std::string file;
  Json derivative;  ///< of these features
  Score score;
};

/// What the errors must be seen beside, on the same rows without added noise.
struct EvaluationReferences {
  std::vector<RigidReference> rigid;  ///< of the models in their order, where its file is there
  std::vector<double> noise;          ///< white noise of the measured targets
  std::vector<std::string> warnings;  ///< models worse than their rigid tool or than nothing
};

/// What a model said on the first recording without noise: for figures.
struct Trace {
  std::string model;
  Eigen::VectorXd t;
  Eigen::MatrixXd measured, predicted;
};

struct Evaluation {
  std::vector<std::string> data, notes;
  std::string noise;  ///< what the noise was added to, and its power
  Index samples = 0,
        singular_samples = 0;  ///< rows scored, and those of them near the Euler singularity
  Targets targets;
  std::vector<EvaluationRow> rows;
  std::vector<EvaluationSummary> summary;
  Score unidentified;  ///< of the prediction zero (NS)
  EvaluationReferences references;
  std::vector<EvaluationRow>
      unfiltered;  ///< against the raw targets where the system low-passes them
  std::vector<Trace> traces;
};

/// The noise of (level, run) is the same for all models with the same features.
Evaluation evaluate(const EvaluationRequest& request,
                    const std::function<void(int done, int total)>& progress);

/// Measured and predicted forces of the first trace as CSV: columns t, the targets, the targets
/// with
/// `_hat`; evenly thinned to at most 4096 rows.
void write_trace(const std::filesystem::path& file, const Evaluation& evaluation);

/// The document that dcnn-eval prints, and the same as a table for people.
Json to_json(const Evaluation& evaluation);
std::string to_text(const Evaluation& evaluation);

/// Figures and tables as one HTML page; `settings` lists everything the numbers depend on.
std::string to_html(const Evaluation& evaluation, const EvaluationRequest& request);

}  // namespace dcnn
