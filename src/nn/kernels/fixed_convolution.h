// SPDX-License-Identifier: Apache-2.0
// The convolutions of DCNN for one image, every extent but the height known to the compiler.
#pragma once

#include <cstdint>

#include "nn/kernels/convolution.h"

namespace dcnn {

/// A fully connected layer of a convolution's outputs: weights (outputs, inputs).
struct FixedLinear {
  static constexpr Index kTogether = 3;  // outputs: their number is a multiple
  static constexpr Index kSums = 32;     // of one output
  const Real *weights = nullptr, *bias = nullptr;
  Real* sums = nullptr;  // (outputs, kSums) of working memory
  Index outputs = 0, inputs = 0;
};

/// y = max(0, bias + weights * x) with a 2x2 window, weights as ConvShape has them; or, where there
/// are outputs of `linear`, those in its place. T is Real, or std::int32_t for two channels side by
/// side in 16 bits each: weights then are (2, 2, channels/2, filters) of such pairs, and the sum of
/// products of a filter stands for x_unit·units[filter] times itself.
template <class T>
struct FixedConvolution {
  const T *x, *weights;
  const Real* bias;
  Real* y;
  Index in_h;
  FixedLinear linear;
  const Real* units = nullptr;
  Real x_unit = 1;
};

/// Which of the shapes compiled in this one is, -1 for none.
int fixed_convolution_kind(const ConvShape& shape);
void fixed_convolution(int kind, const FixedConvolution<Real>& convolution);

}  // namespace dcnn
