// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/evaluate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "experiment/references.h"
#include "experiment/test_noise.h"

namespace dcnn {
namespace {

TestSet make_test_set(const Identifier& identifier, const std::vector<Recording>& recordings) {
  TestSet set;
  for (const Recording& recording : recordings) {
    const Features features = make_features(recording, identifier.layout);
    set.singular += features.invalid_count();
    for (const Segment& segment : recording.segments) {
      const Index before = set.stream.rows();
      set.stream.segments.push_back({before + segment.begin, before + segment.end});
    }
    stack(set.stream.x, features.x);
    const System& system = identifier.layout.system;
    stack(set.wanted, measured(recording, identifier.targets, system));
    stack(set.unfiltered, measured(recording, identifier.targets, system, false));
    stack(set.base, identifier.base_prediction(recording));
  }
  set.first_rows = recordings.front().samples();
  set.first_t = recordings.front().has("t")
                    ? recordings.front().column("t")
                    : Eigen::VectorXd::LinSpaced(set.first_rows, 0, double(set.first_rows - 1));
  return set;
}

/// The parts of a test set that are scored.
TestSet thinned(TestSet set, Index every) {
  if (every == 1) return set;
  for (auto* part : {&set.wanted, &set.unfiltered, &set.base}) *part = every_kth(*part, every);
  set.first_rows = (set.first_rows + every - 1) / every;
  set.first_t = every_kth(set.first_t, every);
  return set;
}

/// Predictions for every so manyth row; all rows are predicted where they depend on one another.
Eigen::MatrixXd predict_every(const Model& model, Stream stream, Index every) {
  if (every == 1) return model.predict(stream);
  if (!model.per_sample()) return every_kth(model.predict(stream), every);
  stream.x = every_kth(stream.x, every);
  stream.segments = {{0, stream.rows()}};
  return model.predict(stream);
}

/// Reads each file once per system description; without time where the features need none.
class RecordingCache {
 public:
  RecordingCache(const EvaluationRequest& request, Evaluation& evaluation)
      : request_(request), evaluation_(evaluation) {}

  const std::vector<Recording>& get(const FeatureLayout& layout) {
    ReadOptions read = request_.read;
    read.static_list = layout.dt == 0.0;
    auto [entry, is_new] = cache_.try_emplace({layout.system.json.dump(), read.static_list});
    if (is_new) {
      for (const auto& path : request_.data) {
        entry->second.push_back(read_recording(path, read, layout.system));
        for (const auto& note : entry->second.back().notes) {
          evaluation_.notes.push_back(entry->second.back().name + ": " + note);
        }
      }
    }
    return entry->second;
  }

 private:
  const EvaluationRequest& request_;
  Evaluation& evaluation_;
  std::map<std::pair<std::string, bool>, std::vector<Recording>> cache_;
};

EvaluationSummary summarise(const std::vector<EvaluationRow>& rows) {
  EvaluationSummary s{rows[0].model,
                      rows[0].file,
                      rows[0].snr_db,
                      static_cast<int>(rows.size()),
                      {},
                      {},
                      {},
                      rows[0].score,
                      {}};
  const auto over = [&](auto value) {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const auto& row : rows) values.push_back(value(row.score));
    return spread(values);
  };
  for (std::size_t j = 0; j < rows[0].score.rmse.size(); ++j) {
    s.rmse.push_back(over([j](const Score& score) { return score.rmse[j]; }));
  }
  if (s.first.overall) s.overall = over([](const Score& score) { return *score.overall; });
  if (s.first.overall_torque) {
    s.overall_torque = over([](const Score& score) { return *score.overall_torque; });
  }
  return s;
}

std::optional<double> share_beyond(const Model& model, const Stream& stream) {
  const Eigen::VectorXd novelty = model.novelty(stream);
  if (novelty.size() == 0) return std::nullopt;
  return (novelty.array() > 1.0).cast<double>().mean();
}

void note_beyond(Evaluation& evaluation, const std::string& file) {
  for (const EvaluationSummary& s : evaluation.summary) {
    if (s.file != file || s.beyond.value_or(0.0) <= 0.01) continue;
    evaluation.notes.push_back(file + ": " + std::to_string(std::lround(100.0 * *s.beyond)) +
                               " % of the rows move unlike its training; no error is known there");
    return;
  }
}

/// The rigid tool beside a model; after the model's own predictions.
void add_rigid_tool(const std::filesystem::path& model, const EvaluationRequest& request,
                    RecordingCache& recordings, Evaluation& evaluation) {
  const auto file = rigid_file(model);
  if (!std::filesystem::exists(file)) return;
  const Identifier rigid = read_identifier(file);
  if (rigid.targets.names != evaluation.targets.names) return;
  const TestSet set = thinned(make_test_set(rigid, recordings.get(rigid.layout)), request.every);
  evaluation.references.rigid.push_back(
      {file.string(), to_json(rigid.layout.spec.derivative),
       score(predict_every(*rigid.model, set.stream, request.every) + set.base, set.wanted,
             rigid.targets)});
}

/// Noise on features does not reach a simulator, which is computed from the pose.
void note_base_without_noise(const EvaluationRequest& request, const Identifier& identifier,
                             const std::string& file, Evaluation& evaluation) {
  const bool noisy = std::any_of(request.levels.begin(), request.levels.end(),
                                 [](const SnrLevel& level) { return level.has_value(); });
  if (!noisy || !identifier.base || request.noise_on == NoiseSpec::Signal::kPose) return;
  evaluation.notes.push_back(file +
                             ": holds a simulator, which this noise on the features of its model "
                             "does not reach; --noise-on pose shows what noise does to both");
}

void check_targets(const Evaluation& evaluation, const Identifier& identifier,
                   const std::string& file) {
  require(evaluation.targets.names.empty() || evaluation.targets.names == identifier.targets.names,
          Exit::kUsage, file, ": predicts other targets than the first model; evaluate them apart");
}

}  // namespace

