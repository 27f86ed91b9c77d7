// SPDX-License-Identifier: Apache-2.0
#include "identification/own_offset.h"

#include <algorithm>
#include <limits>

#include "core/elementary.h"

namespace dcnn::identification {

double own_offset_gain(const Eigen::MatrixXd& residual, const Eigen::VectorXd& least) {
  const auto n = static_cast<double>(residual.rows());
  if (residual.rows() < 2) return 0.0;
  double gain = 0.0;
  for (Eigen::Index c = 0; c < residual.cols(); ++c) {
    const Eigen::VectorXd r = residual.col(c);
    const double floor = least[c] * least[c];
    const double with = std::max(floor, (r.array() - r.mean()).matrix().squaredNorm() / (n - 1.0));
    const double without = std::max(floor, r.squaredNorm() / n);
    if (with > 0.0 && without > with) gain += n * elementary::log(without / with);
  }
  return gain;
}

Eigen::VectorXd least_deviations(const std::vector<std::vector<ChannelNoise>>& noise,
                                 std::size_t but) {
  Eigen::VectorXd least = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(noise.front().size()),
                                                    std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < noise.size(); ++k) {
    for (std::size_t c = 0; k != but && c < noise[k].size(); ++c) {
      double& one = least[static_cast<Eigen::Index>(c)];
      one = std::min(one, noise[k][c].deviation());
    }
  }
  return least;
}

}  // namespace dcnn::identification
