// SPDX-License-Identifier: Apache-2.0
// The shapes that a kernel is compiled for.
#pragma once

#include <algorithm>
#include <span>

#include "nn/kernels/convolution.h"

namespace dcnn {

struct FixedShape {
  Index width, channels, filters;
  bool same;

  bool fits(const ConvShape& s) const {
    const Index lost = same ? 0 : 1;
    return s.window_h == 2 && s.window_w == 2 && s.before_h == 0 && s.before_w == 0 &&
           width == s.in_w && channels == s.in_c && filters == s.out_c &&
           s.out_w == s.in_w - lost && s.out_h == s.in_h - lost;
  }
};

/// Which of these it is, -1 for none.
inline int find_fixed(std::span<const FixedShape> shapes, const ConvShape& shape) {
  const auto found =
      std::ranges::find_if(shapes, [&](const FixedShape& s) { return s.fits(shape); });
  return found == shapes.end() ? -1 : static_cast<int>(found - shapes.begin());
}

}  // namespace dcnn
