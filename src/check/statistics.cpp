// SPDX-License-Identifier: Apache-2.0
#include "check/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "data/median.h"

namespace dcnn::check {

double median(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0.0 : dcnn::median({values.begin(), values.end()});
}

double rms_of(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(std::max<Index>(1, values.size())));
}

bool varies(const Eigen::VectorXd& values) {
  return values.size() > 0 && values.maxCoeff() > values.minCoeff();
}

double robust_deviation(const Eigen::VectorXd& values) {
  return kDeviationOfMedian * median((values.array() - median(values)).abs());
}

Eigen::VectorXd steps_of(const Eigen::VectorXd& values) {
  const Eigen::Index n = values.size();
  return n < 2 ? Eigen::VectorXd() : Eigen::VectorXd(values.tail(n - 1) - values.head(n - 1));
}

double noise_of(const Eigen::VectorXd& values) {
  return robust_deviation(steps_of(steps_of(values))) / std::sqrt(6.0);
}

double repeats(const Eigen::VectorXd& values) {
  const Eigen::VectorXd steps = steps_of(values);
  if (steps.size() == 0) return 0.0;
  return static_cast<double>((steps.array() == 0.0).count()) / static_cast<double>(steps.size());
}

std::vector<Run> runs_of(const Eigen::VectorXd& values) {
  std::vector<Run> runs;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (runs.empty() || runs.back().value != values[i]) runs.push_back({i, 0, values[i]});
    ++runs.back().length;
  }
  return runs;
}

double chi_square_median(Eigen::Index freedom) { return freedom == 1 ? 0.4549 : 2.366; }

double plausibility(double value, const Typical& typical) {
  if (!(value > 0.0)) return -kMostSurprise;
  const double spread = value < typical.median ? typical.below : typical.above;
  const double z = elementary::log(value / typical.median) / spread;
  return std::max(-0.5 * z * z, -kMostSurprise);
}

double probability_of_log_odds(double x) { return 1.0 / (1.0 + elementary::exp(-x)); }

double log_odds_of(double p) { return elementary::log(p / (1.0 - p)); }

double log_sum(const Eigen::VectorXd& terms) {
  const double most = terms.maxCoeff();
  return most + elementary::log(elementary::exp(terms.array() - most).sum());
}

Eigen::VectorXd shares_of(const Eigen::VectorXd& log_weights) {
  const Eigen::VectorXd weights =
      elementary::exp(log_weights.array() - double(log_weights.maxCoeff()));
  return weights / weights.sum();
}

double posterior_of_p(double p) {
  if (p >= 1.0 / std::numbers::e) return kFaultPrior;
  const double log_p = elementary::log(std::max(p, 1e-300));
  const double log_factor = -1.0 - log_p - elementary::log(-log_p);
  return probability_of_log_odds(log_odds_of(kFaultPrior) + log_factor);
}

}  // namespace dcnn::check
