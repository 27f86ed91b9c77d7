// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/train.h"

#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "dcnn/core/file.h"
#include "dcnn/core/ranks.h"
#include "dcnn/models/network_model.h"
#include "experiment/references.h"
#include "experiment/run_directory.h"
#include "experiment/splitter.h"
#include "experiment/training_checks.h"
#include "models/weighted_model.h"

namespace dcnn {
namespace {

/// Names of models that learn from lists of poses at rest.
std::string kinds_for_lists() {
  std::string list;
  for (const ModelKind* kind : model_kinds()) {
    if (kind->takes_static_lists) list += (list.empty() ? "" : ", ") + std::string(kind->name);
  }
  return list;
}

std::vector<Recording> read_all(const std::vector<std::filesystem::path>& paths,
                                const TrainingRequest& request, const Configuration& configuration,
                                const TrainingObserver& observer) {
  ReadOptions read = request.read;
  read.static_list = configuration.kind->takes_static_lists;
  std::vector<Recording> recordings;
  for (const auto& path : paths) {
    SourceTable source = read_table(path);
    require(read.static_list || has_time(source.table), Exit::kData, path.string(),
            ":1: column 't' is missing, so that this is a list of poses at rest, and ",
            configuration.kind->name,
            " learns from motion; log the time in seconds, or take --model ", kinds_for_lists());
    recordings.push_back(make_recording(std::move(source), path, read, configuration.system));
    for (const auto& note : recordings.back().notes) {
      if (observer.note) observer.note(recordings.back().name + ": " + note);
    }
  }
  return recordings;
}

Json effects_of(const Simulator& simulator) {
  Json names = Json::array();
  for (const EffectSpec& spec : simulator.effects) names.push_back(spec.effect);
  return names;
}

/// Names the configuration and every number that is learned from, so that a resumed run is the same
/// run.
std::string identity_of(const Json& configuration, const Samples& training,
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
  return configuration.dump() + " " + text;
}

FitSession make_session(RunDirectory& run, const std::string& identity,
                        const Identifier& identifier, const Json& configuration,
                        const TrainingObserver& observer) {
  const Index epochs = configuration.at("training").value("epochs", Index{1});
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
      (model.predict(samples) - samples.y).array().square().colwise().mean().sqrt().transpose();
  return {rmse.data(), rmse.data() + rmse.size()};
}

/// One training under way: what every fit of it shares.
class Learner {
 public:
  Learner(const TrainingRequest& request, const TrainingObserver& observer,
          const Configuration& configuration, Identifier& identifier, const Samples& training,
          const Samples& validation)
      : request_(request),
        observer_(observer),
        configuration_(configuration),
        identifier_(identifier),
        training_(training),
        validation_(validation) {}

  /// Fits a model of this configuration in a run directory of its own. False when stopped.
  bool fit(const Json& json, const std::filesystem::path& folder) {
    identifier_.configuration = json;
    identifier_.model = configuration_.kind->make({identifier_.layout, identifier_.targets, json,
                                                   configuration_.where, configuration_.seed,
                                                   identifier_.base.has_value()});
    require(rank_count() == 1 || dynamic_cast<const NetworkModel*>(identifier_.model.get()),
            Exit::kUsage, configuration_.kind->name,
            " is trained by one process; run dcnn-train without mpirun");
    RunDirectory run(folder);
    const std::string identity = identity_of(json, training_, validation_);
    FitSession session = make_session(run, identity, identifier_, json, observer_);
    if (request_.resume) session.checkpoint = run.find_checkpoint(identity);
    if (session.checkpoint) {
      const auto* position = session.checkpoint->find("position");
      run.keep_metrics(std::get<std::vector<std::int64_t>>(position->values).at(0));
    } else {
      run.start(json);
    }
    return identifier_.model->fit(training_, validation_, session);
  }

  /// Where the configuration lists `training.candidates`, each is tried for `candidate_epochs` and
  /// the one with the least validation error is laid on it. Empty when stopped.
  std::optional<Json> choose(Json json, const std::filesystem::path& folder) {
    const Json candidates = json["training"].value("candidates", Json::array());
    if (candidates.empty() || validation_.x.rows() == 0) return json;
    const Index epochs = json["training"].value("candidate_epochs", Index{15});
    for (const char* key : {"candidates", "candidate_epochs"}) json["training"].erase(key);
    double least = std::numeric_limits<double>::infinity();
    Json best;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const Json trial = merged(json, candidates[i]);
      if (!fit(merged(trial, {{"training", {{"epochs", epochs}}}}),
               folder / ("candidate_" + std::to_string(i)))) {
        return std::nullopt;
      }
      const double error = relative_error();
      if (observer_.note) {
        observer_.note("candidate " + candidates[i].dump() + ": validation error " +
                       std::to_string(error) + " of the targets' spread");
      }
      if (error < least) {
        least = error;
        best = trial;
      }
    }
    return best;
  }

