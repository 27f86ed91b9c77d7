// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/results.h"

#include <algorithm>

namespace dcnn {
namespace {

SnrLevel level_of(const Json& json) {
  return json.is_null() ? SnrLevel() : SnrLevel(json.get<double>());
}

Json read(const std::filesystem::path& file) { return read_json(file, Exit::kFailure); }

/// Scores of all entries under one mode and series.
Scores read_scores(const OutputLayout& layout, const ReproductionPlan& plan,
                   const std::string& mode, const std::string& series) {
  Scores scores;
  for (const Entry& entry : plan.entries) {
    if (entry.name == kNoIdentification) continue;
    const Json document = read(layout.scores(mode, series, entry.name));
    ModelScores model = parse_scores(document, entry.name);
    if (scores.models.empty()) {
      scores.targets = document.at("targets").get<std::vector<std::string>>();
      scores.units = document.at("units").get<std::vector<std::string>>();
      scores.samples = document.at("samples").get<Index>();
      scores.models.push_back(unidentified(document, model));
    }
    scores.models.push_back(std::move(model));
  }
  return scores;
}

void add_timings(const Json& document, const std::string& entry, std::vector<Timing>& timings) {
  for (const Json& row : document.at("rows")) {
    timings.push_back({entry, row.at("length"), row.at("calls"), row.at("mean_s"), row.at("std_s"),
                       row.at("total_s"), row.at("total_std_s"), row.value("p50_s", 0.0),
                       row.value("p99_s", 0.0), row.value("max_s", 0.0),
                       row.value("features_included", false)});
  }
}

}  // namespace

const ModelScores* Scores::find(const std::string& entry) const {
  const auto found = std::find_if(models.begin(), models.end(),
                                  [&](const ModelScores& m) { return m.entry == entry; });
  return found == models.end() ? nullptr : &*found;
}

int Scores::target(const std::string& name) const {
  const auto found = std::find(targets.begin(), targets.end(), name);
  return found == targets.end() ? -1 : static_cast<int>(found - targets.begin());
}

ModelScores parse_scores(const Json& document, const std::string& entry) {
  ModelScores model{entry, {}, {}};
  for (const Json& s : document.at("summary")) {
    LevelScore level{level_of(s.at("snr_db")), s.at("runs"), {}, {}};
    const auto mean = s.at("rmse_mean").get<std::vector<double>>(),
               deviation = s.at("rmse_std").get<std::vector<double>>();
    for (std::size_t j = 0; j < mean.size(); ++j) level.rmse.push_back({mean[j], deviation[j]});
    if (!s.at("rmse_overall_mean").is_null())
      level.overall = Spread{s.at("rmse_overall_mean"), s.at("rmse_overall_std")};
    model.levels.push_back(level);
  }
  for (const Json& row : document.at("rows")) model.rows.push_back(row);
  return model;
}

ModelScores unidentified(const Json& document, const ModelScores& like) {
  ModelScores model{kNoIdentification, like.levels, {}};
  const Json& zero = document.at("unidentified");
  const auto rmse = zero.at("rmse").get<std::vector<double>>();
  for (LevelScore& level : model.levels) {
    level.runs = 1;
    for (std::size_t j = 0; j < rmse.size(); ++j) level.rmse[j] = {rmse[j], 0.0};
    if (level.overall) level.overall = Spread{zero.at("rmse_overall"), 0.0};
    model.rows.push_back({{"snr_db", level.snr_db ? Json(*level.snr_db) : Json()},
                          {"run", 0},
                          {"rmse", rmse},
                          {"rmse_overall", zero.at("rmse_overall")}});
  }
  return model;
}

Scores only_one_augmented(const Scores& with, const Scores& without, const std::string& augmented) {
  Scores mixed = without;
  for (ModelScores& model : mixed.models) {
    if (model.entry != augmented) continue;
    if (const ModelScores* noisy = with.find(augmented)) model = *noisy;
  }
  return mixed;
}

Results read_results(const OutputLayout& layout, const ReproductionPlan& plan) {
  Results results;
  for (const NoiseMode& mode : plan.modes) {
    for (const auto& series : mode.protocols) {
      results.scores[mode.name + "/" + series] = read_scores(layout, plan, mode.name, series);
    }
  }
  for (int k = 1; k <= plan.trainings; ++k) {
    const auto series = further_training(k);
    results.scores[kFurtherTrainings + "/" + series] =
        read_scores(layout, plan, kFurtherTrainings, series);
  }
  for (const Entry& entry : plan.entries) {
    const auto timing = layout.timing(entry.name), trace = layout.trace(entry.name);
    if (std::filesystem::exists(timing)) add_timings(read(timing), entry.name, results.timings);
    if (std::filesystem::exists(trace)) results.traces[entry.name] = read_csv(trace);
  }
  return results;
}

}  // namespace dcnn
