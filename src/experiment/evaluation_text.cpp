// SPDX-License-Identifier: Apache-2.0
// An evaluation as JSON for machines and as a table for people.
#include <algorithm>
#include <cstdio>

#include "dcnn/core/number.h"
#include "dcnn/experiment/evaluate.h"
#include "experiment/evaluation_table.h"
#include "experiment/levels.h"
#include "experiment/markup.h"
#include "experiment/references.h"

namespace dcnn {
namespace {

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json row_json(const EvaluationRow& row) {
  Json json = {
      {"model", row.model}, {"file", row.file},       {"snr_db", level_json(row.snr_db)},
      {"run", row.run},     {"rmse", row.score.rmse}, {"rmse_overall", or_null(row.score.overall)}};
  if (row.score.overall_torque) json["rmse_overall_torque"] = *row.score.overall_torque;
  return json;
}

Json summary_json(const EvaluationSummary& s, const Score& unidentified) {
  std::vector<double> mean, deviation;
  for (const Spread& axis : s.rmse) {
    mean.push_back(axis.mean);
    deviation.push_back(axis.deviation);
  }
  Json json = {{"model", s.model},
               {"file", s.file},
               {"snr_db", level_json(s.snr_db)},
               {"runs", s.runs},
               {"rmse_mean", mean},
               {"rmse_std", deviation},
               {"rmse_overall_mean", s.overall ? Json(s.overall->mean) : Json()},
               {"rmse_overall_std", s.overall ? Json(s.overall->deviation) : Json()}};
  if (s.overall_torque) {
    json["rmse_overall_torque_mean"] = s.overall_torque->mean;
    json["rmse_overall_torque_std"] = s.overall_torque->deviation;
  }
  if (s.beyond) json["share_beyond_training"] = *s.beyond;
  if (!s.rigid_file.empty()) json["rigid_file"] = s.rigid_file;
  json["max_abs_error"] = s.first.max_abs;
  json["r2"] = s.first.r2;
  json["vector_rmse"] = or_null(s.first.vector_rmse);
  json["ratio_to_unidentified"] = s.overall && unidentified.overall && *unidentified.overall > 0.0
                                      ? Json(s.overall->mean / *unidentified.overall)
                                      : Json();
  return json;
}

std::string cell(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Width of a target's column.
std::size_t column_width(const Evaluation& evaluation) {
  const bool spread = std::any_of(evaluation.summary.begin(), evaluation.summary.end(),
                                  [](const EvaluationSummary& s) { return s.runs > 1; });
  return spread ? 20 : 11;
}

constexpr const char* kUnidentified = "(no identification)";

}  // namespace

Json to_json(const Evaluation& evaluation) {
  Json json = {{"data", evaluation.data},
               {"samples", evaluation.samples},
               {"targets", evaluation.targets.names},
               {"units", evaluation.targets.units},
               {"samples_near_singularity", evaluation.singular_samples},
               {"noise", evaluation.noise},
               {"notes", evaluation.notes},
               {"rows", Json::array()},
               {"summary", Json::array()}};
  for (const auto& row : evaluation.rows) json["rows"].push_back(row_json(row));
  for (const auto& s : evaluation.summary) {
    json["summary"].push_back(summary_json(s, evaluation.unidentified));
  }
  const EvaluationReferences& beside = evaluation.references;
  const RigidReference* rigid = beside.rigid.empty() ? nullptr : &beside.rigid.front();
  json["references"] = {{"none", evaluation.unidentified.rmse},
                        {"rigid", rigid ? Json(rigid->score.rmse) : Json()},
                        {"rigid_overall", rigid ? or_null(rigid->score.overall) : Json()},
                        {"rigid_file", rigid ? Json(rigid->file) : Json()},
                        {"white_noise", beside.noise}};
  for (const RigidReference& one : beside.rigid) {
    json["references"]["rigid_tools"].push_back({{"file", one.file},
                                                 {"derivative", one.derivative},
                                                 {"rmse", one.score.rmse},
                                                 {"rmse_overall", or_null(one.score.overall)}});
  }
  json["warnings"] = beside.warnings;
  json["unidentified"] = {{"rmse", evaluation.unidentified.rmse},
                          {"rmse_overall", or_null(evaluation.unidentified.overall)}};
  if (!evaluation.unfiltered.empty()) {
    json["unfiltered"] = Json::array();
    for (const auto& row : evaluation.unfiltered) json["unfiltered"].push_back(row_json(row));
  }
  return json;
}

std::string to_text(const Evaluation& evaluation) {
  const std::size_t column = column_width(evaluation);
  const std::vector<int> decimals = column_decimals(evaluation);
  std::size_t width = std::string(kUnidentified).size() + 2;
  for (const auto& s : evaluation.summary) width = std::max(width, s.file.size() + 2);
  const std::vector<ShownRigid> rigid_tools = shown_rigid_tools(evaluation);
  for (const ShownRigid& rigid : rigid_tools) width = std::max(width, rigid.name.size() + 4);
  std::string text;
  for (const auto& warning : evaluation.references.warnings) text += warning + "\n";
  text += padded("file", width) + padded("SNR [dB]", 10) + padded("runs", 6);
  for (std::size_t j = 0; j < evaluation.targets.names.size(); ++j) {
    text += padded(
        evaluation.targets.names[j] + " [" + unit_text(evaluation.targets.units[j]) + "]", column);
  }
  text += "overall\n";
  const auto line = [&](const std::string& name, const std::string& level, int runs,
                        const std::vector<Spread>& rmse, const std::optional<Spread>& overall) {
    text += padded(name, width) + padded(level, 10) + padded(std::to_string(runs), 6);
    for (std::size_t j = 0; j < rmse.size(); ++j) {
      text += padded(with_spread(rmse[j], runs, decimals[j]), column);
    }
    text += overall ? with_spread(*overall, runs, decimals.back()) : "-";
    text += "\n";
  };
  for (const auto& s : evaluation.summary) {
    line(s.file, s.snr_db ? cell("%g", *s.snr_db) : "clean", s.runs, s.rmse, s.overall);
  }
  const auto reference = [&](const std::string& name, const std::vector<double>& rmse,
                             const std::optional<double>& overall) {
    text += padded(name, width) + padded("clean", 10) + padded("1", 6);
    for (std::size_t j = 0; j < rmse.size(); ++j)
      text += padded(fixed(rmse[j], decimals[j]), column);
    text += (overall ? fixed(*overall, decimals.back()) : "-") + "\n";
  };
  const auto& beside = evaluation.references;
  for (const ShownRigid& rigid : rigid_tools) {
    reference("(" + rigid.name + ")", rigid.score.rmse, rigid.score.overall);
  }
  reference(kUnidentified, evaluation.unidentified.rmse, evaluation.unidentified.overall);
  reference("(white noise)", beside.noise, std::nullopt);
  for (const auto& row : evaluation.unfiltered) {
    text += row.file + ": against the unfiltered targets, clean:";
    for (const double value : row.score.rmse) text += " " + significant(value, 4);
    text += "\n";
  }
  return text;
}

}  // namespace dcnn
