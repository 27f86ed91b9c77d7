#include "nn/kernels/few_outputs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/few_outputs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// kOutputs dot products, each in four sums.
template <Index kOutputs>
void dot_products(const Real* HWY_RESTRICT x, const Real* HWY_RESTRICT weights, const Real* bias,
                  Index inputs, Real* y) {
  const hn::ScalableTag<Real> d;
  using V = hn::Vec<decltype(d)>;
  const auto lanes = static_cast<Index>(hn::Lanes(d));
  V sum[4][kOutputs];
  for (auto& part : sum) {
    for (V& s : part) s = hn::Zero(d);
  }
  const auto add = [&](V* part, Index i) HWY_ATTR {
    const V value = hn::LoadU(d, x + i);
    for (Index o = 0; o < kOutputs; ++o) {
      part[o] = hn::MulAdd(value, hn::LoadU(d, weights + o * inputs + i), part[o]);
    }
  };
  Index i = 0;
  for (; i + 4 * lanes <= inputs; i += 4 * lanes) {
    add(sum[0], i);
    add(sum[1], i + lanes);
    add(sum[2], i + 2 * lanes);
    add(sum[3], i + 3 * lanes);
  }
  for (; i + lanes <= inputs; i += lanes) add(sum[0], i);
  for (Index o = 0; o < kOutputs; ++o) {
    const V all = hn::Add(hn::Add(sum[0][o], sum[1][o]), hn::Add(sum[2][o], sum[3][o]));
    Real total = hn::GetLane(hn::SumOfLanes(d, all));
    for (Index k = i; k < inputs; ++k) total += x[k] * weights[o * inputs + k];
    y[o] = bias[o] + total;
  }
}

void few_outputs_target(const Real* x, const Real* weights, const Real* bias, Index inputs,
                        Index outputs, Real* y) {
  Index o = 0;
  for (; o + 3 <= outputs; o += 3) {
    dot_products<3>(x, weights + o * inputs, bias + o, inputs, y + o);
  }
  for (; o < outputs; ++o) dot_products<1>(x, weights + o * inputs, bias + o, inputs, y + o);
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(few_outputs_target);

void few_outputs(const Real* x, const Real* weights, const Real* bias, Index inputs, Index outputs,
                 Real* y) {
  HWY_DYNAMIC_DISPATCH(few_outputs_target)(x, weights, bias, inputs, outputs, y);
}
}  // namespace dcnn
#endif
