// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/elementwise.h"

#include "dcnn/core/random.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/elementwise.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "nn/kernels/loop-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {

template <class D, class V>
HWY_INLINE void put(D d, V value, Tensor::GradientSlot out, Index i) {
  hn::StoreU(out.add ? hn::Add(hn::LoadU(d, out.data + i), value) : value, d, out.data + i);
}

void relu_forward_target(const Real* x, Index n, Real* y) {
  for_all(n, [=](auto d, Index i)
                 HWY_ATTR { hn::StoreU(hn::Max(hn::LoadU(d, x + i), hn::Zero(d)), d, y + i); });
}

void relu_gradient_target(const Real* y, const Real* dy, Index n, Tensor::GradientSlot slot) {
  for_all(n, [=](auto d, Index i) HWY_ATTR {
    const auto positive = hn::Gt(hn::LoadU(d, y + i), hn::Zero(d));
    put(d, hn::IfThenElseZero(positive, hn::LoadU(d, dy + i)), slot, i);
  });
}

void multiply_target(const Real* a, const Real* b, Index n, Tensor::GradientSlot out) {
  for_all(n, [=](auto d, Index i)
                 HWY_ATTR { put(d, hn::Mul(hn::LoadU(d, a + i), hn::LoadU(d, b + i)), out, i); });
}

void sum_arrays_target(const Real* arrays, Index count, Index n, Tensor::GradientSlot out) {
  for_all(n, [=](auto d, Index i) HWY_ATTR {
    auto sum = hn::LoadU(d, arrays + i);
    for (Index k = 1; k < count; ++k) sum = hn::Add(sum, hn::LoadU(d, arrays + k * n + i));
    put(d, sum, out, i);
  });
}

void dropout_mask_target(const DropoutMask& draw, Index pairs, Real* mask) {
  Index k = 0;
#if !defined(DCNN_DOUBLE) && HWY_TARGET != HWY_SCALAR
  const hn::Repartition<std::uint64_t, Full> wide;
  const hn::RebindToUnsigned<Full> half;
  const auto lanes = static_cast<Index>(hn::Lanes(wide));
  for (; k + lanes <= pairs; k += lanes) {  // mix_bits()
    auto x = hn::Iota(wide, draw.key + static_cast<std::uint64_t>(k) + 0x9e3779b97f4a7c15ULL);
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<30>(x)), hn::Set(wide, 0xbf58476d1ce4e5b9ULL));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<27>(x)), hn::Set(wide, 0x94d049bb133111ebULL));
    x = hn::Xor(x, hn::ShiftRight<31>(x));
    const auto drops = hn::Lt(hn::BitCast(half, x), hn::Set(half, draw.drop_below));
    hn::StoreU(hn::IfThenZeroElse(hn::RebindMask(Full(), drops), hn::Set(Full(), draw.kept)),
               Full(), mask + 2 * k);
  }
#endif
  const Real factors[2] = {draw.kept, 0};
  for (; k < pairs; ++k) {
    const std::uint64_t word = mix_bits(draw.key + static_cast<std::uint64_t>(k));
    mask[2 * k] = factors[(word & 0xffffffffU) < draw.drop_below];
    mask[2 * k + 1] = factors[word >> 32 < draw.drop_below];
  }
}

void adam_target(const AdamStep& s, Index n, const Real* gradient, Real* first, Real* second,
                 Real* value) {
  for_all(n, [=](auto d, Index i) HWY_ATTR {
    const auto w = hn::LoadU(d, value + i);
    const auto g = hn::MulAdd(hn::Set(d, s.l2), w,
                              hn::Mul(hn::Set(d, s.gradient_scale), hn::LoadU(d, gradient + i)));
    const auto m = hn::MulAdd(hn::Set(d, s.beta1), hn::LoadU(d, first + i),
                              hn::Mul(hn::Set(d, 1 - s.beta1), g));
    const auto v = hn::MulAdd(hn::Set(d, s.beta2), hn::LoadU(d, second + i),
                              hn::Mul(hn::Mul(hn::Set(d, 1 - s.beta2), g), g));
    const auto root = hn::MulAdd(hn::Sqrt(v), hn::Set(d, s.root_scale), hn::Set(d, s.epsilon));
    hn::StoreU(m, d, first + i);
    hn::StoreU(v, d, second + i);
    hn::StoreU(hn::NegMulAdd(hn::Set(d, s.rate), hn::Div(m, root), w), d, value + i);
  });
}

