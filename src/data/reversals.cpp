// SPDX-License-Identifier: Apache-2.0
#include "data/reversals.h"

#include <algorithm>

namespace dcnn {

int reversals(const Eigen::VectorXd& x, double part) {
  const double least = part * (x.maxCoeff() - x.minCoeff());
  double low = x(0), high = x(0);
  int direction = 0, count = 0;
  for (const double now : x) {
    low = std::min(low, now);
    high = std::max(high, now);
    const int turned = now > low + least && direction <= 0    ? 1
                       : now < high - least && direction >= 0 ? -1
                                                              : 0;
    if (turned == 0) continue;
    if (direction != 0) ++count;
    direction = turned;
    low = high = now;
  }
  return count;
}

}  // namespace dcnn
