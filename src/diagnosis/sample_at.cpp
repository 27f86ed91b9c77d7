// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/sample_at.h"

#include <algorithm>

namespace dcnn {

Eigen::Index sample_at(const Motion& motion, double t) {
  const auto begin = motion.t.begin(), end = motion.t.end();
  const auto after = std::lower_bound(begin, end, t);
  if (after == begin) return 0;
  if (after == end) return motion.samples() - 1;
  const bool nearer = t - *(after - 1) < *after - t;
  return (nearer ? after - 1 : after) - begin;
}

}  // namespace dcnn
