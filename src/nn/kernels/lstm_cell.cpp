// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/lstm_cell.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/lstm_cell.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "nn/kernels/logistic-inl.h"
#include "nn/kernels/loop-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {

template <class D>
HWY_INLINE hn::Vec<D> load_or_zero(D d, const Real* from, Index i) {
  return from ? hn::LoadU(d, from + i) : hn::Zero(d);
}

void lstm_cell_target(const LstmCell& cell) {
  const Index units = cell.units;
  for (Index r = 0; r < cell.rows; ++r) {
    Real *i_gate = cell.gates + r * 4 * units, *f_gate = i_gate + units, *g_gate = f_gate + units,
         *o_gate = g_gate + units;
    Real *c_row = cell.c + r * units, *tanh_row = cell.tanh_c + r * units,
         *h_row = cell.h + r * cell.h_row;
    const Real* before = cell.c_before ? cell.c_before + r * units : nullptr;
    for_all(units, [=](auto d, Index k) HWY_ATTR {
      const auto i = logistic(d, hn::LoadU(d, i_gate + k));
      const auto f = logistic(d, hn::LoadU(d, f_gate + k));
      const auto g = hn::Tanh(d, hn::LoadU(d, g_gate + k));
      const auto o = logistic(d, hn::LoadU(d, o_gate + k));
      const auto c = hn::MulAdd(f, load_or_zero(d, before, k), hn::Mul(i, g));
      const auto tanh_c = hn::Tanh(d, c);
      hn::StoreU(i, d, i_gate + k);
      hn::StoreU(f, d, f_gate + k);
      hn::StoreU(g, d, g_gate + k);
      hn::StoreU(o, d, o_gate + k);
      hn::StoreU(c, d, c_row + k);
      hn::StoreU(tanh_c, d, tanh_row + k);
      hn::StoreU(hn::Mul(o, tanh_c), d, h_row + k);
    });
  }
}

void lstm_cell_gradient_target(const LstmCellGradient& cell) {
  const Index units = cell.units;
  for (Index r = 0; r < cell.rows; ++r) {
    Real *i_gate = cell.gates + r * 4 * units, *f_gate = i_gate + units, *g_gate = f_gate + units,
         *o_gate = g_gate + units;
    Real* dc_row = cell.dc + r * units;
    const Real *tanh_row = cell.tanh_c + r * units, *dh_row = cell.dh + r * units;
    const Real* before = cell.c_before ? cell.c_before + r * units : nullptr;
    for_all(units, [=](auto d, Index k) HWY_ATTR {
      const auto i = hn::LoadU(d, i_gate + k), f = hn::LoadU(d, f_gate + k);
      const auto g = hn::LoadU(d, g_gate + k), o = hn::LoadU(d, o_gate + k);
      const auto dh = hn::LoadU(d, dh_row + k), tanh_c = hn::LoadU(d, tanh_row + k);
      const auto dc = hn::MulAdd(hn::Mul(dh, o), tanh_slope(d, tanh_c), hn::LoadU(d, dc_row + k));
      hn::StoreU(hn::Mul(hn::Mul(dc, g), logistic_slope(d, i)), d, i_gate + k);
      hn::StoreU(hn::Mul(hn::Mul(dc, load_or_zero(d, before, k)), logistic_slope(d, f)), d,
                 f_gate + k);
      hn::StoreU(hn::Mul(hn::Mul(dc, i), tanh_slope(d, g)), d, g_gate + k);
      hn::StoreU(hn::Mul(hn::Mul(dh, tanh_c), logistic_slope(d, o)), d, o_gate + k);
      hn::StoreU(hn::Mul(dc, f), d, dc_row + k);
    });
  }
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(lstm_cell_target);
HWY_EXPORT(lstm_cell_gradient_target);

void lstm_cell(const LstmCell& cell) { HWY_DYNAMIC_DISPATCH(lstm_cell_target)(cell); }

void lstm_cell_gradient(const LstmCellGradient& cell) {
  HWY_DYNAMIC_DISPATCH(lstm_cell_gradient_target)(cell);
}
}  // namespace dcnn
#endif
