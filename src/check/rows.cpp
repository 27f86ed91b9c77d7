// SPDX-License-Identifier: Apache-2.0
#include "check/rows.h"

#include <algorithm>
#include <cmath>

#include "check/priors.h"

namespace dcnn::check {

using Eigen::Index;

std::vector<Run> group_runs(const Eigen::MatrixXd& columns) {
  std::vector<Run> runs;
  for (Index i = 0; i < columns.rows(); ++i) {
    if (i == 0 || (columns.row(i).array() != columns.row(i - 1).array()).any()) {
      runs.push_back({i, 0, static_cast<double>(i)});
    }
    ++runs.back().length;
  }
  return runs;
}

std::vector<std::string> measured_columns(const Log& log) {
  std::vector<std::string> names;
  for (const auto& sensor : log.sensors()) names.insert(names.end(), sensor.begin(), sensor.end());
  return names;
}

RelativeSpeed::RelativeSpeed(const Log& log) : RelativeSpeed(log, log.positions()) {}

RelativeSpeed::RelativeSpeed(const Log& log, const std::vector<std::string>& positions) {
  for (const std::string& name : positions) {
    const Eigen::VectorXd squares = steps_of(log.column(name)).cwiseAbs2();
    const double usual = squares.mean();
    if (usual <= 0.0) continue;
    std::vector<double> sums{0.0};
    for (const double square : squares) sums.push_back(sums.back() + square / usual);
    sums_.push_back(std::move(sums));
  }
}

double RelativeSpeed::in(Index begin, Index end) const {
  double most = 0.0;
  for (const auto& sums : sums_) {
    const auto first = static_cast<std::size_t>(begin), last = static_cast<std::size_t>(end - 1);
    most = std::max(most, sums[last] - sums[first]);
  }
  return std::sqrt(most / static_cast<double>(std::max<Index>(end - begin - 1, 1)));
}

namespace {

/// By how much variances grow where neighbours of residuals are correlated as in a first-order
/// autoregression (Bartlett 1935).
double growth_of_variance(const Eigen::MatrixXd& residual) {
  const Index n = residual.rows();
  const double power = std::max(residual.squaredNorm(), 1e-300);
  const double rho = residual.topRows(n - 1).cwiseProduct(residual.bottomRows(n - 1)).sum() / power;
  const double r = std::clamp(rho, 0.0, 0.99);
  return (1.0 + r) / (1.0 - r);
}

}  // namespace

double independent_of(const Eigen::MatrixXd& residual) {
  return std::min(kMostIndependentRows,
                  static_cast<double>(residual.size()) / growth_of_variance(residual));
}

Eigen::VectorXd fit_deviations(const Adopted& adopted) {
  const double alike = growth_of_variance(adopted.fit.residual);
  return (alike * adopted.fit.covariance.diagonal().array().max(0.0)).sqrt();
}

void set_interval(const Log& log, Index begin, Index end, Fault& fault) {
  if (log.t.size() == 0) return;
  const double origin = log.table.values.rows() > 0 ? double(log.column("t")[0]) : 0.0;
  fault.interval_s = {origin + log.t[begin], origin + log.t[std::min(end, log.t.size()) - 1]};
}

}  // namespace dcnn::check
