// SPDX-License-Identifier: Apache-2.0
// Vector loops over contiguous values.
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// y = max(x, 0).
void relu_forward(const Real* x, Index n, Real* y);
/// slot = (or +=) dy where y > 0, else 0.
void relu_gradient(const Real* y, const Real* dy, Index n, Tensor::GradientSlot slot);
/// out = (or +=) a·b.
void multiply(const Real* a, const Real* b, Index n, Tensor::GradientSlot out);
/// out = (or +=) the sum of `count` arrays of n values one behind the other, in their order.
void sum_arrays(const Real* arrays, Index count, Index n, Tensor::GradientSlot out);

/// What multiplies two values in a dropout: `kept`, or 0 where the lower or the upper half of
/// mix_bits(key + k) is below `drop_below`. mask[2k], mask[2k + 1] for k in [0, pairs).
struct DropoutMask {
  std::uint64_t key;
  std::uint32_t drop_below;
  Real kept;
};
void dropout_mask(const DropoutMask& draw, Index pairs, Real* mask);

/// Coefficients of one Adam step (Kingma and Ba 2015) with both bias corrections worked in.
struct AdamStep {
  Real beta1, beta2;
  Real rate;        // rate / (1 - beta1^t)
  Real root_scale;  // 1 / sqrt(1 - beta2^t)
  Real epsilon, l2;
  Real gradient_scale;  // 1, or less where the gradient is clipped
};
void adam(const AdamStep& step, Index n, const Real* gradient, Real* first, Real* second,
          Real* value);

/// y[o] = bias[o] + sum over i of weights[o, i]·x[i].
void affine(const Real* x, const Real* weights, const Real* bias, Index inputs, Index outputs,
            Real* y);

/// The same for one sample alone: four sums for each output hide the latency that affine() has with
/// few outputs; it adds in another order.
void affine_of_one(const Real* x, const Real* weights, const Real* bias, Index inputs,
                   Index outputs, Real* y);

}  // namespace dcnn
