// SPDX-License-Identifier: Apache-2.0
#include "models/shallow_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/augmented.h"
#include "models/random_streams.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

// Streams of random numbers that one seed feeds.
constexpr double kTrainingShare = 0.70, kValidationShare = 0.15;  // as the toolbox divides
constexpr Index kLeastRows = 20;
constexpr std::size_t kMostHidden = 4;
constexpr Index kMostUnits = 1000, kMostWeights = 3000;  // J^T J is dense

/// The network; the error names what to change.
ShallowNetwork make_network(const ShallowNetwork::Shape& shape, const std::string& where,
                            Exit exit) {
  require(!shape.hidden.empty() && shape.hidden.size() <= kMostHidden, exit, where,
          ": a shallow network has 1 to ", kMostHidden, " hidden layers");
  for (const Index units : shape.hidden) {
    require(units >= 1 && units <= kMostUnits, exit, where, ": a hidden layer of ", units,
            " units; give 1 to ", kMostUnits);
  }
  ShallowNetwork network(shape);
  require(network.parameter_count() <= kMostWeights, exit, where, ": ", network.parameter_count(),
          " weights; Levenberg-Marquardt takes at most ", kMostWeights,
          ": use fewer hidden units or inputs");
  return network;
}

ShallowNetwork::Shape stored_shape(const Container& file, const std::string& where) {
  Options options(parse_json(stored_text(file, "architecture", where), where, Exit::kModel), where,
                  Exit::kModel);
  ShallowNetwork::Shape shape;
  shape.hidden = options.get<std::vector<Index>>("hidden");
  shape.cascade = options.get<bool>("cascade");
  options.finish();
  return shape;
}

std::string name_of(std::size_t layer) { return "layer" + std::to_string(layer); }

}  // namespace

ShallowTraining ShallowTraining::parse(Options options) {
  ShallowTraining spec;
  spec.optimiser.epochs = static_cast<Index>(options.number("epochs", 200, 1, 1e6));
  spec.stride = static_cast<Index>(options.number("stride", 1, 1, 1e6));
  spec.division = options.choice("division", "random", {"random", "blocks", "held-out"});
  spec.standardise = options.get("standardise_targets", false);
  for (const char* key : {"validation", "candidates", "candidate_epochs"}) {
    options.raw(key);  // read by the experiment
  }
  options.finish();
  return spec;
}

ShallowModel::ShallowModel(std::string kind, bool cascade, const Problem& problem)
    : ShallowModel(std::move(kind), cascade, problem,
                   Options(problem.configuration, problem.where, Exit::kUsage).child("model")) {}

ShallowModel::ShallowModel(std::string kind, bool cascade, const Problem& problem, Options model)
    : kind_(std::move(kind)),
      units_(problem.layout.units),
      input_(model, problem.layout, problem.where),
      network_(make_network(
          {input_.count(), model.get<std::vector<Index>>("hidden"), problem.outputs(), cascade},
          problem.where, Exit::kUsage)),
      seed_(problem.seed) {
  model.raw("name");
  model.finish();
  Options options(problem.configuration, problem.where, Exit::kUsage);
  map_spec_ = parse_input_map(options.child("map"));
  training_ = ShallowTraining::parse(options.child("training"));
  noise_ = parse_noise(options.child("noise"));
}

ShallowModel::ShallowModel(const Container& file, const std::string& where)
    : kind_(stored_text(file, "model", where)),
      map_(InputMap::parse(parse_json(stored_text(file, "map", where), where, Exit::kModel), where,
                           Exit::kModel)),
      input_(file, map_.features(), where),
      network_(ShallowNetwork({})),
      middle_(stored_row(file, "target_middle", where)),
      half_range_(stored_row(file, "target_half_range", where)) {
  ShallowNetwork::Shape shape = stored_shape(file, where);
  shape.inputs = input_.count();
  shape.outputs = middle_.size();
  require(shape.outputs > 0 && half_range_.size() == shape.outputs, Exit::kModel, where,
          ": its output does not fit its targets");
  network_ = make_network(shape, where, Exit::kModel);
  Eigen::VectorXd weights(network_.parameter_count());
  for (std::size_t l = 0; l < network_.layers().size(); ++l) {
    const auto& layer = network_.layers()[l];
    const auto& values = stored_values<double>(file, name_of(l), where);
    require(file.find(name_of(l))->shape == std::vector<Index>{1 + layer.width, layer.units},
            Exit::kModel, where, ": tensor '", name_of(l),
            "' has another shape than the architecture says");
    std::ranges::copy(values, weights.data() + layer.offset);
  }
  set_weights(std::move(weights));
  require(predict({map_.mean().transpose(), {}}).allFinite(), Exit::kModel, where,
          ": its output is not finite");
}

