// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/convolution_plan.h"

#include "nn/kernels/elementwise.h"
#include "nn/kernels/fixed_convolution.h"
#include "nn/kernels/taps.h"

namespace dcnn {

ConvolutionPlan::ConvolutionPlan(const ConvShape& shape, const Tensor& weights, const Tensor& bias)
    : shape_(shape),
      fixed_(fixed_convolution_kind(shape)),
      weights_(Tensor::from(weights.shape(), weights.values())),
      bias_(Tensor::from(bias.shape(), bias.values())) {
  for (Index row = 0; row < shape.out_h; ++row) {
    for (Index begin = 0, end = 0; begin < shape.out_w; begin = end) {
      const Taps taps = column_taps(shape, begin);
      for (end = begin + 1; end < shape.out_w && column_taps(shape, end) == taps;) ++end;
      Stretch stretch{{}, end - begin, (row * shape.out_w + begin) * shape.out_c};
      position_runs(shape, row, begin, stretch.runs);
      stretches_.push_back(std::move(stretch));
    }
  }
}

void ConvolutionPlan::run(const Real* x, bool relu, Real* y) const noexcept {
  if (fixed_ < 0 || !relu) return run_stretches(x, relu, y);
  FixedLinear linear;
  if (absorbed()) {
    linear = {linear_weights_.data(), linear_bias_.data(), linear_sums_.data(),
              linear_weights_.dim(0), linear_weights_.dim(1)};
  }
  if (pairs_ && pairs_->run(x, bias_.data(), linear, y)) return;
  fixed_convolution(fixed_, {x, weights_.data(), bias_.data(), y, shape_.in_h, linear});
}

bool ConvolutionPlan::use_int16() {
  pairs_ = PairConvolution::make(shape_, weights_);
  return pairs_ != nullptr;
}

bool ConvolutionPlan::absorb(const Tensor& weight, const Tensor& bias) {
  const Index outputs = weight.dim(0);
  if (absorbed() || fixed_ < 0 || outputs % FixedLinear::kTogether != 0) return false;
  linear_weights_ = Tensor::from(weight.shape(), weight.values());
  linear_bias_ = Tensor::from(bias.shape(), bias.values());
  linear_sums_ = Tensor({outputs * FixedLinear::kSums});
  return true;
}

void ConvolutionPlan::run_stretches(const Real* x, bool relu, Real* y) const noexcept {
  for (const Stretch& stretch : stretches_) {
    tile_product({.a = x,
                  .a_row = shape_.in_c,
                  .a_step = 1,
                  .b = weights_.data(),
                  .b_step = shape_.out_c,
                  .runs = stretch.runs,
                  .out = y + stretch.out,
                  .out_row = shape_.out_c,
                  .start = bias_.data(),
                  .start_row = 0,
                  .rows = stretch.length,
                  .columns = shape_.out_c});
  }
  if (relu) relu_forward(y, shape_.out_size(), y);
}

}  // namespace dcnn
