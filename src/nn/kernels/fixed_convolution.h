// The convolutions of DCNN for one image, every extent but the height known to the compiler.
#pragma once

#include "nn/kernels/convolution.h"

namespace dcnn {

/// y = max(0, bias + weights * x) with a 2x2 window; weights as ConvShape has them.
struct FixedConvolution {
  const Real *x, *weights, *bias;
  Real* y;
  Index in_h;
};

/// Which of the shapes compiled in this one is, -1 for none.
int fixed_convolution_kind(const ConvShape& shape);
void fixed_convolution(int kind, const FixedConvolution& convolution);

}  // namespace dcnn
