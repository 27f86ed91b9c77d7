// Sums and maps over rows of C channels, as batch normalisation needs them. All arrays of length C
// but x, y and gradients, which are (rows, C).
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// sums[c] = sum over rows of x.
void channel_sums(const Real* x, Index rows, Index channels, Real* sums);
/// sums[c] = sum over rows of (x - mean)·factor; factor = null stands for x - mean itself.
void channel_products(const Real* x, const Real* mean, const Real* factor, Index rows,
                      Index channels, Real* sums);
/// y = (x - mean)·scale + shift.
void channel_affine(const Real* x, const Real* mean, const Real* scale, const Real* shift,
                    Index rows, Index channels, Real* y);
/// slot = (or +=) dy·scale + (x - mean)·slope + shift.
void channel_gradient(const Real* dy, const Real* scale, const Real* x, const Real* mean,
                      const Real* slope, const Real* shift, Index rows, Index channels,
                      Tensor::GradientSlot slot);

}  // namespace dcnn
