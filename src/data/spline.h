// SPDX-License-Identifier: Apache-2.0
// Natural cubic spline through samples at any increasing times.
#pragma once

#include <Eigen/Dense>

#include "dcnn/core/parallel.h"

namespace dcnn {

class Spline {
 public:
  /// At least one sample; t strictly increasing, s.
  Spline(const Eigen::VectorXd& t, const Eigen::VectorXd& x);

  /// The value at time `at`, which lies between knots k and k + 1 (or at one of them).
  double value(double at, Index k) const;
  /// First derivative at knot k.
  double slope(Index k) const;
  /// Second derivatives at the knots.
  const Eigen::VectorXd& curvature() const { return curvature_; }

 private:
  Eigen::VectorXd t_, x_, curvature_;
};

}  // namespace dcnn
