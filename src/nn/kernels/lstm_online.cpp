// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/lstm_online.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/lstm_online.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "nn/kernels/logistic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {

using D = hn::ScalableTag<Real>;
using V = hn::Vec<D>;
constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(D()));

/// Of one vector of units c = c/(1 + e^-f) + (1 - e^-2g)/((1 + e^-i)(1 + e^-2g)), and 1 + e^-o in
/// the place of h.
HWY_INLINE void put_c(const Real* i, const Real* f, const Real* g, const Real* o, Real* c,
                      Real* h) {
  const D d;
  const V one = hn::Set(d, Real(1));
  const V ei = exp_limited(d, Real(-1), hn::LoadU(d, i));
  const V ef = exp_limited(d, Real(-1), hn::LoadU(d, f));
  const V eg = exp_limited(d, Real(-2), hn::LoadU(d, g));
  const V eo = exp_limited(d, Real(-1), hn::LoadU(d, o));
  const V f1 = hn::Add(one, ef), ig = hn::Mul(hn::Add(one, ei), hn::Add(one, eg));
  const V sum = hn::MulAdd(hn::LoadU(d, c), ig, hn::Mul(hn::Sub(one, eg), f1));
  hn::StoreU(hn::Div(sum, hn::Mul(f1, ig)), d, c);
  hn::StoreU(hn::Add(one, eo), d, h);
}

/// h = (1 - e^-2c)/((1 + e^-o)(1 + e^-2c)).
HWY_INLINE void put_h(const Real* c, Real* h) {
  const D d;
  const V one = hn::Set(d, Real(1));
  const V ec = exp_limited(d, Real(-2), hn::LoadU(d, c));
  hn::StoreU(hn::Div(hn::Sub(one, ec), hn::Mul(hn::LoadU(d, h), hn::Add(one, ec))), d, h);
}

/// Two loops: one chain from i to h is longer than the processor looks ahead.
void lstm_online_target(const LstmOnline& cell) {
  const Index units = cell.units;
  for (Index r = 0; r < cell.rows; ++r) {
    const Real *i = cell.gates + r * cell.gates_row, *f = i + units, *g = f + units, *o = g + units;
    Real *c = cell.c + r * cell.row, *h = cell.h + r * cell.row;
    for (Index k = 0; k < units; k += kLanes) put_c(i + k, f + k, g + k, o + k, c + k, h + k);
    for (Index k = 0; k < units; k += kLanes) put_h(c + k, h + k);
  }
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(lstm_online_target);
void lstm_online(const LstmOnline& cell) { HWY_DYNAMIC_DISPATCH(lstm_online_target)(cell); }
}  // namespace dcnn
#endif
