// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/row_product.h"

#include <algorithm>
#include <array>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/row_product.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<Real, static_cast<std::size_t>(kPanelWidth)>;
constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(D()));
constexpr Index kPerPanel = kPanelWidth / kLanes;  // vectors
constexpr Index kMostPanels = std::max<Index>(1, 8 / kPerPanel);

template <std::size_t kPanels>
struct Panel {
  static constexpr std::size_t kVectors = kPanels * static_cast<std::size_t>(kPerPanel);
  hn::Vec<D> sum[kVectors];

  HWY_INLINE Panel() {}  // GCC makes one for the baseline alone, which NEON's vectors refuse
  template <std::size_t... I>
  HWY_INLINE void load(const Real* from, std::index_sequence<I...>) {
    ((sum[I] = hn::LoadU(D(), from + static_cast<Index>(I) * kLanes)), ...);
  }
  template <std::size_t... I>
  HWY_INLINE void clear(std::index_sequence<I...>) {
    ((sum[I] = hn::Zero(D())), ...);
  }
  template <std::size_t... I>
  HWY_INLINE void add(hn::Vec<D> a, const Real* HWY_RESTRICT b, Index step,
                      std::index_sequence<I...>) {
    ((sum[I] = hn::MulAdd(a,
                          hn::LoadU(D(), b + static_cast<Index>(I) / kPerPanel * step +
                                             static_cast<Index>(I) % kPerPanel * kLanes),
                          sum[I])),
     ...);
  }
  template <std::size_t... I>
  HWY_INLINE void store(Real* to, std::index_sequence<I...>) const {
    (hn::StoreU(sum[I], D(), to + static_cast<Index>(I) * kLanes), ...);
  }
};

/// kPanels panels of columns, all of which are there.
template <std::size_t kPanels>
HWY_INLINE void whole_panels(const RowProduct& p, const Real* b, const Real* start, Real* out) {
  constexpr auto kAll = std::make_index_sequence<Panel<kPanels>::kVectors>();
  Panel<kPanels> sums;
  if (start) {
    sums.load(start, kAll);
  } else {
    sums.clear(kAll);
  }
  for (Index k = 0; k < p.depth; ++k, b += kPanelWidth) {
    sums.add(hn::Set(D(), p.a[k]), b, p.panel_step, kAll);
  }
  sums.store(out, kAll);
}

/// kPanels panels from the given column on. Only those with columns beyond the last go through a
/// copy, which costs as much as a third of the products.
template <std::size_t kPanels>
void some_panels(const RowProduct& p, Index column) {
  constexpr auto kWidth = static_cast<Index>(kPanels) * kPanelWidth;
  const Index width = std::min(kWidth, p.columns - column);
  const Real* b = p.b + column / kPanelWidth * p.panel_step;
  const Real* start = p.start ? p.start + column : nullptr;
  if (width == kWidth) return whole_panels<kPanels>(p, b, start, p.out + column);
  Real edge[kWidth] = {};
  if (start) std::copy_n(start, width, edge);
  whole_panels<kPanels>(p, b, edge, edge);
  std::copy_n(edge, width, p.out + column);
}

template <std::size_t... N>
void all_panels(const RowProduct& p, std::index_sequence<N...>) {
  using Function = void (*)(const RowProduct&, Index);
  static constexpr std::array<Function, sizeof...(N)> kSome{some_panels<N + 1>...};
  const Index panels = (p.columns + kPanelWidth - 1) / kPanelWidth;
  const Index blocks = (panels + kMostPanels - 1) / kMostPanels;
  for (Index i = 0; i < blocks; ++i) {
    const Index begin = panels * i / blocks, end = panels * (i + 1) / blocks;
    kSome[static_cast<std::size_t>(end - begin - 1)](p, begin * kPanelWidth);
  }
}

void row_product_target(const RowProduct& p) {
  all_panels(p, std::make_index_sequence<static_cast<std::size_t>(kMostPanels)>());
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(row_product_target);

void row_product(const RowProduct& product) { HWY_DYNAMIC_DISPATCH(row_product_target)(product); }
}  // namespace dcnn
#endif