/// kOutputs dot products at once, each in kSums sums: x is read once, and latency is hidden.
template <Index kOutputs, int kSums>
void affine_block(const Real* x, const Real* weights, const Real* bias, Index inputs, Real* y) {
  using V = hn::Vec<Full>;
  const Full d;
  const auto lanes = static_cast<Index>(hn::Lanes(d));
  V sum[kSums][kOutputs];
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
  for (; i + kSums * lanes <= inputs; i += kSums * lanes) {
    for (int k = 0; k < kSums; ++k) add(sum[k], i + k * lanes);
  }
  for (; i + lanes <= inputs; i += lanes) add(sum[0], i);
  for (Index o = 0; o < kOutputs; ++o) {
    for (int step = 1; step < kSums; step *= 2) {
      for (int k = 0; k < kSums; k += 2 * step) {
        sum[k][o] = hn::Add(sum[k][o], sum[k + step][o]);
      }
    }
    Real total = hn::GetLane(hn::SumOfLanes(d, sum[0][o]));
    for (Index k = i; k < inputs; ++k) total += x[k] * weights[o * inputs + k];
    y[o] = bias[o] + total;
  }
}

template <int kSums>
void affine_in_sums(const Real* x, const Real* weights, const Real* bias, Index inputs,
                    Index outputs, Real* y) {
  Index o = 0;
  for (; o + 3 <= outputs; o += 3) {
    affine_block<3, kSums>(x, weights + o * inputs, bias + o, inputs, y + o);
  }
  for (; o < outputs; ++o) {
    affine_block<1, kSums>(x, weights + o * inputs, bias + o, inputs, y + o);
  }
}

void affine_target(const Real* x, const Real* weights, const Real* bias, Index inputs,
                   Index outputs, Real* y) {
  affine_in_sums<1>(x, weights, bias, inputs, outputs, y);
}

void affine_of_one_target(const Real* x, const Real* weights, const Real* bias, Index inputs,
                          Index outputs, Real* y) {
  affine_in_sums<4>(x, weights, bias, inputs, outputs, y);
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(relu_forward_target);
HWY_EXPORT(relu_gradient_target);
HWY_EXPORT(multiply_target);
HWY_EXPORT(sum_arrays_target);
HWY_EXPORT(dropout_mask_target);
HWY_EXPORT(adam_target);
HWY_EXPORT(affine_target);
HWY_EXPORT(affine_of_one_target);

void relu_forward(const Real* x, Index n, Real* y) {
  HWY_DYNAMIC_DISPATCH(relu_forward_target)(x, n, y);
}

void relu_gradient(const Real* y, const Real* dy, Index n, Tensor::GradientSlot slot) {
  HWY_DYNAMIC_DISPATCH(relu_gradient_target)(y, dy, n, slot);
}

void multiply(const Real* a, const Real* b, Index n, Tensor::GradientSlot out) {
  HWY_DYNAMIC_DISPATCH(multiply_target)(a, b, n, out);
}

void sum_arrays(const Real* arrays, Index count, Index n, Tensor::GradientSlot out) {
  HWY_DYNAMIC_DISPATCH(sum_arrays_target)(arrays, count, n, out);
}

void dropout_mask(const DropoutMask& draw, Index pairs, Real* mask) {
  HWY_DYNAMIC_DISPATCH(dropout_mask_target)(draw, pairs, mask);
}

void adam(const AdamStep& step, Index n, const Real* gradient, Real* first, Real* second,
          Real* value) {
  HWY_DYNAMIC_DISPATCH(adam_target)(step, n, gradient, first, second, value);
}

void affine(const Real* x, const Real* weights, const Real* bias, Index inputs, Index outputs,
            Real* y) {
  HWY_DYNAMIC_DISPATCH(affine_target)(x, weights, bias, inputs, outputs, y);
}

void affine_of_one(const Real* x, const Real* weights, const Real* bias, Index inputs,
                   Index outputs, Real* y) {
  HWY_DYNAMIC_DISPATCH(affine_of_one_target)(x, weights, bias, inputs, outputs, y);
}
}  // namespace dcnn
#endif
