// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/network_model.h"

#include <cmath>
#include <utility>

#include "dcnn/nn/optimizer.h"
#include "models/linear_skip.h"
#include "models/random_streams.h"
#include "models/tensor_io.h"
#include "models/trainer.h"

namespace dcnn {
namespace {

/// What a file says that its model consists of.
constexpr const char *kNetwork = "network", *kLinear = "linear", *kBoth = "linear and network";

TargetScale make_scale(const Eigen::MatrixXd& y, const Eigen::VectorXd& spread, bool standardise) {
  if (standardise) return {y.colwise().mean(), spread};
  return {Eigen::VectorXd::Zero(y.cols()), Eigen::VectorXd::Ones(y.cols())};
}

/// Standard deviation of each target; 1 for one that does not vary.
Eigen::VectorXd target_spread(const Eigen::MatrixXd& y) {
  const Eigen::RowVectorXd mean = y.colwise().mean();
  const double n = static_cast<double>(std::max<Index>(1, y.rows() - 1));
  Eigen::VectorXd spread =
      ((y.rowwise() - mean).array().square().colwise().sum() / n).sqrt().transpose();
  return (spread.array() < 1e-12).select(1.0, spread);
}

Json to_json(const Eigen::VectorXd& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

Eigen::VectorXd parse_vector(const Json& json, const std::string& where) {
  try {
    const auto v = json.get<std::vector<double>>();
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Index>(v.size()));
  } catch (const Json::exception&) {
    fail(Exit::kModel, where, ": a list of numbers is malformed in its metadata");
  }
}

}  // namespace

TrainingSpec TrainingSpec::parse(Options options) {
  TrainingSpec spec;
  spec.epochs = static_cast<Index>(options.number("epochs", 30, 1, 1e6));
  spec.batch = static_cast<Index>(options.number("batch", 50, 1, 1e6));
  spec.l2 = options.number("l2", 1e-4, 0.0, 1e6);
  spec.standardise_targets = options.get("standardise_targets", true);
  spec.shuffle_every_epoch =
      options.choice("shuffle", "every-epoch", {"every-epoch", "once"}) != "once";
  spec.full_statistics = options.choice("statistics", "full", {"full", "running"}) == "full";
  spec.ema = options.number("ema", 0.0, 0.0, 0.999999);
  spec.clip = options.number("clip", 0.0, 0.0, 1e6);
  spec.stride = options.get<Index>("stride", 1);
  if (spec.stride < 1) options.reject("stride", "must be at least 1, not ", spec.stride);
  spec.shrink = options.number("shrink", 1.0, 0.01, 1.0);
  spec.keep_best = options.choice("keep", "best", {"best", "last"}) == "best";
  for (const char* key : {"lr", "schedule", "drop_factor", "drop_period"}) {
    if (const Json value = options.raw(key); !value.is_null()) spec.rate[key] = value;
  }
  for (const char* key : {"validation", "candidates", "candidate_epochs"}) {
    options.raw(key);  // read by the experiment
  }
  Options rate(spec.rate, "training", Exit::kUsage);
  LearningRate check(rate, spec.epochs, 1);
  rate.finish();
  options.finish();
  return spec;
}

NetworkModel::NetworkModel(std::string kind, const Json& input, const Json& layers,
                           const Problem& problem, bool skip)
    : kind_(std::move(kind)), units_(problem.layout.units), seed_(problem.seed) {
  Options options(problem.configuration, problem.where, Exit::kUsage);
  map_spec_ = parse_input_map(options.child("map"));
  training_ = TrainingSpec::parse(options.child("training"));
  noise_ = parse_noise(options.child("noise"));
  input_ = make_input(input, problem.layout, problem.where);
  if (skip) skip_ = std::make_unique<LinearSkip>();
  if (layers.empty()) return;
  Rng rng({seed_, kNetworkWeights});
  network_ = std::make_unique<Network>(layers, input_->shape(), rng);
}

NetworkModel::NetworkModel(const Container& file, const std::string& where)
    : kind_(stored_text(file, "model", where)) {
  map_ = InputMap::parse(parse_json(stored_text(file, "map", where), where, Exit::kModel), where,
                         Exit::kModel);
  Options scale(parse_json(stored_text(file, "target_scale", where), where, Exit::kModel), where,
                Exit::kModel);
  scale_.mean = parse_vector(scale.raw("mean"), where);
  scale_.deviation = parse_vector(scale.raw("deviation"), where);
  input_ = stored_input(parse_json(stored_text(file, "input", where), where, Exit::kModel),
                        map_.features(), where);
  require(scale_.mean.size() > 0 && scale_.mean.size() == scale_.deviation.size(), Exit::kModel,
          where, ": its output does not fit its targets");
  const std::string& parts = stored_text(file, "parts", where);
  require(parts == kNetwork || parts == kLinear || parts == kBoth, Exit::kModel, where,
          ": its parts are unknown: '", parts, "'");
  if (parts != kNetwork) {
    skip_ =
        std::make_unique<LinearSkip>(LinearSkip::load(file, element_count(input_->shape()), where));
    require(skip_->targets() == scale_.mean.size(), Exit::kModel, where,
            ": its linear part does not fit its targets");
  }
  if (parts != kLinear) load_network(file, where);
  const Eigen::MatrixXd probe = predict({map_.mean().transpose(), {}});
  require(scale_.mean.size() == probe.cols() && scale_.deviation.size() == probe.cols() &&
              (scale_.deviation.array() > 0.0).all() && probe.allFinite(),
          Exit::kModel, where, ": its output does not fit its targets");
}

void NetworkModel::load_network(const Container& file, const std::string& where) {
  const Json architecture =
      parse_json(stored_text(file, "architecture", where), where, Exit::kModel);
  try {
    Rng rng(0);
    network_ = std::make_unique<Network>(architecture, input_->shape(), rng);
  } catch (const Error& error) {
    fail(Exit::kModel, where, ": its architecture cannot be rebuilt: ", error.what());
  }
  load_tensors(file, "network.", network_->state(), where);
  refold();
}

NetworkModel::~NetworkModel() = default;

std::unique_ptr<Model> NetworkModel::load(const Container& file, const std::string& where) {
  return std::make_unique<NetworkModel>(file, where);
}

bool NetworkModel::fit(const Samples& training, const Samples& validation, FitSession& session) {
  map_ = InputMap(training.x, map_spec_, units_);
  spread_ = target_spread(training.y);
  scale_ = make_scale(training.y, spread_, training_.standardise_targets);
  input_->learn(training, map_, noise_);
  if (skip_) fit_skip(training);
  if (!network_) return true;
  Trainer trainer(*this, training, validation, session);
  if (!trainer.run()) return false;
  scale_.deviation *= training_.shrink;
  return true;
}

void NetworkModel::fit_skip(const Samples& training) {
  *skip_ = LinearSkip::fit(training, noise_, map_, *input_, seed_);
  scale_ = {Eigen::VectorXd::Zero(training.y.cols()), skip_->residual()};
}

void NetworkModel::refold() { batches_ = std::make_unique<BatchPlan>(*network_, precision_); }

void NetworkModel::set_precision(Precision precision) {
  if (!network_) return Model::set_precision(precision);
  precision_ = precision;
  refold();
}

Eigen::MatrixXd NetworkModel::predict(const Stream& stream) const {
  const PreparedStream prepared = input_->prepare(stream, map_);
  return predict_rows(stream.rows(),
                      [&](Index row, Real* out) { input_->write(prepared, map_, row, out); });
}

Eigen::MatrixXd NetworkModel::predict_with_noisy_entries(const Stream& stream, double snr,
                                                         std::uint64_t key) const {
  if (input_->to_json().at("kind") != "map") return {};
  const PreparedStream prepared = input_->prepare(stream, map_);
  const Index cells = element_count(input_->shape());
  Eigen::MatrixXd entries(stream.rows(), cells);
  std::vector<Real> own(static_cast<std::size_t>(cells));
  for (Index i = 0; i < stream.rows(); ++i) {
    input_->write(prepared, map_, i, own.data());
    entries.row(i) =
        Eigen::Map<const Eigen::RowVector<Real, Eigen::Dynamic>>(own.data(), cells).cast<double>();
  }
  const Eigen::MatrixXd centred = entries.rowwise() - entries.colwise().mean();
  const Eigen::VectorXd deviation =
      std::pow(10.0, -snr / 20.0) * centred.array().square().colwise().mean().sqrt().matrix();
  entries = with_noise(std::move(entries), deviation, key);
  return predict_rows(stream.rows(), [&](Index row, Real* out) {
    for (Index j = 0; j < cells; ++j) out[j] = static_cast<Real>(entries(row, j));
  });
}

Eigen::MatrixXd NetworkModel::predict_rows(
    Index rows, const std::function<void(Index row, Real* out)>& write) const {
  constexpr Index kBlock = 520;  // 40 pieces of 13: activations stay in the cache
  NoGradient guard;
  const Index cells = element_count(input_->shape());
  Eigen::MatrixXd result(rows, scale_.mean.size());
  for (Index first = 0; first < rows; first += kBlock) {
    const Index n = std::min(kBlock, rows - first);
    Shape shape = input_->shape();
    shape.insert(shape.begin(), n);
    Tensor inputs(std::move(shape));
    for (Index i = 0; i < n; ++i) write(first + i, inputs.data() + i * cells);
    result.middleRows(first, n) = outputs(inputs);
  }
  return result;
}

Eigen::MatrixXd NetworkModel::outputs(const Tensor& inputs) const {
  const Index n = inputs.dim(0), targets = scale_.mean.size();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, targets);
  if (skip_) result = skip_->of(inputs);
  if (!batches_) return result;
  require(element_count(network_->shapes().back()) == targets, Exit::kModel,
          "the network's outputs do not fit its targets");
  const Tensor network = Tensor::uninitialised({n, targets});
  batches_->run(inputs.data(), n, network.data());
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < targets; ++j) {
      const auto y = static_cast<double>(network.data()[i * targets + j]);
      result(i, j) += scale_.mean[j] + scale_.deviation[j] * y;
    }
  }
  return result;
}

bool NetworkModel::per_sample() const { return input_->per_sample(); }

std::optional<Network> NetworkModel::network() const {
  if (skip_ || !network_) return std::nullopt;
  return network_->folded();
}

Index NetworkModel::parameter_count() const {
  return (network_ ? network_->parameter_count() : 0) + (skip_ ? skip_->parameter_count() : 0);
}

void NetworkModel::save(Container& file) const {
  file.metadata["model"] = kind_;
  file.metadata["parts"] = !skip_ ? kNetwork : network_ ? kBoth : kLinear;
  if (network_) file.metadata["architecture"] = network_->layers().dump();
  file.metadata["input"] = input_->to_json().dump();
  file.metadata["map"] = map_.to_json().dump();
  file.metadata["target_scale"] =
      Json{{"mean", to_json(scale_.mean)}, {"deviation", to_json(scale_.deviation)}}.dump();
  if (skip_) skip_->save(file);
  if (network_) store_tensors(network_->state(), "network.", file);
}

}  // namespace dcnn
