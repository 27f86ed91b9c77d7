// A convolution of one image with everything that does not depend on its values decided before.
#pragma once

#include <vector>

#include "nn/kernels/convolution.h"
#include "nn/kernels/tile.h"

namespace dcnn {

/// y = bias + weights * x, or its positive part: by a kernel for this very shape where there is
/// one, else one product for each stretch of output positions of a row that see the same taps. Both
/// add in the same order.
class ConvolutionPlan {
 public:
  ConvolutionPlan(const ConvShape& shape, const Tensor& weights, const Tensor& bias);
  void run(const Real* x, bool relu, Real* y) const noexcept;

 private:
  struct Stretch {
    std::vector<Run> runs;
    Index length, out;  // positions, and where the first one's channels lie
  };

  void run_stretches(const Real* x, bool relu, Real* y) const noexcept;

  ConvShape shape_;
  int fixed_;  // which fixed_convolution() this is, -1 for none
  Tensor weights_, bias_;
  std::vector<Stretch> stretches_;
};

}  // namespace dcnn
