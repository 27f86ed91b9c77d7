// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/recipe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/random_streams.h"
#include "models/tensor_io.h"

namespace dcnn::frame_tcn {
namespace {

constexpr Index kGateBatch = 500, kHeadBatch = 250;
constexpr double kClip = 5.0;

double cosine(double rate, Index step, Index steps) {
  const double share = static_cast<double>(step) / static_cast<double>(steps);
  return 0.5 * rate * (1.0 + std::cos(std::numbers::pi * share));
}

StoredTensor stored(const char* name, const Eigen::VectorXd& v) {
  return {name, {v.size()}, std::vector<double>(v.data(), v.data() + v.size())};
}

void restore(const Container& file, const char* name, Eigen::VectorXd& v) {
  const auto& values = stored_values<double>(file, name, "checkpoint");
  require(static_cast<Index>(values.size()) == v.size(), Exit::kModel,
          "checkpoint: not one of this training; start without --resume");
  std::copy(values.begin(), values.end(), v.data());
}

}  // namespace

Recipe::Recipe(FrameTcn& model, const Samples& training, const Samples& validation,
               FitSession& session)
    : model_(model),
      spec_(model.spec_),
      training_(training),
      validation_(validation),
      session_(session),
      bins_(Eigen::VectorXd::Ones(2 * kLevelBins + 1)),
      adam_(model.net_.parameters) {
  require(training.rows() >= kLevelSpan, Exit::kData, "only ", training.rows(),
          " training rows; model 'frame-tcn' needs ", kLevelSpan, " or more");
}

bool Recipe::run() {
  scale_channels();
  make_noise();
  calibrate_novelty();
  make_filters();
  make_material();
  scale_levels();
  const Index first_of_head = spec_.epochs / 2;
  if (session_.checkpoint) restore_checkpoint(*session_.checkpoint);
  while (epoch_ < spec_.epochs) {
    if (epoch_ == first_of_head) begin_head();
    if (!run_epoch()) return false;
  }
  model_.net_.parameters = adam_.average;
  calibrate_pace();
  return true;
}

bool Recipe::run_epoch() {
  const bool head = epoch_ >= spec_.epochs / 2;
  const Index first = (head ? epoch_ - spec_.epochs / 2 : epoch_) * spec_.steps;
  double sum = 0.0;
  for (Index k = 0; k < spec_.steps; ++k) {
    if (session_.stop_wanted && session_.stop_wanted()) return false;
    const double loss = head ? head_step(first + k) : gate_step(first + k);
    require(std::isfinite(loss), Exit::kFailure, "training diverged in epoch ", epoch_ + 1,
            ": the loss is not finite; lower training.lr");
    sum += loss;
    if (session_.step_done) {
      session_.step_done(epoch_ + 1, k + 1, spec_.steps, sum / static_cast<double>(k + 1));
    }
  }
  ++epoch_;
  finish_epoch(sum / static_cast<double>(spec_.steps));
  return true;
}

void Recipe::finish_epoch(double loss) {
  const Eigen::VectorXd learning = model_.net_.parameters;
  model_.net_.parameters = adam_.average;
  if (session_.epoch_done) {
    EpochRecord record;
    record.epoch = epoch_;
    record.loss = loss;
    record.rate = epoch_ > spec_.epochs / 2 ? spec_.head_rate : spec_.gate_rate;
    const bool head = epoch_ > spec_.epochs / 2;
    record.best = head;  // the average of the weights only gets better
    if (validation_.rows() > 0) {
      Eigen::MatrixXd error = -validation_.y;
      if (head) error += model_.predict(validation_);
      const Eigen::VectorXd rmse = error.array().square().colwise().mean().sqrt().transpose();
      record.validation_rmse.assign(rmse.data(), rmse.data() + rmse.size());
    }
    session_.epoch_done(record);
  }
  model_.net_.parameters = learning;
  save_checkpoint();
}

/// MSE to the clean channels in units of what the matching expert leaves: else the noisiest level
/// owns the loss.
double Recipe::gate_step(Index step) {
  Net& net = model_.net_;
  if (net.gate_size() == 0) return 0.0;
  Rng rng({spec_.seed, kTcnGates, static_cast<std::uint64_t>(step)});
  Batch b = batch(rng, kGateBatch, true);
  net.denoise(b.pass);
  Eigen::MatrixXd d = b.pass.clean - b.clean;
  double loss = 0.0;
  const double share = 1.0 / static_cast<double>(d.size());
  for (Index i = 0; i < d.cols(); ++i) {
    for (Index c = 0; c < kChannels; ++c) {
      const double weight = share / wanted_error(b.draws[static_cast<std::size_t>(i)], c);
      loss += weight * d(c, i) * d(c, i);
      d(c, i) *= 2.0 * weight;
    }
  }
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(net.parameters.size());
  net.pull_back_denoise(b.pass, d, gradient);
  adam_.step(net.parameters, gradient,
             cosine(spec_.gate_rate, step, spec_.steps * std::max<Index>(1, spec_.epochs / 2)),
             kClip, spec_.ema);
  return loss;
}

double Recipe::head_step(Index step) {
  Net& net = model_.net_;
  Rng rng({spec_.seed, kTcnHead, static_cast<std::uint64_t>(step)});
  Batch b = batch(rng, kHeadBatch, false);
  net.denoise(b.pass);
  net.features(b.pass);
  net.product(b.pass);
  const Eigen::VectorXd w = weights(b) / static_cast<double>(kHeadBatch);
  const Eigen::MatrixXd error = b.pass.out - targets(b);
  const Eigen::MatrixXd d_out = 2.0 * error * w.asDiagonal();
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(net.parameters.size());
  const Eigen::MatrixXd d_clean = net.pull_back_head(b.pass, d_out, gradient);
  net.pull_back_denoise(b.pass, d_clean, gradient);
  const Index steps = spec_.steps * (spec_.epochs - spec_.epochs / 2);
  adam_.step(net.parameters, gradient, cosine(spec_.head_rate, step, steps), kClip, spec_.ema);
  return error.array().square().colwise().sum().matrix().dot(w);
}

void Recipe::save_checkpoint() const {
  if (!session_.save_checkpoint) return;
  Container file;
  file.tensors = {{"position", {2}, std::vector<std::int64_t>{epoch_, adam_.steps}},
                  stored("parameters", model_.net_.parameters),
                  stored("adam.first", adam_.first),
                  stored("adam.second", adam_.second),
                  stored("adam.average", adam_.average),
                  stored("bins", bins_),
                  stored("unit", model_.net_.unit),
                  stored("spread", model_.spread_)};
  session_.save_checkpoint(file);
}

void Recipe::restore_checkpoint(const Container& file) {
  const auto& position = stored_values<std::int64_t>(file, "position", "checkpoint");
  require(position.size() == 2 && position[0] >= 0 && position[1] >= 0, Exit::kModel,
          "checkpoint: not one of this training; start without --resume");
  epoch_ = position[0];
  adam_.steps = position[1];
  restore(file, "parameters", model_.net_.parameters);
  restore(file, "adam.first", adam_.first);
  restore(file, "adam.second", adam_.second);
  restore(file, "adam.average", adam_.average);
  restore(file, "bins", bins_);
  restore(file, "unit", model_.net_.unit);
  restore(file, "spread", model_.spread_);
}

}  // namespace dcnn::frame_tcn
