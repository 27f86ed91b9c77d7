// SPDX-License-Identifier: Apache-2.0
// Sums and maps over rows of C channels, as batch normalisation needs them. All arrays of length C
// but x, y and gradients, which are (rows, C).
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// sums[c] = sum over rows of x.
void channel_sums(const Real* x, Index rows, Index channels, Real* sums);
/// sums[c] = sum over rows of (x - mean)².
void channel_deviations(const Real* x, const Real* mean, Index rows, Index channels, Real* sums);
/// y = (x - mean)·scale + shift, or the positive part of it.
void channel_affine(const Real* x, const Real* mean, const Real* scale, const Real* shift,
                    Index rows, Index channels, bool relu, Real* y);

/// dLoss/dy; where `y` is given, of the ReLU that made it: zero where y is not positive.
struct OutputGradient {
  const Real *dy, *y;  // y: null without a ReLU
  OutputGradient from(Index i) const { return {dy + i, y ? y + i : nullptr}; }
};
/// sums[c] = sum over rows of dy, and sums[channels + c] that of (x - mean)·dy.
void channel_gradient_sums(const OutputGradient& gradient, const Real* x, const Real* mean,
                           Index rows, Index channels, Real* sums);
/// slot = (or +=) dy·scale + (x - mean)·slope + shift.
void channel_gradient(const OutputGradient& gradient, const Real* scale, const Real* x,
                      const Real* mean, const Real* slope, const Real* shift, Index rows,
                      Index channels, Tensor::GradientSlot slot);

}  // namespace dcnn
