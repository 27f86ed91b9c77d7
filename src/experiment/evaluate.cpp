#include "dcnn/experiment/evaluate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

#include "dcnn/data/pose_noise.h"
#include "dcnn/models/network_model.h"
#include "experiment/references.h"

namespace dcnn {
namespace {

/// Rows of all recordings under one another, as one model sees them.
struct TestSet {
  Stream stream;
  Eigen::MatrixXd wanted, unfiltered, base;  // base: the part a simulator predicts
  Index singular = 0, first_rows = 0;        // first_rows: those of the first recording
  Eigen::VectorXd first_t;
};

void stack(Eigen::MatrixXd& under, const Eigen::MatrixXd& more) {
  const auto old = under.rows();
  under.conservativeResize(old + more.rows(), more.cols());
  under.bottomRows(more.rows()) = more;
}

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

Eigen::MatrixXd every_kth(const Eigen::MatrixXd& rows, Index k) {
  return rows(Eigen::seqN(0, (rows.rows() + k - 1) / k, k), Eigen::all);
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

std::uint64_t noise_key(std::uint64_t seed, double level, int run) {
  return Rng({seed, std::bit_cast<std::uint64_t>(level), static_cast<std::uint64_t>(run)}).bits();
}

NoiseSpec test_noise(const EvaluationRequest& request) {
  NoiseSpec spec;
  if (request.matlab_noise) {
    spec.scope = NoiseSpec::Scope::kMatrix;
    spec.power = NoiseSpec::Power::kMeanSquare;
  }
  return spec;
}

std::string describe(const EvaluationRequest& request) {
  if (request.noise_on == NoiseSpec::Signal::kPose) {
    return "pose before differentiation, variance of each coordinate over the training rows";
  }
  if (request.noisy_entries) {
    return "entries of X* where a model has them, each by itself (a leak), else features";
  }
  return request.matlab_noise ? "features, mean square over the whole matrix (awgn 'measured')"
                              : "features, variance of each over the training rows";
}

/// Noise on the pose of every recording, carried to the features: by the sum of draws that training
/// uses where features are linear in the pose, else by making them anew.
Eigen::MatrixXd with_noisy_pose(const TestSet& set, const Identifier& identifier,
                                const std::vector<Recording>& recordings, double snr,
                                std::uint64_t key) {
  const double scale = std::pow(10.0, -snr / 20.0);
  const bool linear = identifier.layout.spec.set == FeatureSpec::Set::kPose;
  Eigen::MatrixXd noise;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const auto own = Rng({key, k}).bits();
    stack(noise, linear
                     ? (scale * pose_noise(recordings[k], identifier.layout, own)).eval()
                     : make_features(with_pose_noise(recordings[k], identifier.layout, scale, own),
                                     identifier.layout)
                           .x);
  }
  return linear ? (set.stream.x + noise).eval() : noise;
}

Eigen::MatrixXd noisy_features(const EvaluationRequest& request, const TestSet& set,
                               const Identifier& identifier,
                               const std::vector<Recording>& recordings, const SnrLevel& level,
                               int run) {
  if (!level) return set.stream.x;
  const auto key = noise_key(request.seed, *level, run);
  if (request.noise_on == NoiseSpec::Signal::kPose) {
    return with_noisy_pose(set, identifier, recordings, *level, key);
  }
  const auto deviation =
      noise_deviation(test_noise(request), identifier.model->map(), set.stream.x, level);
  return with_noise(set.stream.x, deviation, key);
}

/// Of the rows to be scored, with noise on the entries of X*; empty where the model has none.
Eigen::MatrixXd predict_noisy_entries(const EvaluationRequest& request, const Model& model,
                                      const Stream& stream, const SnrLevel& level, int run) {
  const auto* network = dynamic_cast<const NetworkModel*>(&model);
  if (!request.noisy_entries || !level || network == nullptr) return {};
  return network->predict_with_noisy_entries({every_kth(stream.x, request.every), {}}, *level,
                                             noise_key(request.seed, *level, run));
}

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

/// The rigid tool beside a model and the noise; after the model's own predictions.
void add_references(const std::filesystem::path& model, const EvaluationRequest& request,
                    RecordingCache& recordings, Evaluation& evaluation) {
  EvaluationReferences& references = evaluation.references;
  const auto file = rigid_file(model);
  if (references.rigid || !std::filesystem::exists(file)) return;
  const Identifier rigid = read_identifier(file);
  if (rigid.targets.names != evaluation.targets.names) return;
  const TestSet set = thinned(make_test_set(rigid, recordings.get(rigid.layout)), request.every);
  references.rigid = score(predict_every(*rigid.model, set.stream, request.every) + set.base,
                           set.wanted, rigid.targets);
  references.rigid_file = file.string();
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

  for (const auto& path : request.models) {
    const Identifier identifier = read_identifier(path, request.precision);
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
        predicted += set.base;
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
    if (identifier.layout.dt > 0.0) evaluation.references.noise = white_noise(set.unfiltered);
    add_references(path, request, recordings, evaluation);
  }
  note_missing_rigid(request.models, evaluation);
  add_warnings(evaluation);
  for (const auto& path : request.data) evaluation.data.push_back(path.filename().string());
  return evaluation;
}

}  // namespace dcnn
