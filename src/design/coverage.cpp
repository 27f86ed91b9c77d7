// SPDX-License-Identifier: Apache-2.0
#include "design/coverage.h"

#include <algorithm>

#include "core/elementary.h"
#include "core/linear_algebra.h"

namespace dcnn::design {

Eigen::MatrixXd states_of(const Motion& motion) {
  Eigen::MatrixXd states(motion.samples(), 18);
  for (Index k = 0; k < motion.samples(); ++k) {
    const Eigen::Matrix3d to_S = motion.R_BS[static_cast<std::size_t>(k)].transpose();
    states.row(k) << (to_S * motion.v_B.row(k).transpose()).transpose(), motion.w_S.row(k),
        (to_S * motion.a_B.row(k).transpose()).transpose(), motion.dw_S.row(k),
        -to_S.col(2).transpose(), motion.p_B.row(k);
  }
  return states;
}

double coverage(const Motion& motion, const Eigen::VectorXd& largest, double samples) {
  Eigen::MatrixXd states = states_of(motion);
  const auto rows = static_cast<double>(states.rows());
  states.rowwise() -= (states.colwise().sum() / rows).eval();
  for (Index j = 0; j < states.cols(); ++j) states.col(j) /= largest(j);
  const Spectrum spectrum = spectrum_of(states.transpose() * states / rows);
  double sum = 0.0;
  for (const double value : spectrum.values)
    sum += elementary::log1p(samples * std::max(0.0, value));
  return 0.5 * sum / static_cast<double>(spectrum.values.size());
}

}  // namespace dcnn::design
