// SPDX-License-Identifier: Apache-2.0
// Stride-1 cross-correlation on channels-last images as sums of tile products.
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// Images (H, W, C), weights (window_h, window_w, in_c, out_c); `before` is the zero padding above
/// and to the left, which is never multiplied: every sum runs over the taps inside the image only.
struct ConvShape {
  Index in_h, in_w, in_c;
  Index out_h, out_w, out_c;
  Index window_h, window_w;
  Index before_h, before_w;

  Index in_size() const { return in_h * in_w * in_c; }
  Index out_size() const { return out_h * out_w * out_c; }
  Index weight_size() const { return window_h * window_w * in_c * out_c; }
};

/// The convolution that takes the output's gradient to the input's, with flipped weights.
ConvShape transposed(const ConvShape& shape);
/// Weights of transposed(shape): taps in reverse order, (window_h, window_w, out_c, in_c).
void flip_weights(const ConvShape& shape, const Real* weights, Real* flipped);

/// out = bias + weights * x for `samples` images; bias may be null; with `add`, out is added to (no
/// bias).
void convolve(const ConvShape& shape, Index samples, const Real* x, const Real* weights,
              const Real* bias, Real* out, bool add);

/// gradient = dLoss/dweights over `samples` images, given dLoss/dout.
void weight_gradient(const ConvShape& shape, Index samples, const Real* x, const Real* out_gradient,
                     Real* gradient);

}  // namespace dcnn
