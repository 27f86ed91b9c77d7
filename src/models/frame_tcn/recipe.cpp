#include "models/frame_tcn/recipe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/tensor_io.h"

namespace dcnn::frame_tcn {
namespace {

enum RandomStream : std::uint64_t { kGates = 112, kHead, kUnits, kRidgeDraw, kBins };
constexpr Index kGateBatch = 500, kHeadBatch = 250;
constexpr Index kRidgeBatches = 80, kRidgeBatch = 500;
constexpr double kRidge = 3e-4, kClip = 5.0;
constexpr Index kLevelBins = 16;   // of 5 dB from -5 dB on, of each kind of noise; the last is clean
constexpr double kLeastResidual = 1e-3;

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
    record.best = epoch_ > spec_.epochs / 2;  // the average of the weights only gets better
    if (validation_.rows() > 0 && record.best) {
      const Eigen::VectorXd rmse = (model_.predict(validation_) - validation_.y)
                                       .array().square().colwise().mean().sqrt().transpose();
      record.validation_rmse.assign(rmse.data(), rmse.data() + rmse.size());
    }
    session_.epoch_done(record);
  }
  model_.net_.parameters = learning;
  save_checkpoint();
}

/// MSE to the clean channels in units of what the matching expert leaves: else the noisiest level owns
/// the loss.
double Recipe::gate_step(Index step) {
  Net& net = model_.net_;
  if (net.gate_size() == 0) return 0.0;
  Rng rng({spec_.seed, kGates, static_cast<std::uint64_t>(step)});
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

Eigen::MatrixXd Recipe::targets(const Batch& b) const {
  Eigen::MatrixXd y(training_.y.cols(), static_cast<Index>(b.draws.size()));
  for (Index i = 0; i < y.cols(); ++i) {
    y.col(i) = training_.y.row(b.draws[static_cast<std::size_t>(i)].row).transpose();
  }
  for (Index t = 0; t < model_.spread_.size(); ++t) y.middleRows(3 * t, 3) /= model_.spread_[t];
  return y;
}

std::size_t Recipe::bin(const Draw& d) const {
  if (d.noise < 0) return 2 * kLevelBins;
  const auto k = std::clamp<Index>(static_cast<Index>((d.snr + 5.0) / 5.0), 0, kLevelBins - 1);
  return static_cast<std::size_t>(noise_[static_cast<std::size_t>(d.noise)].on_pose ? kLevelBins + k : k);
}

Eigen::VectorXd Recipe::weights(const Batch& b) const {
  Eigen::VectorXd w(static_cast<Index>(b.draws.size()));
  for (Index i = 0; i < w.size(); ++i) {
    const double sigma = bins_[static_cast<Index>(bin(b.draws[static_cast<std::size_t>(i)]))];
    w[i] = 1.0 / (sigma * sigma);
  }
  return w;
}

void Recipe::begin_head() {
  if (adam_.steps > 0) model_.net_.parameters = adam_.average;
  for (Index t = 0; t < model_.spread_.size(); ++t) {
    const auto y = training_.y.middleCols(3 * t, 3);
    const Eigen::RowVectorXd mean = y.colwise().mean();
    model_.spread_[t] =
        std::max(std::sqrt((y.rowwise() - mean).squaredNorm() / static_cast<double>(y.size())), 1e-9);
  }
  measure_units();
  solve_head(false);
  measure_bins();
  solve_head(true);
  measure_bins();
  adam_ = Adam(model_.net_.parameters);
}

/// Scales of z and of the saturating units, on clean rows.
void Recipe::measure_units() {
  Net& net = model_.net_;
  Rng rng({spec_.seed, kUnits});
  Batch b;
  for (Index i = 0; i < 4000; ++i) {
    Draw d;
    d.row = static_cast<Index>(rng.below(static_cast<std::uint64_t>(x_.rows())));
    b.draws.push_back(d);
  }
  fill(b);
  net.unit.setOnes();
  net.denoise(b.pass);
  net.features(b.pass);
  const Eigen::VectorXd rms = b.pass.z.topRows(kSmooth).array().square().rowwise().mean().sqrt();
  net.unit = rms.cwiseMax(1e-6);
  Eigen::VectorXd u(9);  // v, R^T v, omega
  u << rms.segment<3>(4), rms.segment<3>(7), rms.segment<3>(10);
  net.start_scales(u);
}

/// Weighted ridge of R·y = World^T z + R·Sensor^T z, whose normal equations are sums of z z^T.
void Recipe::solve_head(bool weighted) {
  Net& net = model_.net_;
  const Index size = net.columns_z(), outputs = training_.y.cols();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(6 * size, 6 * size);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(6 * size, outputs / 3);
  Eigen::MatrixXd plain = Eigen::MatrixXd::Zero(size, size), scaled;
  double total = 0.0;
  for (Index k = 0; k < kRidgeBatches; ++k) {
    Rng rng({spec_.seed, kRidgeDraw, static_cast<std::uint64_t>(k)});
    Batch b = batch(rng, kRidgeBatch, false);
    net.denoise(b.pass);
    net.features(b.pass);
    const Eigen::MatrixXd& z = b.pass.z;
    const Eigen::MatrixXd y = targets(b);
    const Eigen::VectorXd w = weighted ? weights(b) : Eigen::VectorXd(Eigen::VectorXd::Ones(kRidgeBatch));
    total += w.sum();
    scaled = z * w.asDiagonal();
    plain.noalias() += scaled * z.transpose();
    for (Index world = 0; world < 3; ++world) {
      Eigen::MatrixXd in_world = Eigen::MatrixXd::Zero(outputs / 3, kRidgeBatch);
      for (Index axis = 0; axis < 3; ++axis) {
        Eigen::VectorXd turn(kRidgeBatch);
        for (Index i = 0; i < kRidgeBatch; ++i) {
          turn[i] = b.pass.frames[static_cast<std::size_t>(i)].to_sensor(axis, world);
          for (Index t = 0; t < outputs / 3; ++t) in_world(t, i) += turn[i] * y(3 * t + axis, i);
        }
        normal.block(world * size, (3 + axis) * size, size, size).noalias() +=
            scaled * turn.asDiagonal() * z.transpose();
      }
      right.middleRows(world * size, size) += scaled * in_world.transpose();
    }
    for (Index axis = 0; axis < 3; ++axis) {
      for (Index t = 0; t < outputs / 3; ++t) {
        right.col(t).segment((3 + axis) * size, size) += scaled * y.row(3 * t + axis).transpose();
      }
    }
  }
  for (Index k = 0; k < 6; ++k) normal.block(k * size, k * size, size, size) = plain;
  normal.bottomLeftCorner(3 * size, 3 * size) =
      normal.topRightCorner(3 * size, 3 * size).transpose().eval();
  normal.diagonal().array() += kRidge * total;
  const Eigen::MatrixXd solution = normal.llt().solve(right);
  for (Index t = 0; t < outputs / 3; ++t) {
    net.parameters.segment(net.world_begin(t), 6 * size) = solution.col(t);
  }
}

/// Residual rms of each level of noise; where none was drawn, that of all.
void Recipe::measure_bins() {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(bins_.size()), count = sum;
  for (Index k = 0; k < kRidgeBatches / 2; ++k) {
    Rng rng({spec_.seed, kBins, static_cast<std::uint64_t>(k)});
    Batch b = batch(rng, kRidgeBatch, false);
    model_.net_.denoise(b.pass);
    model_.net_.features(b.pass);
    model_.net_.product(b.pass);
    const Eigen::MatrixXd error = b.pass.out - targets(b);
    for (Index i = 0; i < error.cols(); ++i) {
      const auto j = static_cast<Index>(bin(b.draws[static_cast<std::size_t>(i)]));
      sum[j] += error.col(i).squaredNorm() / static_cast<double>(error.rows());
      count[j] += 1.0;
    }
  }
  const double all = std::sqrt(sum.sum() / std::max(1.0, count.sum()));
  for (Index j = 0; j < bins_.size(); ++j) {
    bins_[j] = std::max(count[j] > 20.0 ? std::sqrt(sum[j] / count[j]) : all, kLeastResidual);
  }
}

double Recipe::head_step(Index step) {
  Net& net = model_.net_;
  Rng rng({spec_.seed, kHead, static_cast<std::uint64_t>(step)});
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
