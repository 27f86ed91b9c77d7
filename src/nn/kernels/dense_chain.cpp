// SPDX-License-Identifier: Apache-2.0
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
  const Index padded = layer.padded;
  const Real* w = layer.weights + at;
  const auto product = [&](Index i, V sum) HWY_ATTR {
    return hn::MulAdd(hn::Set(d, x[i]), hn::Load(d, w + i * padded), sum);
  };
  V sum[4] = {hn::Load(d, layer.bias + at), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
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

/// One unit of the samples of a block; signals lie unit by unit.
HWY_INLINE void put_unit(const DenseLayer& layer, Index at, V first, V second, Real* to) {
  const D d;
  hn::Store(activated(first, layer.activation), d, to + at * kTogether);
  hn::Store(activated(second, layer.activation), d, to + at * kTogether + kLanes);
}

HWY_INLINE void one_unit(const DenseLayer& layer, Index at, const Real* from, Real* to) {
  const D d;
  V first = hn::Set(d, layer.bias[at]), second = first;
  const Real* w = layer.weights + at;
  for (Index i = 0; i < layer.inputs; ++i, w += layer.padded, from += kTogether) {
    const V factor = hn::Set(d, *w);
    first = hn::MulAdd(factor, hn::Load(d, from), first);
    second = hn::MulAdd(factor, hn::Load(d, from + kLanes), second);
  }
  put_unit(layer, at, first, second, to);
}

/// Four at once; GCC keeps sums that have an index in memory.
HWY_INLINE void four_units(const DenseLayer& layer, Index at, const Real* from, Real* to) {
  const D d;
  V first0 = hn::Set(d, layer.bias[at]), first1 = hn::Set(d, layer.bias[at + 1]);
  V first2 = hn::Set(d, layer.bias[at + 2]), first3 = hn::Set(d, layer.bias[at + 3]);
  V second0 = first0, second1 = first1, second2 = first2, second3 = first3;
  const Real* w = layer.weights + at;
  for (Index i = 0; i < layer.inputs; ++i, w += layer.padded, from += kTogether) {
    const V x = hn::Load(d, from), y = hn::Load(d, from + kLanes);
    const V w0 = hn::Set(d, w[0]), w1 = hn::Set(d, w[1]);
    const V w2 = hn::Set(d, w[2]), w3 = hn::Set(d, w[3]);
    first0 = hn::MulAdd(w0, x, first0);
    second0 = hn::MulAdd(w0, y, second0);
    first1 = hn::MulAdd(w1, x, first1);
    second1 = hn::MulAdd(w1, y, second1);
    first2 = hn::MulAdd(w2, x, first2);
    second2 = hn::MulAdd(w2, y, second2);
    first3 = hn::MulAdd(w3, x, first3);
    second3 = hn::MulAdd(w3, y, second3);
  }
  put_unit(layer, at, first0, second0, to);
  put_unit(layer, at + 1, first1, second1, to);
  put_unit(layer, at + 2, first2, second2, to);
  put_unit(layer, at + 3, first3, second3, to);
}

/// Rows of `count` samples as one row for each input.
HWY_INLINE void turn(const Real* x, Index count, Index inputs, Real* to) {
  Index s = 0;
  for (; s + 4 <= count; s += 4, x += 4 * inputs, to += 4) {
    const Real *x1 = x + inputs, *x2 = x1 + inputs, *x3 = x2 + inputs;
    for (Index i = 0; i < inputs; ++i) {
      Real* place = to + i * kTogether;
      place[0] = x[i];
      place[1] = x1[i];
      place[2] = x2[i];
      place[3] = x3[i];
    }
  }
  for (; s < count; ++s, x += inputs, ++to) {
    for (Index i = 0; i < inputs; ++i) to[i * kTogether] = x[i];
  }
}

void dense_of_many_target(const std::vector<DenseLayer>& layers, const Real* x, Index n, Real* y) {
  HWY_ALIGN Real signals[2][kMost * kTogether];
  const Index inputs = layers.front().inputs, outputs = layers.back().outputs;
  for (Index first = 0; first < n; first += kTogether) {
    const Index count = std::min(kTogether, n - first);
    if (count < kTogether) std::fill_n(signals[0], inputs * kTogether, Real(0));
    turn(x + first * inputs, count, inputs, signals[0]);
    Index place = 0;
    for (const DenseLayer& layer : layers) {
      const Real* from = signals[place];
      Real* to = signals[1 - place];
      Index at = 0;
      for (; at + 4 <= layer.outputs; at += 4) four_units(layer, at, from, to);
      for (; at < layer.outputs; ++at) one_unit(layer, at, from, to);
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
    : inputs(weight.dim(1)),
      outputs(weight.dim(0)),
      padded((outputs + kPad - 1) / kPad * kPad),
      memory({inputs + 1, padded}) {
  assert(inputs <= kMost && outputs <= kMost);
  Real* to = memory.data();
  bias = to;
  weights = to + padded;
  for (Index o = 0; o < outputs; ++o) {
    to[o] = bias_of_outputs.data()[o];
    for (Index i = 0; i < inputs; ++i) {
      to[(i + 1) * padded + o] = weight.data()[o * inputs + i];
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
