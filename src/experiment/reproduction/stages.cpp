// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/stages.h"

#include "dcnn/core/file.h"
#include "dcnn/experiment/bench.h"
#include "dcnn/experiment/configuration.h"
#include "dcnn/models/model.h"
#include "experiment/reproduction/layout.h"

namespace dcnn {
namespace {

using Words = std::vector<std::string>;

struct TrainingCell {
  std::string series;  ///< a protocol, or a further training
  const Entry* entry;
  Json noise;
  std::uint64_t seed;
  std::optional<Index> epochs;
};

Json cell_of(const std::string& name, const Words& command, const Words& keep) {
  return {{"name", name},
          {"commands", Json::array({Json(command)})},
          {"keep", Json(keep)},
          {"drop", Json::array({"stdout"})}};
}

void add(ReproductionStage& stage, Json cell, double seconds) {
  stage.seconds[cell["name"].get<std::string>()] = seconds;
  stage.cells.push_back(std::move(cell));
}

Words& append(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::string level_words(const std::vector<SnrLevel>& levels) {
  std::string text;
  for (const SnrLevel& level : levels) {
    text += (text.empty() ? "" : ",") + (level ? Json(*level).dump() : std::string("clean"));
  }
  return text;
}

class CellsOfReproduction {
 public:
  CellsOfReproduction(const ReproductionRequest& request, const ReproductionPlan& plan)
      : request_(request),
        plan_(plan),
        seed_(std::to_string(request.seed)),
        training_data_("in/" + recording_place(request, RecordingPart::kTraining)),
        test_data_("in/" + recording_place(request, RecordingPart::kTest)) {}

  Json recordings() const {
    Json cell =
        cell_of("data", {"dcnn-sim", "-q", "--config", "scene.json", "--out", "out"}, {"*"});
    cell["files"] = {{"scene.json", read_json(request_.scene, Exit::kUsage)}};
    return cell;
  }

  Json training(const TrainingCell& what) const {
    const std::string& name = what.entry->name;
    Words command{"dcnn-train", "-q",           "--config", "config.json",
                  "--train",    training_data_, "--out",    "out/" + name + ".dcnn"};
    const Json preset = model_kind(what.entry->kind, Exit::kUsage).preset(request_.preset, false);
    if (what.epochs && preset.contains("training") && preset["training"].contains("epochs"))
      append(command, {"--epochs", std::to_string(*what.epochs)});
    append(command, request_.accept);
    Json cell = cell_of(OutputLayout::training(what.series, name), append(command, request_.read),
                        {name + ".dcnn", name + ".run/metrics.jsonl"});
    cell["files"] = {{"config.json", configuration(what)}};
    return cell;
  }

  Json scoring(const NoiseMode& mode, const std::string& series, const Entry& entry) const {
    const bool traced = mode.name == "feature" && series == "A";
    Words command{"dcnn-eval",
                  "-q",
                  model(series, entry),
                  "--data",
                  test_data_,
                  "--snr",
                  level_words(plan_.levels),
                  "--runs",
                  std::to_string(mode.draws),
                  "--every",
                  std::to_string(mode.every),
                  "--seed",
                  seed_,
                  "--out",
                  "out"};
    if (mode.name == "matlab") append(command, {"--noise-mode", "matlab"});
    if (mode.name == "pose" || mode.name == "entries") append(command, {"--noise-on", mode.name});
    if (traced) append(command, {"--trace", "out/trace.csv"});
    return cell_of(OutputLayout::scoring(mode.name, series, entry.name),
                   append(command, request_.read), {"evaluation.json", "trace.csv"});
  }

  /// Times do not depend on how a model was trained: those of protocol A.
  Json timing(const Entry& entry) const {
    Words command{"dcnn-bench",
                  "-q",
                  model(plan_.protocols.front().name, entry),
                  "--repetitions",
                  std::to_string(repetitions(entry)),
                  "--seed",
                  seed_,
                  "--out",
                  "out"};
    if (plan_.timing.samples == kPaperTestSamples)
      append(append(command, {"--data", test_data_}), request_.read);
    else
      append(command, {"--samples", std::to_string(plan_.timing.samples)});
    return cell_of(OutputLayout::timing_of(entry.name), command, {"bench.json"});
  }

  int repetitions(const Entry& entry) const {
    return entry.name == "lstm-25" ? plan_.timing.repetitions_lstm_25 : plan_.timing.repetitions;
  }

  TrainingCell first(const Protocol& protocol, const Entry& entry) const {
    return {protocol.name, &entry, protocol.noise, request_.seed, request_.epochs};
  }

  /// A third of the epochs: what a training costs is what limits how many there can be.
  TrainingCell further(const Entry& entry, int k) const {
    const Json preset = model_kind(entry.kind, Exit::kUsage).preset(request_.preset, false);
    const Index epochs = preset.value("training", Json::object()).value("epochs", Index{3});
    return {further_training(k), &entry, plan_.protocols.front().noise,
            request_.seed + static_cast<std::uint64_t>(k),
            request_.epochs.value_or(std::max<Index>(1, epochs / 3))};
  }

 private:
  static std::string model(const std::string& series, const Entry& entry) {
    return OutputLayout{"in"}.model(series, entry.name).string();
  }

  /// Rigid-body frames are given to frame-tcn, how the sensor is mounted among them; all other
  /// kinds find it out.
  Json features_of(const Entry& entry) const {
    if (entry.kind != "frame-tcn" || !request_.data.empty()) return Json::object();
    const Json scene = read_json(request_.scene, Exit::kUsage);
    const Json simulator = scene.value("simulator", Json::object());
    const Json sensor = simulator.value("sensor", Json::object());
    if (!sensor.contains("rotation_rpy")) return Json::object();
    return {{"features", {{"sensor_rotation_rpy", sensor["rotation_rpy"]}}}};
  }

  Json configuration(const TrainingCell& what) const {
    const Entry& entry = *what.entry;
    const Json own = entry.configuration.is_null() ? Json::object() : entry.configuration;
    return merged(merged(own, features_of(entry)), {{"preset", request_.preset},
                                                    {"model", {{"name", entry.kind}}},
                                                    {"noise", what.noise},
                                                    {"seed", what.seed}});
  }

  const ReproductionRequest& request_;
  const ReproductionPlan& plan_;
  std::string seed_, training_data_, test_data_;
};

}  // namespace

std::string recording_place(const ReproductionRequest& request, RecordingPart part) {
  const std::size_t k = part == RecordingPart::kTraining ? 0 : 1;
  const std::string name = k == 0 ? "data/train" : "data/test";
  return name + (request.data.empty() ? ".csv" : request.data.at(k).extension().string());
}

std::vector<ReproductionStage> reproduction_stages(const ReproductionRequest& request,
                                                   const ReproductionPlan& plan) {
  const CellsOfReproduction cells(request, plan);
  ReproductionStage recordings, trainings, scores, times;
  recordings.name = "recordings", trainings.name = "trainings";
  scores.name = "scores", times.name = "times";
  times.one_at_a_time = true;
  if (request.data.empty()) add(recordings, cells.recordings(), 2.0);
  const auto train_and_score = [&](const TrainingCell& what, const std::vector<NoiseMode>& modes) {
    const Entry& entry = *what.entry;
    add(trainings, cells.training(what), entry.training_s * training_factor(request.preset, entry));
    for (const NoiseMode& mode : modes) {
      const double share = entry.looks_back ? 1.0 : 1.0 / static_cast<double>(mode.every);
      add(scores, cells.scoring(mode, what.series, entry),
          entry.pass_s * (1.0 + 4.0 * mode.draws * share));
    }
  };
  for (const Entry& entry : plan.entries) {
    if (entry.name == kNoIdentification) continue;
    for (const Protocol& protocol : plan.protocols) {
      std::vector<NoiseMode> modes = plan.modes;
      std::erase_if(modes, [&](const NoiseMode& mode) {
        const auto& in = mode.protocols;
        return std::find(in.begin(), in.end(), protocol.name) == in.end();
      });
      train_and_score(cells.first(protocol, entry), modes);
    }
    for (int k = 1; k <= plan.trainings; ++k)
      train_and_score(cells.further(entry, k), {{kFurtherTrainings, "", {}, 1, 4}});
    if (!timed(entry)) continue;
    add(times, cells.timing(entry),
        4 * entry.pass_s * cells.repetitions(entry) * static_cast<double>(plan.timing.samples) /
            static_cast<double>(kPaperTestSamples));
  }
  std::vector<ReproductionStage> stages{recordings, trainings, scores, times};
  std::erase_if(stages, [](const ReproductionStage& stage) { return stage.cells.empty(); });
  return stages;
}

}  // namespace dcnn
