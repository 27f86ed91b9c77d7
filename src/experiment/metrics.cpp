// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dcnn {
namespace {

/// The targets that one overall number covers: those in newtons, else all where they share one
/// unit.
std::vector<std::size_t> overall_targets(const Targets& targets) {
  std::vector<std::size_t> all(targets.names.size()), forces;
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::copy_if(all.begin(), all.end(), std::back_inserter(forces),
               [&](std::size_t j) { return targets.units[j] == "N"; });
  if (!forces.empty()) return forces;
  const bool one_unit = std::all_of(targets.units.begin(), targets.units.end(),
                                    [&](const auto& unit) { return unit == targets.units[0]; });
  return one_unit ? all : std::vector<std::size_t>{};
}

std::optional<double> mean_at(const std::vector<double>& values,
                              const std::vector<std::size_t>& at) {
  if (at.empty()) return std::nullopt;
  double sum = 0.0;
  for (const auto j : at) sum += values[j];
  return sum / static_cast<double>(at.size());
}

std::optional<double> length_at(const std::vector<double>& values,
                                const std::vector<std::size_t>& at) {
  if (at.empty()) return std::nullopt;
  double sum = 0.0;
  for (const auto j : at) sum += values[j] * values[j];
  return std::sqrt(sum);
}

}  // namespace

Score score(const Eigen::MatrixXd& predicted, const Eigen::MatrixXd& wanted,
            const Targets& targets) {
  const double n = static_cast<double>(wanted.rows());
  Score result;
  for (Eigen::Index j = 0; j < wanted.cols(); ++j) {
    const Eigen::ArrayXd error = predicted.col(j).array() - wanted.col(j).array();
    const double sse = error.square().sum();
    const double sst = (wanted.col(j).array() - wanted.col(j).mean()).square().sum();
    result.rmse.push_back(std::sqrt(sse / n));
    result.max_abs.push_back(error.abs().maxCoeff());
    result.r2.push_back(sst > 0.0 ? 1.0 - sse / sst : 0.0);
  }
  const auto covered = overall_targets(targets);
  std::vector<std::size_t> torques;
  for (std::size_t j = 0; j < targets.units.size(); ++j) {
    if (targets.units[j] == "N*m" && targets.units[covered.empty() ? j : covered[0]] == "N") {
      torques.push_back(j);
    }
  }
  result.overall = mean_at(result.rmse, covered);
  result.overall_torque = mean_at(result.rmse, torques);
  result.vector_rmse = length_at(result.rmse, covered);
  return result;
}

Spread spread(const std::vector<double>& values) {
  Spread result;
  if (values.empty()) return result;
  const double n = static_cast<double>(values.size());
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double v : values) squares += (v - result.mean) * (v - result.mean);
  if (values.size() > 1) result.deviation = std::sqrt(squares / (n - 1.0));
  return result;
}

}  // namespace dcnn
