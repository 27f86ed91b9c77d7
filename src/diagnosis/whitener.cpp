// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/whitener.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/elementary.h"

namespace dcnn {
namespace {

constexpr double kBlockPeriods = 0.4;  // periods of the fastest motion: 20 ms for 20 Hz
constexpr double kEnd = 5.0;           // of a segment, left out at either end, likewise
constexpr int kOrder = 8;
constexpr int kLongOrder = 48;  // slow noise remembers long
constexpr int kFrequencies = 4096;

/// Autocovariance at lags 0 … order of means over blocks of `block` samples of a noise.
template <class Density>
Eigen::VectorXd block_covariance(const Density& density, Index block, double dt, int order) {
  Eigen::VectorXd covariance = Eigen::VectorXd::Zero(order + 1);
  const auto b = static_cast<double>(block);
  for (int i = 0; i < kFrequencies; ++i) {
    const double hz = (i + 0.5) / kFrequencies * 0.5 / dt, x = std::numbers::pi * hz * dt;
    const double mean = elementary::sin(b * x) / (b * elementary::sin(x));
    const double power = density(hz) * mean * mean / kFrequencies;
    for (int lag = 0; lag <= order; ++lag)
      covariance(lag) += power * elementary::cos(2.0 * x * b * lag);
  }
  return covariance;
}

}  // namespace

Whitener::Whitener(const Case& study, const std::vector<Floor>& floors, const Signals& levels,
                   const Eigen::MatrixXd& correlation)
    : floors_(floors), channels_(study.channel_count()) {
  const bool moving = !study.is_static();
  const double dt = moving ? study.dt() : 1.0;
  block_ = moving ? std::max<Index>(1, std::llround(kBlockPeriods / study.shown_hz() / dt)) : 1;
  if (block_ > 3) block_ += block_ % 2;  // two halves: coarse_stride()
  block_seconds_ = static_cast<double>(block_) * dt;
  block_deviation_.resize(channels_);
  Eigen::VectorXd pose_share = Eigen::VectorXd::Zero(channels_);  // of a block's variance
  for (Index j = 0; j < channels_; ++j) {
    const Floor& floor = floors[static_cast<std::size_t>(j)];
    const int longest = !moving ? 0 : floor.is_slow() ? kLongOrder : kOrder;
    Eigen::VectorXd c = Eigen::VectorXd::Zero(longest + 1);
    if (moving) {
      const Eigen::VectorXd pose =
          block_covariance([&](double hz) { return floor.pose_density(hz); }, block_, dt, longest);
      c = pose +
          block_covariance([&](double hz) { return floor.density(hz); }, block_, dt, longest);
      pose_share(j) = c(0) > 0.0 ? pose(0) / c(0) : 0.0;
    } else {
      c(0) = floor.white + floor.coloured;
    }
    c(0) = std::max(c(0) * (1.0 + 1e-6), 1e-300);
    block_deviation_(j) = std::sqrt(c(0));
    // Levinson and Durbin: predictors of every order.
    Filter filter;
    std::vector<double> a;
    double error = c(0);
    filter.coefficients.emplace_back();
    filter.deviation.push_back(std::sqrt(error));
    for (int order = 1; order <= longest; ++order) {
      double k = c(order);
      for (int i = 0; i < order - 1; ++i) k -= a[static_cast<std::size_t>(i)] * c(order - 1 - i);
      k /= error;
      std::vector<double> next(a);
      for (std::size_t i = 0; i < a.size(); ++i) next[i] -= k * a[a.size() - 1 - i];
      next.push_back(k);
      a = next;
      error = std::max(error * (1.0 - k * k), 1e-12 * c(0));
      filter.coefficients.push_back(a);
      filter.deviation.push_back(std::sqrt(error));
    }
    filters_.push_back(filter);
  }
  if (correlation.size() > 0 && !correlation.isIdentity(0.0)) {
    // Of the sensor's noise; what the pose adds has its own.
    const Eigen::VectorXd own = (1.0 - pose_share.array()).sqrt();
    Eigen::MatrixXd all = own.asDiagonal() * correlation * own.asDiagonal();
    all.diagonal().setOnes();
    decorrelate_ = Eigen::MatrixXd::Identity(channels_, channels_);
    Eigen::LLT<Eigen::MatrixXd>(all).matrixL().solveInPlace(decorrelate_);
  }
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    std::vector<Index> before;  // sizes of the segments before this one
    for (const Segment& s : study.logs[k].motion.segments) {
      double end = moving ? kEnd / study.shown_hz() : 0.0;
      if (moves_fast(study)) {
        end = std::max(end, end_seconds(study, dt * static_cast<double>(s.size())));
      }
      const Index margin = std::llround(end / block_seconds_) * block_;
      const Index count = (s.size() - 2 * margin) / block_;
      if (count > 0) runs_.push_back({k, s.begin + margin, count, margin, before});
      before.push_back(s.size());
      if (count <= 0) continue;
      rows_ += count * channels_;
    }
  }
  inverse_level_.resize(rows_);
  info_.reserve(static_cast<std::size_t>(rows_));
  Index row = 0;
  for (const Run& run : runs_) {
    for (Index j = 0; j < channels_; ++j) {
      for (Index b = 0; b < run.count; ++b, ++row) {
        const Index middle = run.first + b * block_ + block_ / 2;
        info_.push_back({static_cast<std::uint32_t>(run.log), static_cast<std::uint32_t>(j),
                         study.logs[run.log].motion.t(middle)});
        const double level =
            levels[run.log](middle, j);  // of the sensor's noise, not of the pose's
        inverse_level_(row) =
            1.0 / std::sqrt(pose_share(j) + (1.0 - pose_share(j)) * level * level);
      }
    }
  }
}

