// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "models/augmented.h"
#include "models/linear_model.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

Eigen::VectorXd mean_squares(const Model& model, const Samples& samples) {
  const Eigen::MatrixXd error = model.predict(samples) - samples.y;
  return error.array().square().colwise().mean().transpose();
}

}  // namespace

Json closed_form_preset(const std::string& preset) {
  Json json = {{"training", Json::object()}};
  if (preset == "paper") json["training"]["validation"] = 0.0;
  return json;
}

ClosedFormModel::ClosedFormModel(std::string kind, const Problem& problem)
    : kind_(std::move(kind)), units_(problem.layout.units), seed_(problem.seed) {
  Options options(problem.configuration, problem.where, Exit::kUsage);
  map_spec_ = parse_input_map(options.child("map"));
  noise_ = parse_noise(options.child("noise"));
  Options training = options.child("training");
  training.raw("validation");  // read by the experiment
  if (training.has("epochs")) {
    training.reject("epochs", "has no meaning for the model '", kind_,
                    "', which is fitted in one pass; leave it out");
  }
  training.finish();
}

ClosedFormModel::ClosedFormModel(const Container& file, const std::string& where)
    : kind_(stored_text(file, "model", where)) {
  map_ = InputMap::parse(parse_json(stored_text(file, "map", where), where, Exit::kModel), where,
                         Exit::kModel);
}

bool ClosedFormModel::fit(const Samples& training, const Samples& validation, FitSession& session) {
  if (session.stop_wanted && session.stop_wanted()) return false;
  map_ = InputMap(training.x, map_spec_, units_);
  const Samples noisy = augmented(training, noise_, map_, seed_);
  learn(noisy);
  EpochRecord record;
  record.epoch = 1;
  record.best = true;
  record.loss = 0.5 * mean_squares(*this, noisy).sum();
  if (validation.rows() > 0) {
    const Eigen::VectorXd rmse = mean_squares(*this, validation).cwiseSqrt();
    record.validation_rmse.assign(rmse.begin(), rmse.end());
  }
  if (session.epoch_done) session.epoch_done(record);
  return true;
}

bool ClosedFormModel::is_noisy() const {
  return std::any_of(noise_.levels.begin(), noise_.levels.end(),
                     [](const SnrLevel& level) { return level.has_value(); });
}

void ClosedFormModel::save(Container& file) const {
  file.metadata["model"] = kind_;
  file.metadata["map"] = map_.to_json().dump();
}

}  // namespace dcnn
