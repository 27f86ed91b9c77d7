// A convolution of one image with everything that does not depend on its values decided before.
#pragma once

#include <vector>

#include "nn/kernels/convolution.h"
#include "nn/kernels/tile.h"

namespace dcnn {

/// y = bias + weights * x, or its positive part. One product for each stretch of output positions
/// of a row that see the same taps.
class ConvolutionPlan {
 public:
  ConvolutionPlan(const ConvShape& shape, const Tensor& weights, const Tensor& bias);
  void run(const Real* x, bool relu, Real* y) const noexcept;

 private:
  struct Stretch {
    std::vector<Run> runs;
    Index length, out;  // positions, and where the first one's channels lie
  };

  ConvShape shape_;
  Tensor weights_, bias_;
  std::vector<Stretch> stretches_;
};

}  // namespace dcnn
