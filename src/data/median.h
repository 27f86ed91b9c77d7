// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

namespace dcnn {

/// Standard deviation over median absolute deviation, of a normal distribution: 1 / 0.67449.
inline constexpr double kDeviationOfMedian = 1.4826;

/// The upper one of two in the middle; of at least one value.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace dcnn
