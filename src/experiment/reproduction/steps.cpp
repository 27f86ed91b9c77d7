#include "experiment/reproduction/steps.h"

#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "dcnn/experiment/bench.h"
#include "dcnn/experiment/train.h"
#include "dcnn/physics/scenario.h"
#include "experiment/reproduction/scoring.h"

namespace dcnn {
namespace {

constexpr std::size_t kMaxDataBytes = std::size_t{4} << 30;

/// What is left of another configuration, data set or version of the code cannot be gone on from.
void forget_foreign_run(const std::filesystem::path& model, const std::string& identity) {
  auto begun = model;
  begun.replace_extension(".begun");
  const bool same =
      std::filesystem::exists(begun) && read_file(begun, 1000, Exit::kFailure) == identity + "\n";
  if (same) return;
  std::error_code error;
  std::filesystem::remove_all(run_directory(model), error);
  require(!error, Exit::kFailure, run_directory(model).string(), ": cannot remove");
  write_file(begun, identity + "\n");
}

double training_share(const TrainingProgress& p) {
  if (p.finished)
    return static_cast<double>(p.epoch) / static_cast<double>(std::max<Index>(p.epochs, 1));
  const double within =
      p.steps > 0 ? static_cast<double>(p.step) / static_cast<double>(p.steps) : 0.0;
  return (static_cast<double>(p.epoch - 1) + within) /
         static_cast<double>(std::max<Index>(p.epochs, 1));
}

void run_training(const TrainingRequest& request, const StepSession& session) {
  forget_foreign_run(request.out, session.identity);
  TrainingObserver observer;
  observer.stop_wanted = session.stop_wanted;
  observer.note = session.note;
  observer.progress = [&](const TrainingProgress& p) { session.progress(training_share(p)); };
  if (!train(request, observer).finished) throw Stopped{};
}

}  // namespace

Workshop::Workshop(const ReproductionRequest& request, const ReproductionPlan& plan)
    : request_(request), plan_(plan), layout_{request.out} {}

std::filesystem::path Workshop::training_data() const {
  return request_.data.empty() ? layout_.data() / "train.csv" : request_.data.at(0);
}

std::filesystem::path Workshop::test_data() const {
  return request_.data.empty() ? layout_.data() / "test.csv" : request_.data.at(1);
}

const std::string& Workshop::data_hash(const std::filesystem::path& file) {
  for (const auto& [known, hash] : hashes_) {
    if (known == file) return hash;
  }
  hashes_.emplace_back(file, sha256_hex({read_file(file, kMaxDataBytes, Exit::kData)}));
  return hashes_.back().second;
}

std::string Workshop::code() const { return DCNN_VERSION " " + request_.commit; }

Step Workshop::simulation() {
  Step step;
  step.name = "simulated recordings";
  step.seconds = 2;
  step.files = {training_data(), test_data()};
  step.inputs = [this] { return code() + read_json(request_.scene, Exit::kUsage).dump(); };
  step.work = [this](const StepSession&) {
    const Json scene = read_json(request_.scene, Exit::kUsage);
    const Scenario scenario = simulate_config(scene, request_.scene.string());
    write_scenario(scenario, layout_.data());
    for (const auto& path : {training_data(), test_data()}) {
      require(std::filesystem::exists(path), Exit::kUsage, request_.scene.string(),
              ": must simulate recordings named 'train' and 'test'");
    }
    hashes_.clear();
  };
  return step;
}

/// Rigid-body frames are given to frame-tcn, how the sensor is mounted among them; all other kinds
/// find it out.
Json Workshop::features_of(const Entry& entry) const {
  if (entry.kind != "frame-tcn" || !request_.data.empty()) return Json::object();
  const Json scene = read_json(request_.scene, Exit::kUsage);
  const Json simulator = scene.value("simulator", Json::object());
  const Json sensor = simulator.value("sensor", Json::object());
  if (!sensor.contains("rotation_rpy")) return Json::object();
  return {{"features", {{"sensor_rotation_rpy", sensor["rotation_rpy"]}}}};
}

Json Workshop::configuration(const Training& what) const {
  const Json own = what.entry->configuration.is_null() ? Json::object() : what.entry->configuration;
  return merged(merged(own, features_of(*what.entry)), {{"preset", request_.preset},
                                                        {"model", {{"name", what.entry->kind}}},
                                                        {"noise", what.noise},
                                                        {"seed", what.seed}});
}

std::string Workshop::training_inputs(const Training& what) {
  Json epochs = what.epochs ? Json(*what.epochs) : Json();
  return code() + " " + configuration(what).dump() + " " + epochs.dump() + " " +
         std::to_string(request_.read.force_sign) + " " +
         std::to_string(request_.read.position_unit) + " " +
         std::to_string(request_.read.angle_unit) + " " +
         std::to_string(request_.read.resample_hz) + " " + data_hash(training_data());
}

Step Workshop::training(const Training& what) {
  Step step;
  const auto file = layout_.model(what.series, what.entry->name);
  step.name = what.series + "/" + what.entry->name + ": training";
  step.seconds = what.entry->training_s * training_factor(request_.preset, *what.entry);
  step.files = {file};
  step.inputs = [this, what] { return training_inputs(what); };
  step.work = [this, what, file](const StepSession& session) {
    auto config = file;
    config.replace_extension(".json");
    write_file(config, configuration(what).dump(2) + "\n");
    TrainingRequest request;
    request.configuration.file = config;
    const Json preset = model_kind(what.entry->kind, Exit::kUsage).preset(request_.preset, false);
    if (preset.contains("training") && preset["training"].contains("epochs"))
      request.configuration.epochs = what.epochs;
    request.training = {training_data()};
    request.read = request_.read;
    request.out = file;
    request.resume = true;
    run_training(request, session);
  };
  return step;
}

Step Workshop::scoring(const NoiseMode& mode, const Training& what) {
  Step step;
  step.name = what.series + "/" + what.entry->name + ": scoring, " + mode.name;
  const double share = what.entry->looks_back ? 1.0 : 1.0 / static_cast<double>(mode.every);
  const double passes = 1.0 + 4.0 * mode.draws * share;
  step.seconds = what.entry->pass_s * passes;
  const auto file = layout_.scores(mode.name, what.series, what.entry->name);
  const bool traced = mode.name == "feature" && what.series == "A";
  step.files = {file};
  if (traced) step.files.push_back(layout_.trace(what.entry->name));
  step.inputs = [this, mode, what] {
    return training_inputs(what) + " " + data_hash(test_data()) + " " + std::to_string(mode.draws) +
           " " + std::to_string(mode.every) + " " + std::to_string(request_.seed);
  };
  step.work = [this, mode, what, file, traced](const StepSession& session) {
    EvaluationRequest request = scoring_request(mode);
    request.models = {layout_.model(what.series, what.entry->name)};
    request.data = {test_data()};
    request.levels = plan_.levels;
    request.seed = request_.seed;
    request.read = request_.read;
    const Evaluation evaluation = evaluate(request, [&](int done, int total) {
      if (session.stop_wanted && session.stop_wanted()) throw Stopped{};
      session.progress(static_cast<double>(done) / total);
    });
    if (traced) write_trace(layout_.trace(what.entry->name), evaluation);
    write_file(file, to_json(evaluation).dump(1) + "\n");
  };
  return step;
}

/// Times do not depend on how a model was trained: those of protocol A.
Step Workshop::timing(const Entry& entry) {
  Step step;
  const Training what{plan_.protocols.front().name, &entry, plan_.protocols.front().noise,
                      request_.seed, request_.epochs};
  const int repetitions =
      entry.name == "lstm-25" ? plan_.timing.repetitions_lstm_25 : plan_.timing.repetitions;
  step.name = entry.name + ": time";
  step.seconds = 4 * entry.pass_s * repetitions * static_cast<double>(plan_.timing.samples) / 32045;
  const auto file = layout_.timing(entry.name);
  step.files = {file};
  step.inputs = [this, what, repetitions] {
    return training_inputs(what) + " " + data_hash(test_data()) + " " +
           std::to_string(repetitions) + " " + std::to_string(plan_.timing.samples);
  };
  step.work = [this, what, file, repetitions](const StepSession& session) {
    BenchRequest request;
    request.models = {layout_.model(what.series, what.entry->name)};
    if (plan_.timing.samples == kPaperTestSamples) request.data = test_data();
    request.samples = plan_.timing.samples;
    request.repetitions = repetitions;
    request.seed = request_.seed;
    request.read = request_.read;
    const Bench result = bench(request, [&](int done, int total) {
      if (session.stop_wanted && session.stop_wanted()) throw Stopped{};
      session.progress(static_cast<double>(done) / total);
    });
    write_file(file, to_json(result).dump(1) + "\n");
  };
  return step;
}

/// A third of the epochs: what a training costs is what limits how many there can be.
Workshop::Training Workshop::further(const Entry& entry, int k) const {
  const Json preset = model_kind(entry.kind, Exit::kUsage).preset(request_.preset, false);
  const Index epochs = preset.value("training", Json::object()).value("epochs", Index{3});
  return {further_training(k), &entry, plan_.protocols.front().noise,
          request_.seed + static_cast<std::uint64_t>(k),
          request_.epochs.value_or(std::max<Index>(1, epochs / 3))};
}

std::vector<Step> Workshop::steps() {
  std::vector<Step> steps;
  if (request_.data.empty()) steps.push_back(simulation());
  const auto for_each_trained = [&](const auto& work) {
    for (const Entry& entry : plan_.entries) {
      if (entry.name != kNoIdentification) work(entry);
    }
  };
  for (const Protocol& protocol : plan_.protocols) {
    for_each_trained([&](const Entry& entry) {
      const Training what{protocol.name, &entry, protocol.noise, request_.seed, request_.epochs};
      steps.push_back(training(what));
      for (const NoiseMode& mode : plan_.modes) {
        const auto& in = mode.protocols;
        if (std::find(in.begin(), in.end(), protocol.name) != in.end())
          steps.push_back(scoring(mode, what));
      }
    });
  }
  const NoiseMode once{kFurtherTrainings, "", {}, 1, 4};
  for (int k = 1; k <= plan_.trainings; ++k) {
    for_each_trained([&](const Entry& entry) {
      steps.push_back(training(further(entry, k)));
      steps.push_back(scoring(once, further(entry, k)));
    });
  }
  // Last: timing leaves the process on one thread, pinned to its processor.
  for_each_trained([&](const Entry& entry) {
    if (timed(entry)) steps.push_back(timing(entry));
  });
  return steps;
}

}  // namespace dcnn
