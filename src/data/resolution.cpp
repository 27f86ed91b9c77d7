// SPDX-License-Identifier: Apache-2.0
#include "data/resolution.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dcnn {

double resolution(const Eigen::VectorXd& values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  if (sorted.empty()) return 0.0;
  const double rounding = 1e-12 * std::max(std::abs(sorted.front()), std::abs(sorted.back()));
  double least = 0.0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double step = sorted[i] - sorted[i - 1];
    if (step > rounding && (least == 0.0 || step < least)) least = step;
  }
  return least;
}

}  // namespace dcnn
