// SPDX-License-Identifier: Apache-2.0
// Comparing tensors with the numbers of another program.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "dcnn/core/tensor.h"

namespace dcnn {

using Values = std::vector<Real>;

inline Tensor scaled(const Tensor& x, Real factor) {
  Tensor y({1});
  y.data()[0] = factor * x.data()[0];
  return record(y, {x},
                [x, factor](const Tensor& out) { x.gradient()[0] += factor * out.gradient()[0]; });
}

/// |got - wanted| <= tolerance·max(1, |wanted|).
inline void expect_near(std::span<const Real> got, const Values& wanted, double tolerance,
                        const std::string& what) {
  ASSERT_EQ(got.size(), wanted.size()) << what;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_NEAR(got[i], wanted[i], tolerance * std::max(1.0, std::abs(wanted[i])))
        << what << " " << i;
  }
}

}  // namespace dcnn