void Whitener::allow_for_error(const Signals& left, const Eigen::VectorXd& mask) {
  const Eigen::ArrayXd whitened = (*this)(left).array();
  for (Index j = 0; j < channels_; ++j) {
    double square = 0.0, rows = 0.0;
    for (Index row = 0; row < rows_; ++row) {
      if (info_[static_cast<std::size_t>(row)].channel != static_cast<std::uint32_t>(j)) continue;
      const double unweighed = whitened(row) / inverse_level_(row);
      square += mask(row) * unweighed * unweighed;
      rows += mask(row);
    }
    const double error = rows > 0.0 ? std::max(0.0, square / rows - 1.0) : 0.0;
    for (Index row = 0; row < rows_; ++row) {
      if (info_[static_cast<std::size_t>(row)].channel != static_cast<std::uint32_t>(j)) continue;
      double& inverse = inverse_level_(row);
      inverse = std::sqrt((1.0 + error) / (1.0 / (inverse * inverse) + error));
    }
  }
}

Index Whitener::Run::thin_begin(Index stride) const {
  Index samples = 0;
  for (const Index size : before) samples += (size - stride / 2 + stride - 1) / stride;
  return samples + margin / stride;
}

Whitener Whitener::at_stride(Index stride) const {
  Whitener coarse = *this;
  coarse.block_ /= stride;
  for (Run& run : coarse.runs_) {
    run.first = run.thin_begin(stride);
  }
  return coarse;
}

double Whitener::log_determinant() const {
  double sum = 0.0;
  for (std::size_t row = 0; row < info_.size(); ++row) {
    sum += elementary::log(filters_[info_[row].channel].deviation.back() /
                           inverse_level_(static_cast<Index>(row)));
    if (decorrelate_.size() > 0) {
      const auto j = static_cast<Index>(info_[row].channel);
      sum -= elementary::log(decorrelate_(j, j));
    }
  }
  return 2.0 * sum;
}

double Whitener::expected_density(Index channel, double hz) const {
  const Floor& floor = floors_[static_cast<std::size_t>(channel)];
  if (!floor.is_slow()) return 1.0;
  const Filter& filter = filters_[static_cast<std::size_t>(channel)];
  std::complex<double> gain = 1.0;
  for (std::size_t i = 0; i < filter.coefficients.back().size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * hz * block_seconds_ * double(i + 1);
    gain -= filter.coefficients.back()[i] * elementary::polar(1.0, -angle);
  }
  // Of block means below half their rate, where the average over a block hardly attenuates.
  const double variance = filter.deviation.back() * filter.deviation.back();
  const double blocks = floor.density(hz) * floor.dt / block_seconds_;
  return std::max(1.0, blocks * std::norm(gain) / variance);
}

Eigen::VectorXd Whitener::operator()(const Signals& signals) const {
  Eigen::VectorXd out(rows_);
  Index row = 0;
  Eigen::VectorXd means;
  for (const Run& run : runs_) {
    const Eigen::MatrixXd& signal = signals[run.log];
    means.resize(run.count);
    for (Index j = 0; j < channels_; ++j) {
      auto white = out.segment(row, run.count);
      const auto own = signal.col(j).segment(run.first, run.count * block_);
      if (own.isZero(0.0)) {  // most laws act along one axis
        white.setZero();
        row += run.count;
        continue;
      }
      means = own.reshaped(block_, run.count).colwise().mean();
      const Filter& filter = filters_[static_cast<std::size_t>(j)];
      const Index most = std::min(run.count, static_cast<Index>(filter.coefficients.size()) - 1);
      white = means;
      for (Index b = 0; b < most; ++b) {  // shorter predictors where less is remembered
        const auto order = static_cast<std::size_t>(b);
        for (Index i = 0; i < b; ++i)
          white(b) -= filter.coefficients[order][std::size_t(i)] * means(b - 1 - i);
        white(b) /= filter.deviation[order];
      }
      const Index rest = run.count - most;
      for (Index i = 0; i < most && rest > 0; ++i) {
        white.tail(rest) -= filter.coefficients.back()[static_cast<std::size_t>(i)] *
                            means.segment(most - 1 - i, rest);
      }
      if (rest > 0) white.tail(rest) /= filter.deviation.back();
      white.array() *= inverse_level_.segment(row, run.count).array();
      row += run.count;
    }
    if (decorrelate_.size() > 0) {
      auto own = out.segment(row - run.count * channels_, run.count * channels_)
                     .reshaped(run.count, channels_);
      own = (own * decorrelate_.transpose()).eval();
    }
  }
  return out;
}

std::vector<Index> rows_of_forces(const Case& study, const Whitener& whitener) {
  std::vector<Index> rows;
  for (Index i = 0; i < whitener.rows(); ++i) {
    const auto& row = whitener.row_info()[static_cast<std::size_t>(i)];
    if (study.channels[row.channel] < 3) rows.push_back(i);
  }
  return rows;
}

}  // namespace dcnn
