// SPDX-License-Identifier: Apache-2.0
// A loop over contiguous values in whole vectors, the rest one by one with the same arithmetic.
// Compiled anew for every instruction set: included by the kernels, after highway.h.
#if defined(DCNN_NN_KERNELS_LOOP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DCNN_NN_KERNELS_LOOP_INL_H_
#undef DCNN_NN_KERNELS_LOOP_INL_H_
#else
#define DCNN_NN_KERNELS_LOOP_INL_H_
#endif

#include <hwy/highway.h>

#include "dcnn/core/tensor.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Full = hn::ScalableTag<Real>;
using One = hn::CappedTag<Real, 1>;

/// Calls loop(tag, i) for i in [0, n) in steps of the tag's lanes.
template <class Loop>
HWY_INLINE void for_all(Index n, const Loop& loop) {
  const auto lanes = static_cast<Index>(hn::Lanes(Full()));
  Index i = 0;
  for (; i + lanes <= n; i += lanes) loop(Full(), i);
  for (; i < n; ++i) loop(One(), i);
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
