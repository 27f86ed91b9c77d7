#include "dcnn/experiment/train.h"

#include <bit>
#include <cmath>
#include <cstdio>
#include <utility>

#include "dcnn/core/file.h"
#include "experiment/run_directory.h"

namespace dcnn {
namespace {

constexpr double kValidationGapSeconds = 1.0;

std::vector<Recording> read_all(const std::vector<std::filesystem::path>& paths,
                                const TrainingRequest& request, const System& system,
                                const TrainingObserver& observer) {
  std::vector<Recording> recordings;
  for (const auto& path : paths) {
    recordings.push_back(read_recording(path, request.read, system));
    for (const auto& note : recordings.back().notes) {
      if (observer.note) observer.note(recordings.back().name + ": " + note);
    }
  }
  return recordings;
}

void append(Samples& samples, const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
            const std::vector<Index>& rows) {
  const auto old = samples.x.rows(), more = static_cast<Index>(rows.size());
  samples.x.conservativeResize(old + more, x.cols());
  samples.y.conservativeResize(old + more, y.cols());
  for (Index i = 0; i < more; ++i) {
    samples.x.row(old + i) = x.row(rows[static_cast<std::size_t>(i)]);
    samples.y.row(old + i) = y.row(rows[static_cast<std::size_t>(i)]);
  }
}

/// Features and targets of recordings, split by time.
class Splitter {
 public:
  Splitter(const Identifier& identifier, const TrainingObserver& observer)
      : identifier_(identifier), observer_(observer) {}

  /// The last `share` of the recording's rows go to `validation`, those before them by 1 s or more to
  /// `training`; rows near the Euler singularity to neither.
  void add(const Recording& recording, double share, Samples& training, Samples& validation) const {
    const Features features = make_features(recording, identifier_.layout);
    const Eigen::MatrixXd y = measured(recording, identifier_.targets, identifier_.layout.system) -
                              identifier_.base_prediction(recording);
    const Index total = recording.samples();
    const auto held = static_cast<Index>(std::lround(share * static_cast<double>(total)));
    const auto gap = held > 0 ? static_cast<Index>(std::lround(kValidationGapSeconds / recording.dt)) : 0;
    std::vector<Index> first, second;
    for (Index row = 0; row < total; ++row) {
      if (!features.valid[static_cast<std::size_t>(row)]) continue;
      if (row >= total - held) second.push_back(row);
      if (row < total - held - gap) first.push_back(row);
    }
    append(training, features.x, y, first);
    append(validation, features.x, y, second);
    const Index invalid = features.invalid_count();
    if (invalid > 0 && observer_.note) {
      observer_.note(recording.name + ": " + std::to_string(invalid) + " of " + std::to_string(total) +
                     " samples lie near the Euler singularity and are not trained on; the feature set "
                     "'body' has none");
    }
  }

 private:
  const Identifier& identifier_;
  const TrainingObserver& observer_;
};

/// Names the configuration and every number that is learned from, so that a resumed run is the same run.
std::string identity_of(const Configuration& configuration, const Samples& training,
                        const Samples& validation) {
  std::uint64_t hash = 0;
  for (const Eigen::MatrixXd* m : {&training.x, &training.y, &validation.x, &validation.y}) {
    hash = mix_bits(hash ^ static_cast<std::uint64_t>(m->rows()));
    for (Index i = 0; i < m->size(); ++i) {
      hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(m->data()[i]));
    }
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return configuration.json.dump() + " " + text;
}

FitSession make_session(RunDirectory& run, const std::string& identity, const Identifier& identifier,
                        const Json& configuration, const TrainingObserver& observer) {
  const Index epochs = configuration.at("training").value("epochs", Index{0});
  FitSession session;
  session.stop_wanted = observer.stop_wanted;
  session.step_done = [&observer, epochs](Index epoch, Index step, Index steps, double loss) {
    if (observer.progress) observer.progress({epoch, epochs, step, steps, loss, std::nullopt});
  };
  session.epoch_done = [&, epochs](const EpochRecord& record) {
    const Container file = pack(identifier);
    if (record.best) run.save_model("best", file);
    run.save_model("last", file);
    run.add_metrics(record);
    if (observer.progress) observer.progress({record.epoch, epochs, 0, 0, record.loss, record});
  };
  session.save_checkpoint = [&](const Container& file) { run.save_checkpoint(file, identity); };
  return session;
}

std::vector<double> rmse_of(const Model& model, const Samples& samples) {
  if (samples.x.rows() == 0) return {};
  const Eigen::VectorXd rmse =
      (model.predict(samples.x) - samples.y).array().square().colwise().mean().sqrt().transpose();
  return {rmse.data(), rmse.data() + rmse.size()};
}

}  // namespace

std::filesystem::path run_directory(const std::filesystem::path& model) {
  auto folder = model;
  return folder.replace_extension(".run");
}

TrainingOutcome train(const TrainingRequest& request, const TrainingObserver& observer) {
  const Configuration configuration = resolve(request.configuration);
  const auto recordings = read_all(request.training, request, configuration.system, observer);
  const auto held_out = read_all(request.validation, request, configuration.system, observer);

  Identifier identifier;
  identifier.name = configuration.kind->name;
  identifier.layout = make_layout(recordings, configuration.features, configuration.system);
  identifier.targets = find_targets(recordings.front(), configuration.system);
  identifier.configuration = configuration.json;
  identifier.seed = configuration.seed;
  if (request.base) identifier.base = read_simulator(*request.base);
  for (const auto& note : identifier.layout.notes) {
    if (observer.note) observer.note(note);
  }

  Samples training, validation;
  const Splitter splitter(identifier, observer);
  const double share = held_out.empty() ? configuration.validation : 0.0;
  for (const auto& recording : recordings) splitter.add(recording, share, training, validation);
  for (const auto& recording : held_out) splitter.add(recording, 0.0, validation, validation);
  require(training.x.rows() > 0, Exit::kData, recordings.front().name,
          ": no sample is left to train on; choose --features body or longer recordings");

  identifier.model = configuration.kind->make({training.x.cols(), training.y.cols(), configuration.json,
                                               configuration.where, configuration.seed,
                                               identifier.layout.units});
  RunDirectory run(run_directory(request.out));
  const std::string identity = identity_of(configuration, training, validation);
  FitSession session = make_session(run, identity, identifier, configuration.json, observer);
  if (request.resume) session.checkpoint = run.find_checkpoint(identity);
  if (session.checkpoint) {
    run.keep_metrics(std::get<std::vector<std::int64_t>>(session.checkpoint->find("position")->values)[0]);
  } else {
    run.start(configuration.json);
  }

  TrainingOutcome outcome;
  outcome.finished = identifier.model->fit(training, validation, session);
  outcome.summary = {{"model", identifier.name},
                     {"parameters", identifier.model->parameter_count()},
                     {"training_rows", training.x.rows()},
                     {"validation_rows", validation.x.rows()},
                     {"targets", identifier.targets.names},
                     {"units", identifier.targets.units},
                     {"run_directory", run.folder().string()}};
  if (outcome.finished) {
    outcome.summary["validation_rmse"] = rmse_of(*identifier.model, validation);
    write_container(request.out, pack(identifier));
    outcome.summary["file"] = request.out.string();
  }
  return outcome;
}

}  // namespace dcnn
