// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/fixed_convolution.h"

#include "nn/kernels/fixed_shapes.h"

// width, channels and filters of the images of DCNN, `same` and `valid`
#define DCNN_FIXED_CONVOLUTIONS(SHAPE) \
  SHAPE(5, 1, 8, true)                 \
  SHAPE(5, 8, 16, true)                \
  SHAPE(5, 16, 32, true)               \
  SHAPE(5, 32, 32, true)               \
  SHAPE(5, 1, 8, false) SHAPE(4, 8, 16, false) SHAPE(3, 16, 32, false) SHAPE(2, 32, 32, false)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/fixed_convolution.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "nn/kernels/fixed-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {

void fixed_convolution_target(int kind, const FixedConvolution<Real>& c) {
  using Function = void (*)(const FixedConvolution<Real>&);
#define DCNN_RUN(width, channels, filters, same) Fixed<Real, width, channels, filters, same>::run,
  static constexpr Function kRuns[] = {DCNN_FIXED_CONVOLUTIONS(DCNN_RUN)};
#undef DCNN_RUN
  kRuns[kind](c);
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(fixed_convolution_target);

int fixed_convolution_kind(const ConvShape& shape) {
#define DCNN_KIND(width, channels, filters, same) {width, channels, filters, same},
  static constexpr FixedShape kShapes[] = {DCNN_FIXED_CONVOLUTIONS(DCNN_KIND)};
#undef DCNN_KIND
  return find_fixed(kShapes, shape);
}

void fixed_convolution(int kind, const FixedConvolution<Real>& convolution) {
  HWY_DYNAMIC_DISPATCH(fixed_convolution_target)(kind, convolution);
}
}  // namespace dcnn
#endif
