// SPDX-License-Identifier: Apache-2.0
// --model auto: the best of several identifiers on rows that none was fitted to.
#include <algorithm>
#include <optional>

#include "dcnn/core/file.h"
#include "dcnn/experiment/train.h"
#include "experiment/markup.h"
#include "experiment/references.h"
#include "experiment/train_physics.h"
#include "experiment/training_checks.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPhysics = "physics";
constexpr const char* kReference = "rigid tool";
constexpr const char* kTried[] = {"rigid", kPhysics, "mlp", "dcnn"};
constexpr std::size_t kMostBytes = std::size_t{64} << 20;  // of a model file

struct Tried {
  std::string model;
  fs::path file;
  Json summary;
  double error = 0.0;  ///< mean over targets of the RMSE over that of predicting zero
};

/// `references`: those of a model that predicts the whole force.
double relative_error(const Json& summary, const Json& references) {
  const auto rmse = summary["validation_rmse"].get<std::vector<double>>();
  const auto none = references["none"].get<std::vector<double>>();
  double sum = 0.0;
  for (std::size_t j = 0; j < rmse.size(); ++j) sum += rmse[j] / std::max(none[j], 1e-300);
  return sum / static_cast<double>(rmse.size());
}

void copy_model(const fs::path& from, const fs::path& to) {
  if (fs::exists(from)) write_file(to, read_file(from, kMostBytes, Exit::kModel));
}

/// The two rigid ones told apart: one is trained like the others, the other is their reference.
std::string told_apart(const Tried& one) {
  if (one.model == "rigid") return "rigid (trained like the others)";
  if (one.model != kReference) return one.model;
  return one.model + " (the reference, " +
         form_in_words({one.summary["targets"], one.summary["units"]}) + ")";
}

Json choice(const std::vector<Tried>& tried, const Tried& best) {
  Json rows = Json::array();
  std::string words;
  for (const Tried& one : tried) {
    rows.push_back({{"model", one.model},
                    {"relative_error", one.error},
                    {"validation_rmse", one.summary["validation_rmse"]}});
    if (one.model != best.model) {
      words += (words.empty() ? "" : ", ") + told_apart(one) + " " +
               significant(100.0 * one.error, 3) + " %";
    }
  }
  return {{"model", best.model},
          {"tried", rows},
          {"why", "chosen: " + told_apart(best) + ", whose error on the validation rows is " +
                      significant(100.0 * best.error, 3) +
                      " % of that of predicting zero (mean over the targets); " + words}};
}

std::string why_no_physics(const TrainingRequest& request) {
  return std::string(kPhysics) + " is left out: " +
         (request.configuration.online
              ? "with --online a model learns its limits; dcnn-run takes model.json of "
                "dcnn-diagnose"
              : "it is tried for a tool on a wrist; dcnn-diagnose corrects machines of axes");
}

/// Trains one of them; nothing where the recordings suffice for an earlier one and not for it.
std::optional<TrainingOutcome> attempt(const TrainingRequest& request, bool is_first,
                                       const TrainingObserver& observer) {
  const std::string model = *request.configuration.model;
  try {
    if (model != kPhysics) return train(request, observer);
    return train_physics(request, request.out.parent_path() / kPhysics, observer);
  } catch (const Error& error) {
    if (is_first || error.exit() != Exit::kData) throw;
    if (observer.note) observer.note(model + " is left out: " + error.what());
    return std::nullopt;
  }
}

/// The corrected simulator was compared with what it leaves itself: here it is beside the
/// references of the others.
void compare_with(const Json& references, const std::string& file, Json& summary) {
  References beside{references["none"], {}, references["white_noise"]};
  if (!references["rigid"].is_null()) beside.rigid = references["rigid"];
  summary["model"] = kPhysics;
  summary["references"] = references;
  summary["warnings"] =
      warnings(file, summary["validation_rmse"], beside, {summary["targets"], summary["units"]});
  summary.erase("trust");
}

/// The rigid tool that stands beside every model: noise-free, a body that can exist. It has no
/// limits of its training, so it does not run online.
std::optional<Tried> rigid_tool(const TrainingRequest& request, const Tried& like) {
  const fs::path file = rigid_file(like.file);
  const Json& rmse = like.summary["references"]["rigid"];
  if (request.configuration.online || rmse.is_null() || !fs::exists(file)) return std::nullopt;
  Tried tool{kReference, file, like.summary};
  tool.summary["model"] = "rigid";
  tool.summary["validation_rmse"] = rmse;
  tool.summary["parameters"] = read_identifier(file).model->parameter_count();
  tool.summary["warnings"] = Json::array();
  tool.error = relative_error(tool.summary, like.summary["references"]);
  return tool;
}

}  // namespace

TrainingOutcome train_best(const TrainingRequest& request, const TrainingObserver& observer) {
  const fs::path folder = run_directory(request.out);
  std::vector<Tried> tried;
  const bool list = !has_time(read_table(request.training.front()).table);
  for (const char* model : kTried) {
    const bool physics = model == std::string(kPhysics);
    if (physics && !can_be_physics(request)) {
      if (observer.note) observer.note(why_no_physics(request));
      continue;
    }
    if (list && (physics || !model_kind(model, Exit::kUsage).takes_static_lists)) {
      if (observer.note) observer.note(std::string(model) + " is left out: it learns from motion");
      continue;
    }
    TrainingRequest one = request;
    one.configuration.model = model;
    if (std::string(model) == "rigid") one.configuration.epochs.reset();  // has none
    one.out = folder / (std::string(model) + "_tried.dcnn");
    if (observer.note) {
      observer.note(std::string("trying ") + model +
                    (physics ? ": the tool identified, then corrected by a diagnosis" : ""));
    }
    std::optional<TrainingOutcome> outcome = attempt(one, tried.empty(), observer);
    if (!outcome) continue;
    if (!outcome->finished) return *outcome;
    require(outcome->summary.contains("references"), Exit::kUsage,
            "--model auto compares models on validation rows; give --valid, or a "
            "training.validation above 0");
    if (physics) {
      compare_with(tried.front().summary["references"], request.out.filename().string(),
                   outcome->summary);
    }
    const Json& references =
        tried.empty() ? outcome->summary["references"] : tried.front().summary["references"];
    const double error = relative_error(outcome->summary, references);
    tried.push_back({model, one.out, std::move(outcome->summary), error});
  }
  if (auto tool = rigid_tool(request, tried.front())) tried.push_back(std::move(*tool));
  const Tried* best = &tried.front();
  for (const Tried& one : tried) {
    if (one.error < best->error) best = &one;
  }
  copy_model(best->file, request.out);
  copy_model(rigid_file(tried.front().file), rigid_file(request.out));
  TrainingOutcome outcome{true, best->summary};
  outcome.summary["file"] = request.out.string();
  outcome.summary["run_directory"] = folder.string();
  outcome.summary["choice"] = choice(tried, *best);
  write_file(folder / "choice.json", outcome.summary["choice"].dump(2) + "\n");
  return outcome;
}

}  // namespace dcnn
