// SPDX-License-Identifier: Apache-2.0
#include "models/trainer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dcnn/core/ranks.h"
#include "dcnn/nn/loss.h"
#include "models/linear_skip.h"
#include "models/noisy_blocks.h"
#include "models/random_streams.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

std::vector<NamedTensor> copies(const std::vector<NamedTensor>& tensors) {
  std::vector<NamedTensor> result;
  for (const NamedTensor& t : tensors) {
    result.push_back({"best." + t.name, Tensor::from(t.tensor.shape(), t.tensor.values()), t.role});
  }
  return result;
}

void assign(const std::vector<NamedTensor>& to, const std::vector<NamedTensor>& from) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    std::ranges::copy(from[i].tensor.values(), to[i].tensor.data());
  }
}

/// Rows of x that every process has made of its pieces come to all.
void share_rows(const Tensor& x) {
  const Index rows = x.dim(0), pieces = piece_count(rows), bytes = x.dim(1) * Index{sizeof(Real)};
  share_pieces(x.data(), pieces, [&](Index k) { return piece_begin(rows, pieces, k) * bytes; });
}

/// x (N, outputs) with each row times its factor.
Tensor scaled_rows(const Tensor& x, const std::vector<Real>& factors) {
  const Index outputs = x.dim(1);
  const auto factor = [=](Index i) { return factors[static_cast<std::size_t>(i / outputs)]; };
  Tensor scaled(x.shape());
  for (Index i = 0; i < x.size(); ++i) scaled.data()[i] = factor(i) * x.data()[i];
  return record(scaled, {x}, [x, factor](const Tensor& out) {
    Real* gradient = x.gradient_data();
    for (Index i = 0; i < x.size(); ++i) gradient[i] += factor(i) * out.gradient()[i];
  });
}

}  // namespace

Trainer::Trainer(NetworkModel& model, const Samples& training, const Samples& validation,
                 FitSession& session)
    : model_(model),
      validation_(validation),
      session_(session),
      spec_(model.training_),
      training_(training) {
  const Index rows = training.rows() / spec_.stride;
  require(rows >= spec_.batch, Exit::kData, "only ", rows,
          " training rows an epoch for batches of ", spec_.batch,
          "; give longer recordings or a smaller training.batch or training.stride");
  require(rank_count() == 1 || model.network_->is_divisible(), Exit::kUsage,
          "an LSTM is trained by one process; run dcnn-train without mpirun");
  y_ = (training.y.rowwise() - model.scale_.mean.transpose()).array().rowwise() /
       model.scale_.deviation.transpose().array();
  steps_per_epoch_ = rows / spec_.batch;  // an incomplete last batch is skipped (D37)

  const auto& state = model.network_->state();
  Adam::Settings adam;
  adam.l2 = spec_.l2;
  adam.clip = spec_.clip;
  adam_ = std::make_unique<Adam>(state, adam);
  if (spec_.ema > 0.0) average_ = std::make_unique<WeightAverage>(state, spec_.ema);
  Options rate(spec_.rate, "training", Exit::kUsage);
  rate_ = std::make_unique<LearningRate>(rate, spec_.epochs, steps_per_epoch_);
  has_statistics_ = std::ranges::any_of(
      state, [](const NamedTensor& t) { return t.role == NamedTensor::Role::kStatistic; });
  best_ = copies(state);
  if (session.checkpoint) restore_checkpoint(*session.checkpoint);
}

bool Trainer::run() {
  while (epoch_ < spec_.epochs) {
    begin_epoch();
    if (!run_steps()) {
      save_checkpoint();
      return false;
    }
    finish_epoch();
  }
  restore_best();
  model_.refold();
  return true;
}

