// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/moving.h"

#include <algorithm>
#include <cmath>

#include "data/median.h"
#include "data/resolution.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/periodograms.h"

namespace dcnn {
namespace {

/// Median of the positions' density above the motion [unit^2]; nothing where there is no such band.
std::optional<double> quiet_variance(const Case& study, const Signals& position) {
  const Periodograms p = periodograms(study, position, 0);
  const Eigen::VectorXd density = density_of(p);
  std::vector<double> quiet;
  for (Index i = 0; i < p.hz.size() && p.power.cols() > 0; ++i) {
    if (p.hz(i) >= quiet_band(study) && p.hz(i) <= 0.49 / study.dt()) quiet.push_back(density(i));
  }
  if (quiet.empty()) return std::nullopt;
  return median(std::move(quiet));
}

/// Of white noise, by the median of second differences, which have six times its variance; of
/// rounding at least.
double variance_of_differences(const Signals& position) {
  std::vector<double> differences;
  double step = 0.0;
  for (const Eigen::MatrixXd& q : position) {
    const Index n = q.rows();
    for (Index i = 1; i + 1 < n; ++i) {
      differences.push_back(std::abs(q(i - 1, 0) - 2.0 * q(i, 0) + q(i + 1, 0)));
    }
    step = std::max(step, resolution(q.col(0)));
  }
  if (differences.empty()) return 0.0;
  const double deviation = kDeviationOfMedian * median(std::move(differences)) / std::sqrt(6.0);
  return std::max(deviation * deviation, step * step / 12.0);
}

}  // namespace

bool moves(const Case& study) {
  const std::string& name = study.axis->axis().position;
  if (name.empty() || study.is_static()) return true;
  Signals position;
  double square = 0.0, rows = 0.0;
  for (const Log& log : study.logs) {
    const Eigen::VectorXd q = log.recording.column(name);
    square += (q.array() - q.mean()).square().sum();
    rows += static_cast<double>(q.size());
    position.emplace_back(q);
  }
  const auto quiet = quiet_variance(study, position);
  if (!quiet) return square > 0.0;
  const double variance = std::min(*quiet, variance_of_differences(position));
  // White noise of density s^2 has variance s^2 f/f_Nyquist below f.
  const double noise = variance * std::min(1.0, 2.0 * study.motion_hz * study.dt());
  return square / rows > prior::kMoves * prior::kMoves * noise;
}

}  // namespace dcnn