 private:
  /// Mean over targets of validation RMSE / spread of the target.
  double relative_error() const {
    const auto rmse = rmse_of(*identifier_.model, validation_);
    double sum = 0.0;
    for (Index j = 0; j < validation_.y.cols(); ++j) {
      const Eigen::ArrayXd y = validation_.y.col(j);
      sum += rmse[static_cast<std::size_t>(j)] / std::sqrt((y - y.mean()).square().mean() + 1e-24);
    }
    return sum / static_cast<double>(validation_.y.cols());
  }

  const TrainingRequest& request_;
  const TrainingObserver& observer_;
  const Configuration& configuration_;
  Identifier& identifier_;
  const Samples &training_, &validation_;
};

/// Errors that are further apart than the motion remembers.
Index independent_rows(const FeatureLayout& layout) {
  constexpr double kSeconds = 2.0;
  return layout.dt > 0.0 ? static_cast<Index>(std::llround(kSeconds / layout.dt)) : 1;
}

/// Sets the error on the validation rows beside those of the references, and keeps the rigid tool
/// for later evaluations.
void compare_with_references(const std::filesystem::path& out, const Identifier& identifier,
                             const Samples& training, const Samples& validation,
                             TrainingOutcome& outcome) {
  const Identifier rigid = fit_rigid(identifier, training, validation);
  if (rigid.model) write_container(rigid_file(out), pack(rigid));
  if (validation.x.rows() == 0) return;
  References references;
  if (identifier.layout.dt > 0.0) references.noise = white_noise(validation.y);
  for (const auto y : validation.y.colwise()) {
    references.none.push_back(std::sqrt(y.squaredNorm() / static_cast<double>(y.size())));
  }
  if (rigid.model) {
    references.rigid = rmse_of(*rigid.model, validation);
    references.rigid_file = rigid_file(out).string();
  }
  outcome.summary["references"] = to_json(references);
  outcome.summary["warnings"] = warnings(
      out.filename().string(), outcome.summary["validation_rmse"], references, identifier.targets);
}

}  // namespace

std::filesystem::path run_directory(const std::filesystem::path& model) {
  auto folder = model;
  return folder.replace_extension(".run");
}

TrainingOutcome train(const TrainingRequest& request, const TrainingObserver& observer) {
  const Configuration configuration = resolve(request.configuration);
  const auto recordings = read_all(request.training, request, configuration, observer);
  const auto held_out = read_all(request.validation, request, configuration, observer);

  Identifier identifier;
  identifier.name = configuration.kind->name;
  identifier.layout = make_layout(recordings, configuration.features, configuration.system);
  identifier.targets = find_targets(recordings.front(), configuration.system);
  identifier.seed = configuration.seed;
  if (request.base) identifier.base = read_simulator(*request.base);
  for (const auto& note : identifier.layout.notes) {
    if (observer.note) observer.note(note);
  }

  Samples training, validation;
  const Splitter splitter(identifier, observer, wants_pose_noise(configuration.json));
  const double share = held_out.empty() ? configuration.validation : 0.0;
  for (const auto& recording : recordings) splitter.add(recording, share, training, validation);
  for (const auto& recording : held_out) splitter.add_whole(recording, validation);
  require(training.x.rows() > 0, Exit::kData, recordings.front().name,
          ": no sample is left to train on; choose the feature set 'body' or longer recordings");
  check_training(recordings, identifier.targets, configuration.system, observer);

  const auto folder = run_directory(request.out);
  Learner learner(request, observer, configuration, identifier, training, validation);
  const auto chosen = learner.choose(configuration.json, folder);
  TrainingOutcome outcome;
  outcome.finished = chosen && learner.fit(*chosen, folder);
  const auto notes = outcome.finished ? identifier.model->notes() : std::vector<std::string>{};
  for (const auto& note : notes) {
    if (observer.note) observer.note(note);
  }
  outcome.summary = {{"model", identifier.name},
                     {"parameters", identifier.model->parameter_count()},
                     {"training_rows", training.x.rows()},
                     {"validation_rows", validation.x.rows()},
                     {"targets", identifier.targets.names},
                     {"units", identifier.targets.units},
                     {"notes", notes},
                     {"run_directory", folder.string()}};
  if (identifier.base) outcome.summary["base_effects"] = effects_of(*identifier.base);
  if (outcome.finished) {
    const auto& layout = identifier.layout;
    if (identifier.base && validation.rows() > 0) {
      const Eigen::VectorXd weights =
          trust(validation, identifier.model->predict(validation), independent_rows(layout));
      identifier.model = weighted(std::move(identifier.model), weights);
      outcome.summary["trust"] = std::vector<double>(weights.begin(), weights.end());
    }
    if (layout.spec.derivative.kind == DerivativeSpec::Kind::kCausalSavitzkyGolay &&
        layout.spec.set != FeatureSpec::Set::kAxes) {
      identifier.online =
          learn_limits(*identifier.model, identifier.targets, training, validation, layout.dt);
      outcome.summary["contact_n"] = identifier.online->contact_n;
    }
    outcome.summary["validation_rmse"] = rmse_of(*identifier.model, validation);
    write_container(request.out, pack(identifier));
    outcome.summary["file"] = request.out.string();
    compare_with_references(request.out, identifier, training, validation, outcome);
  }
  return outcome;
}

}  // namespace dcnn
