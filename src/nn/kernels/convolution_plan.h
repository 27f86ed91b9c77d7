// SPDX-License-Identifier: Apache-2.0
// A convolution of one image with everything that does not depend on its values decided before.
#pragma once

#include <vector>

#include "nn/kernels/convolution.h"
#include "nn/kernels/pair_convolution.h"
#include "nn/kernels/tile.h"

namespace dcnn {

/// y = bias + weights * x, or its positive part: by a kernel for this very shape where there is
/// one, else one product for each stretch of output positions of a row that see the same taps.
class ConvolutionPlan {
 public:
  ConvolutionPlan(const ConvShape& shape, const Tensor& weights, const Tensor& bias);
  void run(const Real* x, bool relu, Real* y) const noexcept;
  /// Makes y the outputs of a fully connected layer after the ReLU, where the kernel can. Its
  /// weights then meet the positive parts in registers, and come from the second cache while others
  /// multiply.
  bool absorb(const Tensor& weight, const Tensor& bias);
  /// Multiplies in 16-bit integers where there is a kernel for that: false, and nothing changed,
  /// where not. An image that is not finite goes the way of floats.
  bool use_int16();
  bool absorbed() const { return linear_weights_.defined(); }

 private:
  struct Stretch {
    std::vector<Run> runs;
    Index length, out;  // positions, and where the first one's channels lie
  };

  void run_stretches(const Real* x, bool relu, Real* y) const noexcept;

  ConvShape shape_;
  int fixed_;  // which fixed_convolution() this is, -1 for none
  Tensor weights_, bias_;
  Tensor linear_weights_, linear_bias_, linear_sums_;  // of absorb()
  std::unique_ptr<PairConvolution> pairs_;             // of use_int16()
  std::vector<Stretch> stretches_;
};

}  // namespace dcnn