/// Draws the epoch's order and noise level; the same after a resume in its middle. Every stride-th
/// row takes part, from a first one that moves on with the epochs: neighbours resemble each other.
void Trainer::begin_epoch() {
  const auto epoch = static_cast<std::uint64_t>(epoch_);
  Rng shuffle({model_.seed_, kShuffle, spec_.shuffle_every_epoch ? epoch : 0});
  const Index start = epoch_ % spec_.stride;
  order_ = permutation((training_.rows() - start + spec_.stride - 1) / spec_.stride, shuffle);
  for (std::int64_t& row : order_) row = start + spec_.stride * row;
  const NoiseSpec& noise = model_.noise_;
  const auto key = Rng({model_.seed_, kEpochNoise, epoch}).bits();
  if (noise.block_rows == 0) {
    snr_ = noise.levels[Rng({model_.seed_, kEpochLevel, epoch}).below(noise.levels.size())];
    noisy_ = model_.input_->prepare(noisy(training_, noise, model_.map_, snr_, key), model_.map_);
  } else {
    if (model_.skip_) weigh_rows(block_levels(training_, noise, key));
    noisy_ = model_.input_->prepare(noisy_blocks(training_, noise, model_.map_, key), model_.map_);
  }
}

/// The rows weigh as they did in the fit of the skip, by their level of noise.
void Trainer::weigh_rows(const std::vector<std::size_t>& level_of) {
  row_factors_.resize(level_of.size());
  for (std::size_t row = 0; row < level_of.size(); ++row) {
    row_factors_[row] = static_cast<Real>(std::sqrt(model_.skip_->level_weights()[level_of[row]]));
  }
}

bool Trainer::run_steps() {
  const KeptMemory kept;
  while (step_ < steps_per_epoch_) {
    if (any_rank(session_.stop_wanted && session_.stop_wanted())) return false;
    step();
    ++step_;
    if (session_.step_done) {
      session_.step_done(epoch_ + 1, step_, steps_per_epoch_,
                         loss_sum_ / static_cast<double>(step_));
    }
  }
  return true;
}

void Trainer::step() {
  const auto epoch = static_cast<std::uint64_t>(epoch_), number = static_cast<std::uint64_t>(step_);
  const Index first = step_ * spec_.batch;
  Pass pass{Pass::Mode::kTrain, Rng({model_.seed_, kDropout, epoch, number})};
  const DividedWork divided;
  const Tensor inputs = gather(noisy_, order_, first);
  Tensor predicted = model_.network_->forward(inputs, pass), wanted = gather_targets(inputs, first);
  share_rows(predicted);
  if (!row_factors_.empty()) {
    const std::vector<Real> factors = gather_factors(first);
    predicted = scaled_rows(predicted, factors);
    wanted = scaled_rows(wanted, factors);
  }
  const Tensor loss = half_mean_squared_error(predicted, wanted);
  const double value = loss.values()[0];
  require(std::isfinite(value), Exit::kFailure, "training diverged in epoch ", epoch_ + 1,
          ": the loss is not finite; lower training.lr");
  loss.backward();
  adam_->step(rate_->at(epoch_, step_));
  if (average_) average_->update();
  loss_sum_ += value;
}

/// The network's inputs of the batch that starts at `first`.
Tensor Trainer::gather(const PreparedStream& stream, const std::vector<std::int64_t>& order,
                       Index first) const {
  Shape shape = model_.input_->shape();
  const Index cells = element_count(shape);
  shape.insert(shape.begin(), spec_.batch);
  Tensor inputs(std::move(shape));
  const Index pieces = piece_count(spec_.batch);
  for_each_piece(pieces, [&](Index k) {
    for (Index i = piece_begin(spec_.batch, pieces, k); i < piece_begin(spec_.batch, pieces, k + 1);
         ++i) {
      model_.input_->write(stream, model_.map_, order[static_cast<std::size_t>(first + i)],
                           inputs.data() + i * cells);
    }
  });
  return inputs;
}

/// Targets of the batch, or what the skip leaves of them, on the network's own scale.
Tensor Trainer::gather_targets(const Tensor& inputs, Index first) const {
  const Index targets = y_.cols();
  Tensor wanted({spec_.batch, targets});
  Eigen::MatrixXd skip = Eigen::MatrixXd::Zero(spec_.batch, targets);
  if (model_.skip_) skip = model_.skip_->of(inputs);
  for (Index i = 0; i < spec_.batch; ++i) {
    const Index row = order_[static_cast<std::size_t>(first + i)];
    for (Index j = 0; j < targets; ++j) {
      wanted.data()[i * targets + j] =
          static_cast<Real>(y_(row, j) - skip(i, j) / model_.scale_.deviation[j]);
    }
  }
  return wanted;
}

