// SPDX-License-Identifier: Apache-2.0
#include "identification/wrist_fit.h"

#include <algorithm>
#include <cmath>

#include "identification/normal_equations.h"
#include "identification/own_offset.h"
#include "identification/plain_fit.h"
#include "identification/wrist_prior.h"
#include "identification/wrist_start.h"

namespace dcnn::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kIterations = 60, kNoiseRounds = 6, kMostLaws = 8, kDelayRounds = 3;
constexpr double kConverged = 1e-8;  // of a standard deviation
constexpr double kAlias = 1e-6;      // share of a column that other columns must leave

class Fitter {
 public:
  Fitter(std::vector<WristLog>& logs, const FitOptions& options)
      : logs_(logs), plain_(options.plain) {
    fit_.layout.torque = logs.front().measured.cols() == 6;
    fit_.layout.mounting = !options.R_ES;
    make_columns();
    const Eigen::Matrix3d R_SE =
        options.R_ES ? Eigen::Matrix3d(options.R_ES->transpose()) : Eigen::Matrix3d::Identity();
    fit_.state = starting_state(fit_.columns, logs, R_SE, options.R_ES.has_value());
    fit_.state.amplitudes = VectorXd(0);
    start_bias_torque();
  }

  void refine() {
    fit_.noise.clear();
    for (int round = 0; round < kNoiseRounds; ++round) {
      make_law_columns();
      estimate_noise();
      descend();
    }
    finish();
  }

