// SPDX-License-Identifier: Apache-2.0
#include "identification/plain_fit.h"

#include <cmath>

namespace dcnn::identification {

using Eigen::VectorXd;

namespace {

constexpr double kOneInThousand = 3.0902;  // of the normal distribution, one side

/// The point that chi-square with `freedom` exceeds once in a thousand (Wilson and Hilferty 1931).
double rare_chi_square(double freedom) {
  const double a = 2.0 / (9.0 * freedom), root = 1.0 - a + kOneInThousand * std::sqrt(a);
  return freedom * root * root * root;
}

}  // namespace

bool leaves_more(const WristFit& coloured, const WristFit& plain) {
  double excess = 0.0;
  for (Index c = 0; c < plain.residual_rms.size(); ++c) {
    if (!(plain.residual_rms[c] > 0.0)) continue;
    const double ratio = coloured.residual_rms[c] / plain.residual_rms[c];
    excess += plain.independent[c] * (ratio * ratio - 1.0);
  }
  return excess > rare_chi_square(static_cast<double>(plain.layout.size()));
}

bool leaves_more_in_all(const VectorXd& left, const VectorXd& before) {
  return (left.array() / before.array().max(1e-300)).square().mean() > 1.0;
}

Advances::Advances(const std::vector<WristLog>& logs) {
  for (const WristLog& log : logs) {
    measured_.push_back(log.measured);
    delay_s_.push_back(log.delay_s);
  }
}

void Advances::restore(std::vector<WristLog>& logs) const {
  for (std::size_t k = 0; k < logs.size(); ++k) {
    logs[k].measured = measured_[k];
    logs[k].delay_s = delay_s_[k];
  }
}

}  // namespace dcnn::identification
