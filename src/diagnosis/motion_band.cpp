// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/motion_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "data/median.h"
#include "dcnn/data/fourier.h"

namespace dcnn {

double motion_band(const std::vector<Eigen::VectorXd>& positions, double dt) {
  constexpr double kWindowSeconds = 1.0, kShare = 0.9, kMargin = 3.0;
  constexpr double kRounding = 1e-15;  // of the largest position
  constexpr double kDeviations = 3.1;  // of a mean over windows: 99.9 % of a normal variable
  const Index n = fast_length(std::llround(kWindowSeconds / dt)), bins = n / 2 + 1;
  if (n < 8) return 0.0;
  const Fourier transform(n);
  Eigen::VectorXd hann(n), power = Eigen::VectorXd::Zero(bins);
  for (Index i = 0; i < n; ++i) {
    hann(i) = 0.5 - 0.5 * elementary::cos(2.0 * std::numbers::pi * double(i) / double(n));
  }
  int windows = 0;
  double largest = 0.0;
  for (const Eigen::VectorXd& q : positions) {
    if (q.size() > 0) largest = std::max(largest, q.cwiseAbs().maxCoeff());
    for (Index first = 0; first + n <= q.size(); first += n / 2, ++windows) {
      const Eigen::VectorXd x = q.segment(first, n);
      power += transform((x.array() - x.mean()).matrix().cwiseProduct(hann)).cwiseAbs2();
    }
  }
  if (windows == 0) return 0.0;
  const double noise = median({power.data() + bins / 2, power.data() + bins});
  const double rounding =
      double(windows) * double(n * n) * (kRounding * largest) * (kRounding * largest);
  const double chance = rounding + noise * (1.0 + kDeviations / std::sqrt(double(windows)));
  Eigen::VectorXd velocity = Eigen::VectorXd::Zero(bins);
  for (Index k = 1; k < bins; ++k) {
    if (power(k) > chance) velocity(k) = double(k * k) * (power(k) - noise);
  }
  const double whole = velocity.sum();
  if (!(whole > 0.0)) return 0.0;
  double below = 0.0;
  Index edge = 0;
  while (edge + 1 < bins && below < kShare * whole) below += velocity(++edge);
  return kMargin * double(edge) / (double(n) * dt);
}

}  // namespace dcnn
