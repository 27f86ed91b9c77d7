// SPDX-License-Identifier: Apache-2.0
// The S-shaped functions of gates, and their slopes. Compiled anew for every instruction set:
// included by the kernels, after highway.h.
#if defined(DCNN_NN_KERNELS_LOGISTIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DCNN_NN_KERNELS_LOGISTIC_INL_H_
#undef DCNN_NN_KERNELS_LOGISTIC_INL_H_
#else
#define DCNN_NN_KERNELS_LOGISTIC_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cmath>

#include "dcnn/core/tensor.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// 1/(1 + exp(-x)). Beyond ±80 the result is 0 or 1 to any precision, and exp() would overflow.
template <class D, class V>
HWY_INLINE V logistic(D d, V x) {
  const V limited = hn::Max(hn::Set(d, Real(-80)), hn::Min(hn::Set(d, Real(80)), x));
  const V one = hn::Set(d, Real(1));
  return hn::Div(one, hn::Add(one, hn::Exp(d, hn::Neg(limited))));
}

/// exp(factor·x), its exponent held within ±28, so that a product of three is still finite. In
/// single precision 2^n·2^f, n the nearest integer, which the sum with 1.5·2^23 leaves in the last
/// bits; 2^f = 1 + f·P(f) within 5e-9, P from Chebyshev's points.
template <class D, class V>
HWY_INLINE V exp_limited(D d, Real factor, V x) {
  const Real most = 28 / std::abs(factor);
  x = hn::Max(hn::Set(d, -most), hn::Min(hn::Set(d, most), x));
  if constexpr (sizeof(Real) != sizeof(float)) {
    return hn::Exp(d, hn::Mul(hn::Set(d, factor), x));
  } else {
    const auto scale = hn::Set(d, factor * 1.44269504f), shift = hn::Set(d, 12582912.0f);
    const auto n = hn::MulAdd(x, scale, shift);
    const auto f = hn::MulSub(x, scale, hn::Sub(n, shift));
    auto p = hn::MulAdd(hn::Set(d, 1.545316294e-4f), f, hn::Set(d, 1.339086336e-3f));
    p = hn::MulAdd(p, f, hn::Set(d, 9.618082557e-3f));
    p = hn::MulAdd(p, f, hn::Set(d, 5.550357114e-2f));
    p = hn::MulAdd(p, f, hn::Set(d, 0.2402265076f));
    p = hn::MulAdd(p, f, hn::Set(d, 0.693147188f));
    p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
    const hn::RebindToSigned<D> bits;
    return hn::BitCast(d, hn::Add(hn::BitCast(bits, p), hn::ShiftLeft<23>(hn::BitCast(bits, n))));
  }
}

/// x·(1 - x), the slope of the logistic function where its value is x.
template <class D, class V>
HWY_INLINE V logistic_slope(D d, V x) {
  return hn::Mul(x, hn::Sub(hn::Set(d, Real(1)), x));
}

/// 1 - x², the slope of tanh where its value is x.
template <class D, class V>
HWY_INLINE V tanh_slope(D d, V x) {
  return hn::NegMulAdd(x, x, hn::Set(d, Real(1)));
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
