// SPDX-License-Identifier: Apache-2.0
#include "models/weighted_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/tensor_io.h"

namespace dcnn {
namespace {

constexpr const char* kWeights = "weights";

class WeightedPredictor : public Predictor {
 public:
  WeightedPredictor(std::unique_ptr<Predictor> inner, const Eigen::VectorXd& weights)
      : inner_(std::move(inner)),
        weights_(weights),
        output_(Eigen::VectorXd::Zero(weights.size())) {}

  void reset() noexcept override { inner_->reset(); }
  const Eigen::VectorXd& push(const Eigen::VectorXd& x) noexcept override {
    output_ = weights_.cwiseProduct(inner_->push(x));
    return output_;
  }

 private:
  std::unique_ptr<Predictor> inner_;
  Eigen::VectorXd weights_, output_;
};

class WeightedModel : public Model {
 public:
  WeightedModel(std::unique_ptr<Model> inner, const Eigen::VectorXd& weights)
      : inner_(std::move(inner)), weights_(weights) {}

  bool fit(const Samples& training, const Samples& validation, FitSession& session) override {
    return inner_->fit(training, validation, session);
  }
  Eigen::MatrixXd predict(const Stream& stream) const override {
    return inner_->predict(stream) * weights_.asDiagonal();
  }
  std::unique_ptr<Predictor> predictor() const override {
    return std::make_unique<WeightedPredictor>(inner_->predictor(), weights_);
  }
  bool per_sample() const override { return inner_->per_sample(); }
  void set_precision(Precision precision) override { inner_->set_precision(precision); }
  Index parameter_count() const override { return inner_->parameter_count(); }
  const InputMap& map() const override { return inner_->map(); }
  std::vector<std::string> notes() const override { return inner_->notes(); }
  void save(Container& file) const override {
    inner_->save(file);
    file.metadata[kWeights] = Json(std::vector<double>(weights_.begin(), weights_.end())).dump();
  }
  Eigen::VectorXd novelty(const Stream& stream) const override { return inner_->novelty(stream); }

 private:
  std::unique_ptr<Model> inner_;
  Eigen::VectorXd weights_;
};

/// Of one target.
double trust(const Eigen::VectorXd& left, const Eigen::VectorXd& predicted, Index block) {
  constexpr double kErrors = 2.0;  // standard errors
  const Index blocks = (left.size() + block - 1) / block;
  Eigen::VectorXd along(blocks), power(blocks);
  for (Index b = 0; b < blocks; ++b) {
    const Index begin = b * block, rows = std::min(block, left.size() - begin);
    const auto p = predicted.segment(begin, rows);
    along(b) = p.dot(left.segment(begin, rows));
    power(b) = p.squaredNorm();
  }
  if (power.sum() == 0.0 || along.sum() <= 0.0 || blocks < 2) return 0.0;
  const double best = along.sum() / power.sum();
  const double spread = (along - best * power).squaredNorm() * static_cast<double>(blocks) /
                        static_cast<double>(blocks - 1);
  const double error = std::sqrt(spread) / power.sum();
  const double shrunk = 1.0 - std::pow(kErrors * error / best, 2);
  return std::clamp(best * std::max(0.0, shrunk), 0.0, 1.0);
}

}  // namespace

Eigen::VectorXd trust(const Samples& validation, const Eigen::MatrixXd& predicted, Index block) {
  constexpr Index kFewest = 8;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(predicted.cols());
  if (validation.rows() == 0) return weights;
  const Index rows = std::max<Index>(1, std::min(block, validation.rows() / kFewest));
  for (Index j = 0; j < weights.size(); ++j) {
    weights(j) = trust(validation.y.col(j), predicted.col(j), rows);
  }
  return weights;
}

std::unique_ptr<Model> weighted(std::unique_ptr<Model> model, const Eigen::VectorXd& weights) {
  return std::make_unique<WeightedModel>(std::move(model), weights);
}

std::unique_ptr<Model> with_stored_weights(std::unique_ptr<Model> model, Index targets,
                                           const Container& file, const std::string& where) {
  if (file.metadata.count(kWeights) == 0) return model;
  const Json json = parse_json(stored_text(file, kWeights, where), where, Exit::kModel);
  std::vector<double> weights;
  try {
    weights = json.get<std::vector<double>>();
  } catch (const Json::exception&) {
  }
  const auto fits = [](double w) { return w >= 0.0 && w <= 1.0; };
  require(static_cast<Index>(weights.size()) == targets &&
              std::all_of(weights.begin(), weights.end(), fits),
          Exit::kModel, where, ": its weights are not numbers from 0 to 1, one per target");
  return weighted(std::move(model), Eigen::Map<const Eigen::VectorXd>(weights.data(), targets));
}

}  // namespace dcnn
