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
