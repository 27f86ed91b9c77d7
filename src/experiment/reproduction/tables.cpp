// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/tables.h"

#include <cstdio>
#include <sstream>

#include "dcnn/core/file.h"
#include "dcnn/experiment/train.h"
#include "experiment/levels.h"
#include "experiment/reproduction/paper_times.h"

namespace dcnn {
namespace {

std::string decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// One line per draw: level,model,run,<targets>,overall.
std::string draws_csv(const Scores& scores) {
  std::string text = "level,model,run";
  for (const auto& name : scores.targets) text += "," + name;
  text += ",overall\n";
  for (const ModelScores& model : scores.models) {
    for (const Json& row : model.rows) {
      text += (row.at("snr_db").is_null() ? "clean" : decimal(row.at("snr_db"))) + "," +
              model.entry + "," + std::to_string(row.at("run").get<int>());
      for (const Json& value : row.at("rmse")) text += "," + decimal(value);
      text +=
          "," + (row.at("rmse_overall").is_null() ? "" : decimal(row.at("rmse_overall"))) + "\n";
    }
  }
  return text;
}

std::string timing_csv(const std::vector<Timing>& timings) {
  std::string text =
      "model,length,calls,mean_s,std_s,total_s,total_std_s,p50_s,p99_s,max_s,features_included,"
      "paper_mean_s,"
      "paper_total_s\n";
  for (const Timing& t : timings) {
    text += t.entry + "," + std::to_string(t.length) + "," + std::to_string(t.calls);
    for (const double value :
         {t.mean_s, t.std_s, t.total_s, t.total_std_s, t.p50_s, t.p99_s, t.max_s})
      text += "," + decimal(value);
    text += t.from_pose ? ",true" : ",false";
    const PaperTime* paper = paper_time(t.entry, t.length);
    text += paper ? "," + decimal(paper->mean_s) + "," + decimal(paper->total_s) + "\n" : ",,\n";
  }
  return text;
}

Json timing_json(const std::vector<Timing>& timings) {
  Json rows = Json::array();
  for (const Timing& t : timings) {
    rows.push_back({{"model", t.entry},
                    {"length", t.length},
                    {"calls", t.calls},
                    {"mean_s", t.mean_s},
                    {"std_s", t.std_s},
                    {"total_s", t.total_s},
                    {"total_std_s", t.total_std_s},
                    {"p50_s", t.p50_s},
                    {"p99_s", t.p99_s},
                    {"max_s", t.max_s},
                    {"features_included", t.from_pose}});
  }
  return {{"rows", rows}};
}

/// Epochs of all models of a series: model,epoch,loss,validation RMSE per target.
Json training_curves(const OutputLayout& layout, const ReproductionPlan& plan,
                     const std::string& series) {
  Json curves = Json::array();
  for (const Entry& entry : plan.entries) {
    const auto path = run_directory(layout.model(series, entry.name)) / "metrics.jsonl";
    if (!std::filesystem::exists(path)) continue;
    std::istringstream lines(read_file(path, std::size_t{64} << 20, Exit::kData));
    for (std::string line; std::getline(lines, line);) {
      Json record = {{"model", entry.name}};
      record.update(parse_json(line, path.string(), Exit::kData));
      curves.push_back(record);
    }
  }
  return curves;
}

std::string curves_csv(const Json& curves, const std::vector<std::string>& targets) {
  std::string text = "model,epoch,loss";
  for (const auto& name : targets) text += ",validation_" + name;
  text += "\n";
  for (const Json& record : curves) {
    text += record.at("model").get<std::string>() + "," +
            std::to_string(record.at("epoch").get<Index>()) + "," +
            decimal(record.at("loss").get<double>());
    const auto rmse = record.value("validation_rmse", std::vector<double>{});
    for (std::size_t j = 0; j < targets.size(); ++j)
      text += "," + (j < rmse.size() ? decimal(rmse[j]) : "");
    text += "\n";
  }
  return text;
}

}  // namespace

Json to_json(const std::vector<Claim>& claims) {
  Json list = Json::array();
  for (const Claim& claim : claims) {
    const bool tested = claim.verdict != Claim::Verdict::kNotTested;
    list.push_back({{"id", claim.id},
                    {"text", claim.text},
                    {"holds", tested ? Json(claim.verdict == Claim::Verdict::kHolds) : Json()},
                    {"numbers", claim.numbers}});
  }
  return list;
}

Json to_json(const Scores& scores) {
  Json summary = Json::array();
  for (const ModelScores& model : scores.models) {
    for (const LevelScore& level : model.levels) {
      std::vector<double> mean, deviation;
      for (const Spread& axis : level.rmse) {
        mean.push_back(axis.mean);
        deviation.push_back(axis.deviation);
      }
      summary.push_back(
          {{"model", model.entry},
           {"snr_db", level_json(level.snr_db)},
           {"runs", level.runs},
           {"rmse_mean", mean},
           {"rmse_std", deviation},
           {"rmse_overall_mean", level.overall ? Json(level.overall->mean) : Json()},
           {"rmse_overall_std", level.overall ? Json(level.overall->deviation) : Json()}});
    }
  }
  return {{"targets", scores.targets},
          {"units", scores.units},
          {"samples", scores.samples},
          {"summary", summary}};
}

void write_tables(const OutputLayout& layout, const ReproductionPlan& plan,
                  const Results& results) {
  const auto folder = layout.out / "figures";
  for (const auto& [name, scores] : results.scores) {
    std::string stem = "noise_" + name;
    for (char& c : stem) {
      if (c == '/') c = '_';
    }
    write_file(folder / (stem + ".csv"), draws_csv(scores));
    write_file(folder / (stem + ".json"), to_json(scores).dump(1) + "\n");
  }
  write_file(folder / "table1.csv", timing_csv(results.timings));
  write_file(folder / "table1.json", timing_json(results.timings).dump(1) + "\n");
  const auto& targets = results.scores.begin()->second.targets;
  for (const Protocol& protocol : plan.protocols) {
    const Json curves = training_curves(layout, plan, protocol.name);
    write_file(folder / ("training_" + protocol.name + ".csv"), curves_csv(curves, targets));
    write_file(folder / ("training_" + protocol.name + ".json"), curves.dump(1) + "\n");
  }
}

}  // namespace dcnn