std::vector<Real> Trainer::gather_factors(Index first) const {
  std::vector<Real> factors;
  for (Index i = first; i < first + spec_.batch; ++i) {
    const auto row = static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]);
    factors.push_back(row_factors_[row]);
  }
  return factors;
}

void Trainer::finish_epoch() {
  EpochRecord record;
  record.epoch = epoch_ + 1;
  record.loss = loss_sum_ / static_cast<double>(steps_per_epoch_);
  record.rate = rate_->at(epoch_, 0);
  record.snr_db = snr_;
  if (average_) average_->swap();
  if (spec_.full_statistics && has_statistics_) collect_statistics();
  model_.refold();
  record.validation_rmse = validation_rmse();
  keep_if_best(record);
  if (session_.epoch_done) session_.epoch_done(record);
  if (average_) average_->swap();
  ++epoch_;
  step_ = 0;
  loss_sum_ = 0.0;
  save_checkpoint();
}

/// Batch norm's inference statistics (Ioffe and Szegedy 2015): one pass over the clean training
/// set, in shuffled batches as in training, since neighbouring rows resemble each other too much to
/// make a batch.
void Trainer::collect_statistics() {
  NoGradient guard;
  Rng rng({model_.seed_, kCollectOrder});
  const auto order = permutation(training_.rows(), rng);
  const PreparedStream clean = model_.input_->prepare(training_, model_.map_);
  Pass pass{Pass::Mode::kCollect, Rng(0)};
  const DividedWork divided;
  for (Index k = 0; k < training_.rows() / spec_.batch; ++k) {
    pass.batch_number = k;
    model_.network_->forward(gather(clean, order, k * spec_.batch), pass);
  }
}

std::vector<double> Trainer::validation_rmse() const {
  if (validation_.rows() == 0) return {};
  const Eigen::MatrixXd error = model_.predict(validation_) - validation_.y;
  const Eigen::VectorXd rmse = error.array().square().colwise().mean().sqrt().transpose();
  return {rmse.data(), rmse.data() + rmse.size()};
}

/// The score is the mean of the RMSEs in units of each target's spread, so that newtons and
/// newton-metres weigh alike.
void Trainer::keep_if_best(EpochRecord& record) {
  double score = -static_cast<double>(record.epoch);  // without validation the last epoch is kept
  if (spec_.keep_best && !record.validation_rmse.empty()) {
    score = 0.0;
    for (std::size_t j = 0; j < record.validation_rmse.size(); ++j) {
      score += record.validation_rmse[j] / model_.spread_[static_cast<Index>(j)];
    }
  }
  record.best = score < best_score_;
  if (!record.best) return;
  best_score_ = score;
  assign(best_, model_.network_->state());
}

void Trainer::restore_best() { assign(model_.network_->state(), best_); }

std::vector<NamedTensor> Trainer::everything() const {
  auto all = model_.network_->state();
  for (const auto& part :
       {adam_->state(), average_ ? average_->state() : std::vector<NamedTensor>{}, best_}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

void Trainer::save_checkpoint() const {
  if (!session_.save_checkpoint) return;
  Container file;
  store_tensors(everything(), "", file);
  file.tensors.push_back(
      {"position", {3}, std::vector<std::int64_t>{epoch_, step_, adam_->steps()}});
  // JSON cannot hold infinity, and a container refuses it too: no best epoch yet is an empty
  // tensor.
  std::vector<double> sums{loss_sum_};
  if (std::isfinite(best_score_)) sums.push_back(best_score_);
  file.tensors.push_back({"sums", {static_cast<Index>(sums.size())}, sums});
  session_.save_checkpoint(file);
}

void Trainer::restore_checkpoint(const Container& file) {
  load_tensors(file, "", everything(), "checkpoint");
  const auto position = stored_values<std::int64_t>(file, "position", "checkpoint");
  const auto sums = stored_values<double>(file, "sums", "checkpoint");
  require(position.size() == 3 && !sums.empty() && position[0] >= 0 && position[1] >= 0,
          Exit::kModel, "checkpoint: not one of this training; start without --resume");
  epoch_ = position[0];
  step_ = position[1];
  adam_->set_steps(position[2]);
  loss_sum_ = sums[0];
  if (sums.size() > 1) best_score_ = sums[1];
}

}  // namespace dcnn
