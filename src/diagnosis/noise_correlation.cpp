// SPDX-License-Identifier: Apache-2.0
// The correlation of the noise of channels, as strain gauges that share a bridge have it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "diagnosis/noise_floor.h"

namespace dcnn {
namespace {

/// Second differences of one channel of a residual over the noise's level, which hold little else
/// than noise.
Eigen::VectorXd second_differences(const Case& study, const Signals& residual,
                                   const Signals& levels, Index channel) {
  std::vector<double> list;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const auto r = residual[k].col(channel), level = levels[k].col(channel);
    for (const Segment& s : study.logs[k].motion.segments) {
      for (Index i = s.begin + 2; i < s.end; ++i) {
        list.push_back((r(i) - 2.0 * r(i - 1) + r(i - 2)) / level(i));
      }
    }
  }
  return Eigen::Map<Eigen::VectorXd>(list.data(), static_cast<Index>(list.size()));
}

/// Of two Gaussians, from how often their signs agree (Sheppard): bursts and outliers count like
/// any row.
double correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const double agree = (x.array() * y.array()).sign().mean();
  return elementary::sin(0.5 * std::numbers::pi * agree);
}

}  // namespace

Eigen::MatrixXd noise_correlation(const Case& study, const Signals& residual,
                                  const Signals& levels) {
  // Deviations from 0 that chance exceeds in one of 16,000 pairs; of n second differences of white
  // noise, whose squared correlations sum to 1.94, n/1.94 are independent.
  constexpr double kBeyondChance = 4.0, kDependent = 1.94;
  // Numerical tolerances, so that no row is divided by next to nothing: of a correlation, and of
  // what the channels before it leave of a channel's deviation.
  constexpr double kMost = 0.98, kLeastOwn = 0.1;
  const Index channels = study.channel_count();
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(channels, channels);
  if (study.is_static()) return all;
  std::vector<Eigen::VectorXd> noise;
  for (Index j = 0; j < channels; ++j) {
    noise.push_back(second_differences(study, residual, levels, j));
  }
  const double rows = static_cast<double>(noise.front().size());
  if (rows == 0.0) return all;
  const double chance = kBeyondChance * 0.5 * std::numbers::pi * std::sqrt(kDependent / rows);
  for (Index i = 0; i < channels; ++i) {
    for (Index j = 0; j < i; ++j) {
      const double r =
          correlation(noise[static_cast<std::size_t>(i)], noise[static_cast<std::size_t>(j)]);
      if (std::abs(r) > chance) all(i, j) = all(j, i) = std::clamp(r, -kMost, kMost);
    }
  }
  // Estimates pair by pair need not be those of any noise: shrunk until they are.
  Eigen::MatrixXd shrunk = all;
  for (double keep = 1.0; keep > 0.0; keep -= 0.1) {
    shrunk = keep * all + (1.0 - keep) * Eigen::MatrixXd::Identity(channels, channels);
    const Eigen::LLT<Eigen::MatrixXd> factor(shrunk);
    if (factor.info() == Eigen::Success && factor.matrixLLT().diagonal().minCoeff() > kLeastOwn) {
      return shrunk;
    }
  }
  return Eigen::MatrixXd::Identity(channels, channels);
}

}  // namespace dcnn
