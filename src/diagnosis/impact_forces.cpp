// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/impact_forces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/elementary.h"
#include "diagnosis/columns.h"

namespace dcnn {
namespace {

/// Quantile of the standard normal distribution at 1 - p, p <= 1/2; error below 5e-4 (Abramowitz
/// and Stegun 26.2.23).
double normal_deviation(double p) {
  const double t = std::sqrt(-2.0 * elementary::log(p));
  return t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                 (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
}

Forces forces_about(const Eigen::VectorXd& r, const Template& shape) {
  const Index far = shape.far(), n = r.size() - 2 * far;
  Forces f{Eigen::VectorXd::Zero(r.size()), Eigen::VectorXd::Zero(r.size()), far};
  if (n <= 0) return f;
  for (Index k = 0; k < 2 * far + 1; ++k) {
    f.values.segment(far, n) += shape.weights()(k) * r.segment(k, n);
  }
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), far);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index i, Index j) { return std::abs(f.values(i)) > std::abs(f.values(j)); });
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double above = (static_cast<double>(rank) + 0.5) / static_cast<double>(n);
    f.scores(order[rank]) = std::copysign(normal_deviation(0.5 * above), f.values(order[rank]));
  }
  return f;
}

}  // namespace

Template::Template(Index wide) : far_(6 * wide + 3) {
  const Index n = 2 * far_ + 1;
  Eigen::MatrixXd parabola(n, 3);
  weights_ = Eigen::VectorXd::Zero(n);
  for (Index i = 0; i < n; ++i) {
    const double t = static_cast<double>(i - far_) / static_cast<double>(far_);
    parabola.row(i) << 1.0, t, t * t;
    if (std::abs(i - far_) <= wide) weights_(i) = 1.0;
  }
  const Eigen::MatrixXd q = orthonormal(parabola);
  weights_ -= q * (q.transpose() * weights_);
  weights_ /= weights_.squaredNorm();
}

const Forces& Channel::about(const Template& shape) const {
  const auto [found, is_new] = forces_.try_emplace(shape.far());
  if (is_new) found->second = forces_about(r_, shape);
  return found->second;
}

}  // namespace dcnn
