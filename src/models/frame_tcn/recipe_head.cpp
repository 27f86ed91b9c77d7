// SPDX-License-Identifier: Apache-2.0
// The head's first values: scales, then a ridge that weighs each level of noise by what it leaves.
#include <algorithm>
#include <cmath>

#include "core/linear_algebra.h"
#include "models/frame_tcn/recipe.h"
#include "models/random_streams.h"

namespace dcnn::frame_tcn {
namespace {

constexpr Index kRidgeBatch = 500;
constexpr Index kLeastBatches = 8, kMostBatches = 80;
constexpr double kRidge = 3e-4;
constexpr double kLeastResidual = 1e-3;

/// Normal equations of one triple's World and Sensor, by column; those of all triples are the same.
class HeadEquations {
 public:
  HeadEquations(Index size, Index triples)
      : size_(size),
        normal_(Eigen::MatrixXd::Zero(6 * size, 6 * size)),
        right_(Eigen::MatrixXd::Zero(6 * size, triples)),
        plain_(Eigen::MatrixXd::Zero(size, size)) {}

  /// y (3·triples, n), w (n).
  void add(const Pass& pass, const Eigen::MatrixXd& y, const Eigen::VectorXd& w) {
    const Eigen::MatrixXd scaled = pass.z * w.asDiagonal();
    total_ += w.sum();
    plain_.noalias() += scaled * pass.z.transpose();
    for (Index world = 0; world < 3; ++world) add_world(world, pass, scaled, y);
    for (Index axis = 0; axis < 3; ++axis) {
      for (Index t = 0; t < right_.cols(); ++t) {
        right_.col(t).segment((3 + axis) * size_, size_) +=
            scaled * y.row(3 * t + axis).transpose();
      }
    }
  }

  /// (6·size, triples)
  Eigen::MatrixXd solve() {
    const Index half = 3 * size_;
    for (Index k = 0; k < 6; ++k) normal_.block(k * size_, k * size_, size_, size_) = plain_;
    normal_.bottomLeftCorner(half, half) = normal_.topRightCorner(half, half).transpose().eval();
    normal_.diagonal().array() += kRidge * total_;
    return solve_definite(normal_, right_).value();
  }

 private:
  void add_world(Index world, const Pass& pass, const Eigen::MatrixXd& scaled,
                 const Eigen::MatrixXd& y) {
    const Index n = y.cols();
    Eigen::MatrixXd in_world = Eigen::MatrixXd::Zero(right_.cols(), n);
    Eigen::VectorXd turn(n);
    for (Index axis = 0; axis < 3; ++axis) {
      for (Index i = 0; i < n; ++i) {
        turn[i] = pass.frames[static_cast<std::size_t>(i)].to_sensor(axis, world);
        for (Index t = 0; t < right_.cols(); ++t) in_world(t, i) += turn[i] * y(3 * t + axis, i);
      }
      normal_.block(world * size_, (3 + axis) * size_, size_, size_).noalias() +=
          scaled * turn.asDiagonal() * pass.z.transpose();
    }
    right_.middleRows(world * size_, size_) += scaled * in_world.transpose();
  }

  Index size_;
  Eigen::MatrixXd normal_, right_, plain_;
  double total_ = 0.0;
};

}  // namespace

/// Four draws of every row are enough for a head of some hundred numbers.
Index Recipe::ridge_batches() const {
  return std::clamp<Index>(4 * x_.rows() / kRidgeBatch, kLeastBatches, kMostBatches);
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
  return static_cast<std::size_t>(noise_[static_cast<std::size_t>(d.noise)].on_pose ? kLevelBins + k
                                                                                    : k);
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
    model_.spread_[t] = std::max(
        std::sqrt((y.rowwise() - mean).squaredNorm() / static_cast<double>(y.size())), 1e-9);
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
  Rng rng({spec_.seed, kTcnUnits});
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
  HeadEquations equations(net.columns_z(), net.plan().triples);
  for (Index k = 0; k < ridge_batches(); ++k) {
    Rng rng({spec_.seed, kTcnRidge, static_cast<std::uint64_t>(k)});
    Batch b = batch(rng, kRidgeBatch, false);
    net.denoise(b.pass);
    net.features(b.pass);
    const Eigen::VectorXd even = Eigen::VectorXd::Ones(kRidgeBatch);
    equations.add(b.pass, targets(b), weighted ? weights(b) : even);
  }
  const Eigen::MatrixXd solution = equations.solve();
  for (Index t = 0; t < net.plan().triples; ++t) {
    net.parameters.segment(net.world_begin(t), solution.rows()) = solution.col(t);
  }
}

/// Residual rms of each level of noise; where none was drawn, that of all.
void Recipe::measure_bins() {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(bins_.size()), count = sum;
  for (Index k = 0; k < ridge_batches() / 2; ++k) {
    Rng rng({spec_.seed, kTcnBins, static_cast<std::uint64_t>(k)});
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

}  // namespace dcnn::frame_tcn