Evaluation evaluate(const EvaluationRequest& request,
                    const std::function<void(int, int)>& progress) {
  Evaluation evaluation;
  RecordingCache recordings(request, evaluation);
  require(request.noise_on == NoiseSpec::Signal::kFeatures || !request.matlab_noise, Exit::kUsage,
          "--noise-mode matlab is a power of noise on the features; leave it out with noise on the "
          "pose");
  evaluation.noise = describe(request);
  int per_model = 0, done = 0;
  for (const auto& level : request.levels) per_model += level ? request.runs : 1;

  std::vector<Json> derivatives;  // of the models
  for (const auto& path : request.models) {
    const Identifier identifier = read_identifier(path, request.precision);
    derivatives.push_back(to_json(identifier.layout.spec.derivative));
    check_targets(evaluation, identifier, path.string());
    const auto& data = recordings.get(identifier.layout);
    const TestSet set = thinned(make_test_set(identifier, data), request.every);
    evaluation.targets = identifier.targets;
    evaluation.samples = set.wanted.rows();
    evaluation.singular_samples = std::max(evaluation.singular_samples, set.singular);
    evaluation.unidentified = score(Eigen::MatrixXd::Zero(set.wanted.rows(), set.wanted.cols()),
                                    set.wanted, identifier.targets);
    const std::string file = path.filename().string();
    for (const auto& level : request.levels) {
      std::vector<EvaluationRow> rows;
      std::optional<double> beyond;
      for (int run = 0; run < (level ? request.runs : 1); ++run) {
        const Stream stream{noisy_features(request, set, identifier, data, level, run),
                            set.stream.segments};
        Eigen::MatrixXd predicted =
            predict_noisy_entries(request, *identifier.model, set.stream, level, run);
        if (predicted.size() == 0) {
          predicted = predict_every(*identifier.model, stream, request.every);
        }
        predicted += noisy_base(request, set, identifier, data, level, run);
        if (run == 0) beyond = share_beyond(*identifier.model, stream);
        rows.push_back(
            {identifier.name, file, level, run, score(predicted, set.wanted, identifier.targets)});
        if (!level && identifier.layout.system.lowpass_hz > 0.0) {
          evaluation.unfiltered.push_back({identifier.name, file, level, run,
                                           score(predicted, set.unfiltered, identifier.targets)});
        }
        if (!level) {
          evaluation.traces.push_back({identifier.name, set.first_t,
                                       set.wanted.topRows(set.first_rows),
                                       predicted.topRows(set.first_rows)});
        }
        if (progress) progress(++done, per_model * static_cast<int>(request.models.size()));
      }
      evaluation.summary.push_back(summarise(rows));
      evaluation.summary.back().beyond = beyond;
      std::move(rows.begin(), rows.end(), std::back_inserter(evaluation.rows));
    }
    note_beyond(evaluation, file);
    note_base_without_noise(request, identifier, file, evaluation);
    if (identifier.layout.dt > 0.0) evaluation.references.noise = white_noise(set.unfiltered);
    add_rigid_tool(path, request, recordings, evaluation);
  }
  judge_by_rigid_tools(request.models, derivatives, evaluation);
  note_missing_rigid(request.models, evaluation);
  add_warnings(evaluation);
  for (const auto& path : request.data) evaluation.data.push_back(path.filename().string());
  return evaluation;
}

}  // namespace dcnn
