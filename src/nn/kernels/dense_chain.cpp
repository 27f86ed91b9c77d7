#include "nn/kernels/dense_chain.h"

#include <algorithm>
#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/dense_chain.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "nn/kernels/logistic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {

using D = hn::ScalableTag<Real>;
using V = hn::Vec<D>;
constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(D()));
constexpr Index kMost = DenseLayer::kMost;
static_assert(DenseLayer::kPad % kLanes == 0);

HWY_INLINE V activated(V x, Activation activation) {
  const D d;
  if (activation == Activation::kNone) return x;
  if (activation == Activation::kRelu) return hn::Max(x, hn::Zero(d));
  const V one = hn::Set(d, Real(1)), e = exp_limited(d, Real(-2), x);
  return hn::Div(hn::Sub(one, e), hn::Add(one, e));
}

/// One vector of units from `at` on; four sums hide the latency.
HWY_INLINE V units(const DenseLayer& layer, Index at, const Real* x) {
  const D d;
  const Index padded = layer.bias.size();
  const Real* w = layer.weights.data() + at;
  const auto product = [&](Index i, V sum) HWY_ATTR {
    return hn::MulAdd(hn::Set(d, x[i]), hn::Load(d, w + i * padded), sum);
  };
  V sum[4] = {hn::Load(d, layer.bias.data() + at), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  Index i = 0;
  for (; i + 4 <= layer.inputs; i += 4) {
    sum[0] = product(i, sum[0]);
    sum[1] = product(i + 1, sum[1]);
    sum[2] = product(i + 2, sum[2]);
    sum[3] = product(i + 3, sum[3]);
  }
  for (; i < layer.inputs; ++i) sum[0] = product(i, sum[0]);
  return activated(hn::Add(hn::Add(sum[0], sum[1]), hn::Add(sum[2], sum[3])), layer.activation);
}

void dense_of_one_target(const std::vector<DenseLayer>& layers, const Real* x, Real* y) {
  const D d;
  HWY_ALIGN Real signals[2][kMost];
  const Real* from = x;
  Index place = 0;
  for (const DenseLayer& layer : layers) {
    Real* to = signals[place];
    for (Index at = 0; at < layer.outputs; at += kLanes) {
      hn::Store(units(layer, at, from), d, to + at);
    }
    from = to;
    place = 1 - place;
  }
  std::copy_n(from, layers.back().outputs, y);
}

constexpr Index kTogether = 2 * kLanes;  // samples

/// kUnits units of the samples of a block, from `at` on; signals lie unit by unit.
template <Index kUnits>
HWY_INLINE void tile(const DenseLayer& layer, Index at, const Real* from, Real* to) {
  const D d;
  const Index padded = layer.bias.size();
  V sum[kUnits][2];
  for (Index u = 0; u < kUnits; ++u) {
    sum[u][0] = sum[u][1] = hn::Set(d, layer.bias.data()[at + u]);
  }
  const Real* w = layer.weights.data() + at;
  for (Index i = 0; i < layer.inputs; ++i) {
    const V first = hn::Load(d, from + i * kTogether);
    const V second = hn::Load(d, from + i * kTogether + kLanes);
    for (Index u = 0; u < kUnits; ++u) {
      const V factor = hn::Set(d, w[i * padded + u]);
      sum[u][0] = hn::MulAdd(factor, first, sum[u][0]);
      sum[u][1] = hn::MulAdd(factor, second, sum[u][1]);
    }
  }
  for (Index u = 0; u < kUnits; ++u) {
    Real* place = to + (at + u) * kTogether;
    hn::Store(activated(sum[u][0], layer.activation), d, place);
    hn::Store(activated(sum[u][1], layer.activation), d, place + kLanes);
  }
}

void dense_of_many_target(const std::vector<DenseLayer>& layers, const Real* x, Index n, Real* y) {
  HWY_ALIGN Real signals[2][kMost * kTogether];
  const Index inputs = layers.front().inputs, outputs = layers.back().outputs;
  for (Index first = 0; first < n; first += kTogether) {
    const Index count = std::min(kTogether, n - first);
    if (count < kTogether) std::fill_n(signals[0], inputs * kTogether, Real(0));
    for (Index i = 0; i < inputs; ++i) {
      for (Index s = 0; s < count; ++s) signals[0][i * kTogether + s] = x[(first + s) * inputs + i];
    }
    Index place = 0;
    for (const DenseLayer& layer : layers) {
      const Real* from = signals[place];
      Real* to = signals[1 - place];
      Index at = 0;
      for (; at + 4 <= layer.outputs; at += 4) tile<4>(layer, at, from, to);
      for (; at < layer.outputs; ++at) tile<1>(layer, at, from, to);
      place = 1 - place;
    }
    for (Index s = 0; s < count; ++s) {
      for (Index o = 0; o < outputs; ++o) {
        y[(first + s) * outputs + o] = signals[place][o * kTogether + s];
      }
    }
  }
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(dense_of_one_target);
HWY_EXPORT(dense_of_many_target);

DenseLayer::DenseLayer(const Tensor& weight, const Tensor& bias_of_outputs)
    : inputs(weight.dim(1)), outputs(weight.dim(0)) {
  assert(inputs <= kMost && outputs <= kMost);
  const Index padded = (outputs + kPad - 1) / kPad * kPad;
  weights = Tensor({inputs, padded});
  bias = Tensor({padded});
  std::copy_n(bias_of_outputs.data(), outputs, bias.data());
  for (Index o = 0; o < outputs; ++o) {
    for (Index i = 0; i < inputs; ++i) {
      weights.data()[i * padded + o] = weight.data()[o * inputs + i];
    }
  }
}

void dense_of_one(const std::vector<DenseLayer>& layers, const Real* x, Real* y) {
  HWY_DYNAMIC_DISPATCH(dense_of_one_target)(layers, x, y);
}

void dense_of_many(const std::vector<DenseLayer>& layers, const Real* x, Index n, Real* y) {
  HWY_DYNAMIC_DISPATCH(dense_of_many_target)(layers, x, n, y);
}
}  // namespace dcnn
#endif