/// Least and greatest value of each target; one that does not vary is its own prediction.
void ShallowModel::learn_scales(const Samples& training) {
  const Eigen::RowVectorXd least = training.y.colwise().minCoeff();
  const Eigen::RowVectorXd most = training.y.colwise().maxCoeff();
  middle_ = 0.5 * (least + most);
  half_range_ = 0.5 * (most - least);
  half_range_ = (half_range_.array() < 1e-12).select(1.0, half_range_);
  error_scale_ = half_range_.transpose();
  if (!training_.standardise) return;
  const Eigen::MatrixXd centred = training.y.rowwise() - training.y.colwise().mean();
  const Eigen::VectorXd spread =
      (centred.colwise().squaredNorm() / static_cast<double>(training.y.rows())).cwiseSqrt();
  error_scale_.array() /= (spread.array() < 1e-12).select(1.0, spread.array());
}

ShallowModel::Division ShallowModel::divide(const Samples& training) const {
  const Index used = (training.rows() + training_.stride - 1) / training_.stride;
  require(used >= kLeastRows, Exit::kData, "only ", used,
          " training rows; give longer recordings or a smaller training.stride");
  std::vector<Index> order = all_rows(used);
  Rng rng({seed_, kShallowDivision});
  if (training_.division == "random") order = permutation(used, rng);
  for (Index& row : order) row *= training_.stride;
  if (training_.division == "held-out") return {order, {}};
  const auto share = [used](double part) { return std::lround(part * static_cast<double>(used)); };
  const auto first = order.begin() + share(kTrainingShare);
  const auto second = first + share(kValidationShare);
  Division division{{order.begin(), first}, {first, second}};
  std::ranges::sort(division.training);
  std::ranges::sort(division.validation);
  return division;
}

ShallowResiduals ShallowModel::residuals(const Samples& samples,
                                         const std::vector<Index>& rows) const {
  const RowMatrix targets =
      (samples.y(rows, Eigen::all).rowwise() - middle_).array().rowwise() / half_range_.array();
  return {network_, input_.read(samples, map_, rows), targets, error_scale_};
}

bool ShallowModel::fit(const Samples& training, const Samples& validation, FitSession& session) {
  map_ = InputMap(training.x, map_spec_, units_);
  input_.learn(training, map_, noise_);
  learn_scales(training);
  ShallowNetwork::Shape shape = network_.shape();
  shape.inputs = input_.count();
  network_ = ShallowNetwork(shape);

  const Samples noisy = augmented(training, noise_, map_, Rng({seed_, kShallowNoise}).bits());
  const Division division = divide(noisy);
  const ShallowResiduals to_fit = residuals(noisy, division.training);
  const bool held_out = training_.division == "held-out";
  require(
      !held_out || validation.rows() > 0, Exit::kUsage,
      "training.division 'held-out' needs validation rows; give training.validation or --valid");
  const ShallowResiduals to_stop = held_out ? residuals(validation, all_rows(validation.rows()))
                                            : residuals(noisy, division.validation);
  Rng rng({seed_, kShallowWeights});
  LevenbergMarquardt optimiser(to_fit, &to_stop, training_.optimiser,
                               network_.initial_weights(rng));
  if (session.checkpoint) optimiser.restore(*session.checkpoint);
  return run(optimiser, validation, session);
}

bool ShallowModel::run(LevenbergMarquardt& optimiser, const Samples& validation,
                       FitSession& session) {
  while (!optimiser.done()) {
    if (session.stop_wanted && session.stop_wanted()) {
      if (session.save_checkpoint) session.save_checkpoint(optimiser.save());
      return false;
    }
    const double mu = optimiser.mu();
    if (!optimiser.iterate()) break;
    set_weights(optimiser.weights());
    if (session.step_done) session.step_done(optimiser.epoch(), 1, 1, optimiser.loss());
    if (session.epoch_done) session.epoch_done(record(optimiser, mu, validation));
    if (session.save_checkpoint) session.save_checkpoint(optimiser.save());
  }
  set_weights(optimiser.best());
  return true;
}

EpochRecord ShallowModel::record(const LevenbergMarquardt& optimiser, double mu,
                                 const Samples& validation) const {
  EpochRecord result;
  result.epoch = optimiser.epoch();
  result.loss = optimiser.loss();
  result.rate = mu;  // the damping is what a rate is to Adam
  result.best = optimiser.is_best();
  if (validation.rows() == 0) return result;
  const Eigen::VectorXd rmse =
      (predict(validation) - validation.y).array().square().colwise().mean().sqrt().transpose();
  result.validation_rmse.assign(rmse.begin(), rmse.end());
  return result;
}

void ShallowModel::save(Container& file) const {
  file.metadata["model"] = kind_;
  file.metadata["architecture"] =
      Json{{"hidden", network_.shape().hidden}, {"cascade", network_.shape().cascade}}.dump();
  file.metadata["map"] = map_.to_json().dump();
  input_.save(file);
  file.tensors.push_back({"target_middle", {middle_.size()}, list_of(middle_)});
  file.tensors.push_back({"target_half_range", {half_range_.size()}, list_of(half_range_)});
  for (std::size_t l = 0; l < network_.layers().size(); ++l) {
    const auto& layer = network_.layers()[l];
    const double* values = weights_.data() + layer.offset;
    file.tensors.push_back({name_of(l),
                            {1 + layer.width, layer.units},
                            std::vector<double>(values, values + layer.size())});
  }
}

}  // namespace dcnn
