// SPDX-License-Identifier: Apache-2.0
#include "data/spline.h"

#include <cassert>

namespace dcnn {

// Thomas' algorithm on h[k-1]·M[k-1] + 2(h[k-1]+h[k])·M[k] + h[k]·M[k+1] = 6(d[k] - d[k-1]), M = 0
// at both ends (natural), d the slopes of the chords.
Spline::Spline(const Eigen::VectorXd& t, const Eigen::VectorXd& x)
    : t_(t), x_(x), curvature_(Eigen::VectorXd::Zero(t.size())) {
  assert(t.size() == x.size() && t.size() > 0);
  const Index n = t.size();
  Eigen::VectorXd upper = Eigen::VectorXd::Zero(n);
  for (Index k = 1; k + 1 < n; ++k) {
    const double before = t[k] - t[k - 1], after = t[k + 1] - t[k];
    const double bend = 6.0 * ((x[k + 1] - x[k]) / after - (x[k] - x[k - 1]) / before);
    const double pivot = 2.0 * (before + after) - before * upper[k - 1];
    upper[k] = after / pivot;
    curvature_[k] = (bend - before * curvature_[k - 1]) / pivot;
  }
  for (Index k = n - 2; k > 0; --k) curvature_[k] -= upper[k] * curvature_[k + 1];
}

double Spline::value(double at, Index k) const {
  if (k + 1 >= t_.size()) return x_[k];
  const double h = t_[k + 1] - t_[k];
  const double right = (at - t_[k]) / h, left = 1.0 - right;
  return left * x_[k] + right * x_[k + 1] +
         h * h / 6.0 *
             ((left * left * left - left) * curvature_[k] +
              (right * right * right - right) * curvature_[k + 1]);
}

double Spline::slope(Index k) const {
  const Index n = t_.size();
  if (n < 2) return 0.0;
  const Index left = k + 1 < n ? k : n - 2;
  const double h = t_[left + 1] - t_[left];
  const double chord = (x_[left + 1] - x_[left]) / h;
  return k == left ? chord - h / 6.0 * (2.0 * curvature_[left] + curvature_[left + 1])
                   : chord + h / 6.0 * (curvature_[left] + 2.0 * curvature_[left + 1]);
}

}  // namespace dcnn
