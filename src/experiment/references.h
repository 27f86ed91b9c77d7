// SPDX-License-Identifier: Apache-2.0
// What a model's error must be seen beside: predicting zero, the rigid tool, the sensor's noise.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"
#include "dcnn/experiment/metrics.h"
#include "dcnn/models/identifier.h"

namespace dcnn {

/// RMSE per target on the same rows, in the targets' units.
struct References {
  std::vector<double> none;   ///< of predicting zero
  std::vector<double> rigid;  ///< of the rigid tool fitted to the same training rows; may be empty
  std::vector<double> noise;  ///< white noise of the measured targets; empty for poses at rest
  std::string rigid_file = {};  ///< the rigid tool as a model, for words
};

/// Standard deviation of the white noise of each column: the median of |third difference| over
/// 0.6745·sqrt(20) (1 + 9 + 9 + 1; smooth motion has no third difference at the sensor's rate).
std::vector<double> white_noise(const Eigen::MatrixXd& measured);

/// The rigid tool on the layout, targets and rows of another model: its inertial parameters where
/// the wrench is whole, so that the body can exist, else regression on its terms. Without a model
/// where these rows do not allow one.
Identifier fit_rigid(const Identifier& like, const Samples& training, const Samples& validation);

/// Where dcnn-train keeps it, in a model's run directory.
std::filesystem::path rigid_file(const std::filesystem::path& model);

/// Which of the two forms of --model rigid stands beside a model, in words.
std::string form_in_words(const Targets& targets);

/// One line that names the targets that are predicted worse than by zero, then whether the model is
/// worse than the rigid tool; empty where nothing is wrong.
std::vector<std::string> warnings(const std::string& model, const std::vector<double>& rmse,
                                  const References& references, const Targets& targets);

struct Evaluation;
struct EvaluationSummary;
/// Gives every summary the rigid tool that it is judged by: that of its own model or, where its
/// file is missing, one with the same derivative, since a causal derivative costs accuracy.
/// `derivatives` are those of `models`, whose summaries follow one another.
void judge_by_rigid_tools(const std::vector<std::filesystem::path>& models,
                          const std::vector<Json>& derivatives, Evaluation& evaluation);
/// A rigid tool as a table shows it: "rigid tool", of several each with its folder.
struct ShownRigid {
  std::string name;
  const Score& score;
};
/// Those whose errors differ.
std::vector<ShownRigid> shown_rigid_tools(const Evaluation& evaluation);
/// The one that a summary is judged by; nullptr without one.
const Score* rigid_of(const EvaluationSummary& summary, const Evaluation& evaluation);
/// Says of which model no rigid tool is shown because its run directory is not beside it, and how
/// to get it; nothing where the rigid tool itself is evaluated.
void note_missing_rigid(const std::vector<std::filesystem::path>& models, Evaluation& evaluation);
/// What an evaluation says first: the warnings() of models whose clean error is above a
/// reference's.
void add_warnings(Evaluation& evaluation);

Json to_json(const References& references);

}  // namespace dcnn
