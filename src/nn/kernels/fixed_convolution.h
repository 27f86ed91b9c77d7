// The convolutions of DCNN for one image, every extent but the height known to the compiler.
#pragma once

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
/// are outputs of `linear`, those in its place.
struct FixedConvolution {
  const Real *x, *weights, *bias;
  Real* y;
  Index in_h;
  FixedLinear linear;
};

/// Which of the shapes compiled in this one is, -1 for none.
int fixed_convolution_kind(const ConvShape& shape);
void fixed_convolution(int kind, const FixedConvolution& convolution);

}  // namespace dcnn