  void choose_laws() {
    auto candidates = candidate_laws(logs_, fit_.layout.torque);
    const double trials = 2.0 * std::log(static_cast<double>(candidates.size()));
    while (static_cast<int>(fit_.state.laws.size()) < kMostLaws) {
      const White now = white();
      std::size_t best = candidates.size();
      double most = 0.0;
      for (std::size_t k = 0; k < candidates.size(); ++k) {
        const double gain = gain_of(candidates[k], now) - trials;
        if (gain > most) most = gain, best = k;
      }
      if (best == candidates.size()) return;
      const VectorXd before = fit_.residual_rms;
      add(sharpened(candidates[best], now));
      candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(best));
      refine();
      if (fit_.state.laws.back().effect == "time_delay") take_off_delay();
      if (!still_lawful() || leaves_more_in_all(fit_.residual_rms, before)) drop_last();
    }
  }

  const WristFit& fit() const { return fit_; }
  WristFit result() { return std::move(fit_); }

 private:
  void make_columns() {
    fit_.columns.clear();
    for (const WristLog& log : logs_) fit_.columns.push_back(columns_of(log, fit_.layout.torque));
  }

  void start_bias_torque() {
    if (!fit_.layout.torque) return;
    for (const WristColumns& c : fit_.columns) {
      fit_.state.bias_torque +=
          c.y.rightCols(3).colwise().mean().transpose() / static_cast<double>(fit_.columns.size());
    }
  }

  void make_law_columns() {
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      WristColumns& c = fit_.columns[k];
      MatrixXd all(c.rows(), 0);
      for (const Law& law : fit_.state.laws) {
        const MatrixXd more = law_columns(law, logs_, k, c, fit_.state);
        const Index before = all.cols();
        all.conservativeResize(c.rows(), before + more.cols());
        all.rightCols(more.cols()) = more;
      }
      c.laws = all;
    }
  }

  MatrixXd residual(std::size_t k) const {
    return fit_.columns[k].y - predicted(fit_.columns[k], fit_.state);
  }

  void estimate_noise() {
    double rows = 0.0;
    for (const WristColumns& c : fit_.columns) rows += static_cast<double>(c.rows());
    const double each =
        static_cast<double>(fit_.layout.size()) / static_cast<double>(fit_.layout.channels());
    const bool first = fit_.noise.empty();
    fit_.noise.assign(logs_.size(), {});
    fit_.independent = VectorXd::Zero(fit_.layout.channels());
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      const MatrixXd r = residual(k);
      const double share = each * static_cast<double>(r.rows()) / rows;
      for (Index c = 0; c < r.cols(); ++c) {
        const ChannelNoise coloured(r.col(c), logs_[k].segments, share);
        const double correlated = plain_ ? coloured.correlated_rows() : 1.0;
        fit_.independent[c] += static_cast<double>(r.rows()) / correlated;
        // The first residual is not one of noise: its size alone is used.
        fit_.noise[k].push_back(
            first || plain_ ? ChannelNoise::white(std::sqrt(correlated) * r.col(c)) : coloured);
      }
    }
  }

  /// (channels·n, k) of a log, white.
  MatrixXd whitened(MatrixXd rows, std::size_t k) const {
    const Index n = fit_.columns[k].rows();
    for (Index c = 0; c < fit_.layout.channels(); ++c) {
      fit_.noise[k][static_cast<std::size_t>(c)].whiten(rows.middleRows(c * n, n),
                                                        logs_[k].segments);
    }
    return rows;
  }

  VectorXd white_residual(std::size_t k) const {
    const MatrixXd r = residual(k);
    return whitened(Eigen::Map<const VectorXd>(r.data(), r.size()), k);
  }

  Normal normal() const {
    const Index p = fit_.layout.size();
    Normal sums{MatrixXd::Zero(p, p), VectorXd::Zero(p)};
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      const MatrixXd J = whitened(jacobian(fit_.columns[k], fit_.state, fit_.layout), k);
      const VectorXd r = white_residual(k);
      sums.information += J.transpose() * J;
      sums.gradient += J.transpose() * r;
      sums.rows += static_cast<double>(r.size());
      sums.chi2 += r.squaredNorm();
    }
    const VectorXd known = prior_deviation(fit_.layout, fit_.state).cwiseAbs2().cwiseInverse();
    sums.information.diagonal() += known;
    sums.gradient -= known.cwiseProduct(parameters_of(fit_.state, fit_.layout));
    return sums;
  }

  White white() const {
    White all;
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      all.J.push_back(whitened(jacobian(fit_.columns[k], fit_.state, fit_.layout), k));
      all.r.push_back(white_residual(k));
      all.rows += static_cast<double>(all.r.back().size());
      all.chi2 += all.r.back().squaredNorm();
    }
    all.inverse = scaled_inverse(normal().information);
    return all;
  }

  void descend() {
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const Normal sums = normal();
      const VectorXd step = scaled_inverse(sums.information) * sums.gradient;
      fit_.state = moved(fit_.state, fit_.layout, step);
      fit_.state.mass = std::max(fit_.state.mass, 1e-6);
      if (step.dot(sums.gradient) < kConverged) return;
    }
  }

  void finish() {
    const Normal sums = normal();
    fit_.information = sums.information;
    fit_.covariance = scaled_inverse(sums.information);
    fit_.freedom = std::max(1.0, sums.rows - static_cast<double>(fit_.layout.size()));
    fit_.residual_rms = VectorXd::Zero(fit_.layout.channels());
    double rows = 0.0;
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      fit_.residual_rms += residual(k).colwise().squaredNorm().transpose();
      rows += static_cast<double>(fit_.columns[k].rows());
    }
    fit_.residual_rms = (fit_.residual_rms / rows).cwiseSqrt();
  }

  /// Twice the logarithm of the likelihood that a law gains, less Schwarz's penalty.
  double gain_of(const Law& law, const White& now) const {
    const auto q = static_cast<Index>(law.names.size());
    MatrixXd own = MatrixXd::Zero(q, q), shared = MatrixXd::Zero(fit_.layout.size(), q);
    VectorXd match = VectorXd::Zero(q);
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      const MatrixXd raw = law_columns(law, logs_, k, fit_.columns[k], fit_.state);
      const Index n = raw.rows();
      MatrixXd stacked(n * fit_.layout.channels(), q);
      for (Index a = 0; a < q; ++a) {
        for (Index c = 0; c < fit_.layout.channels(); ++c) {
          stacked.col(a).segment(c * n, n) = raw.col(fit_.layout.channels() * a + c);
        }
      }
      const MatrixXd C = whitened(stacked, k);
      own += C.transpose() * C;
      shared += now.J[k].transpose() * C;
      match += C.transpose() * now.r[k];
    }
    const MatrixXd left = own - shared.transpose() * now.inverse * shared;
    if ((left.diagonal().array() <= kAlias * own.diagonal().array()).any()) return 0.0;
    const VectorXd amplitudes = scaled_inverse(left) * match;
    if (law.dissipates && (amplitudes.array() <= 0.0).any()) return 0.0;
    double gain = amplitudes.dot(match) * now.rows / std::max(now.chi2, now.rows);
    if (law.effect == "bias") gain = std::max(gain, gain_of_offset(law));
    return gain - static_cast<double>(q) * std::log(now.rows);
  }

  /// Of an offset that one list of poses has alone.
  double gain_of_offset(const Law& law) const {
    double gain = 0.0;
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      if (!logs_[k].at_rest || logs_[k].recording.name != law.axis) continue;
      gain += own_offset_gain(residual(k), least_deviations(fit_.noise, k));
    }
    return gain;
  }

  /// Dry friction with the width that gains most.
  Law sharpened(Law law, const White& now) const {
    if (std::count(law.names.begin(), law.names.end(), "fc_n") == 0) return law;
    Law trial = law;
    double most = -INFINITY;
    for (const double turning : kTurnings) {
      trial.turning = turning;
      const double gain = gain_of(trial, now);
      if (gain > most) most = gain, law.turning = turning;
    }
    return law;
  }

  void add(const Law& law) {
    const auto q = static_cast<Index>(law.names.size());
    fit_.state.laws.push_back(law);
    fit_.state.amplitudes.conservativeResize(fit_.layout.amplitudes + q);
    fit_.state.amplitudes.tail(q).setZero();
    fit_.layout.amplitudes += q;
  }

  bool still_lawful() const {
    const Law& law = fit_.state.laws.back();
    const auto q = static_cast<Index>(law.names.size());
    return !law.dissipates || (fit_.state.amplitudes.tail(q).array() > 0.0).all();
  }

  void drop_last() {
    const auto q = static_cast<Index>(fit_.state.laws.back().names.size());
    fit_.state.laws.pop_back();
    fit_.layout.amplitudes -= q;
    fit_.state.amplitudes.conservativeResize(fit_.layout.amplitudes);
    refine();
  }

  /// The logs are advanced by what is found until nothing is left of it.
  void take_off_delay() {
    for (int round = 0; round < kDelayRounds; ++round) {
      double& seconds = fit_.state.amplitudes[fit_.layout.amplitudes - 1];
      for (WristLog& log : logs_) advance(log, seconds);
      seconds = 0.0;
      make_columns();
      refine();
    }
  }

  std::vector<WristLog>& logs_;
  bool plain_;
  WristFit fit_;
};

}  // namespace

WristFit fit_wrist(std::vector<WristLog>& logs, const FitOptions& options) {
  FitOptions with = options;
  with.plain = true;
  Fitter plain(logs, with);
  plain.refine();
  const Advances before(logs);
  Fitter coloured(logs, options);
  coloured.refine();
  if (options.laws) coloured.choose_laws();
  if (!leaves_more(coloured.fit(), plain.fit())) return coloured.result();
  before.restore(logs);
  if (options.laws) plain.choose_laws();
  return plain.result();
}

}  // namespace dcnn::identification
