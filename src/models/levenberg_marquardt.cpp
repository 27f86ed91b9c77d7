// SPDX-License-Identifier: Apache-2.0
#include "models/levenberg_marquardt.h"

#include <algorithm>
#include <utility>

#include "core/linear_algebra.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

Eigen::VectorXd stored_vector(const Container& file, const std::string& name, Index size) {
  const auto& values = stored_values<double>(file, name, "checkpoint");
  require(static_cast<Index>(values.size()) == size, Exit::kModel, "checkpoint: '", name,
          "' is not one of this training; start without --resume");
  return Eigen::Map<const Eigen::VectorXd>(values.data(), size);
}

}  // namespace

LevenbergMarquardt::LevenbergMarquardt(const NonlinearLeastSquares& training,
                                       const NonlinearLeastSquares* validation,
                                       const Settings& settings, Eigen::VectorXd start)
    : training_(training),
      validation_(validation),
      settings_(settings),
      weights_(std::move(start)),
      best_(weights_),
      mu_(settings.mu),
      loss_(training.loss(weights_)) {
  if (validation_) best_loss_ = validation_->loss(weights_);
}

bool LevenbergMarquardt::done() const {
  return stuck_ || epoch_ >= settings_.epochs || loss_ <= 0.0 ||
         failures_ >= settings_.most_failures;
}

bool LevenbergMarquardt::iterate() {
  const NormalEquations equations = training_.linearise(weights_);
  stuck_ = 2.0 * equations.gradient.norm() < settings_.least_gradient || !step(equations);
  if (stuck_) return false;
  ++epoch_;
  validate();
  return true;
}

/// Raises mu until the step dw = -(H + mu·I)^-1 g lowers the loss.
bool LevenbergMarquardt::step(const NormalEquations& equations) {
  while (mu_ <= settings_.most_mu) {
    Eigen::MatrixXd damped = equations.hessian;
    damped.diagonal().array() += mu_;
    if (const auto change = solve_definite(damped, equations.gradient)) {
      const Eigen::VectorXd next = weights_ - *change;
      const double loss = training_.loss(next);
      if (loss < loss_) {
        weights_ = next;
        loss_ = loss;
        mu_ = std::max(mu_ * settings_.decrease, settings_.least_mu);
        return true;
      }
    }
    mu_ *= settings_.increase;
  }
  return false;
}

void LevenbergMarquardt::validate() {
  const double loss = validation_ ? validation_->loss(weights_) : 0.0;
  if (!validation_ || loss < best_loss_) {
    best_ = weights_;
    best_loss_ = loss;
    best_epoch_ = epoch_;
    failures_ = 0;
  } else if (loss > best_loss_) {
    ++failures_;
  }
}

Container LevenbergMarquardt::save() const {
  const Index size = weights_.size();
  Container file;
  file.tensors.push_back(
      {"position", {3}, std::vector<std::int64_t>{epoch_, best_epoch_, failures_}});
  file.tensors.push_back({"weights", {size}, list_of(weights_)});
  file.tensors.push_back({"best", {size}, list_of(best_)});
  file.tensors.push_back({"numbers", {2}, std::vector<double>{mu_, best_loss_}});
  return file;
}

void LevenbergMarquardt::restore(const Container& file) {
  const auto& position = stored_values<std::int64_t>(file, "position", "checkpoint");
  require(position.size() == 3 && *std::min_element(position.begin(), position.end()) >= 0,
          Exit::kModel, "checkpoint: not one of this training; start without --resume");
  epoch_ = position[0];
  best_epoch_ = position[1];
  failures_ = position[2];
  const Index size = weights_.size();
  weights_ = stored_vector(file, "weights", size);
  best_ = stored_vector(file, "best", size);
  const Eigen::VectorXd numbers = stored_vector(file, "numbers", 2);
  mu_ = numbers[0];
  best_loss_ = numbers[1];
  loss_ = training_.loss(weights_);
}

}  // namespace dcnn
