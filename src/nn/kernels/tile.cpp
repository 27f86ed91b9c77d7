// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/tile.h"

#include <array>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/tile.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMaxRows = 13;  // as many samples as the largest piece of a batch
// Two vectors per row halve the loads of `a`; the accumulators must leave registers for both
// factors.
constexpr std::size_t kMaxWideRows = HWY_TARGET <= HWY_AVX3 ? kMaxRows : 6;

template <class D, std::size_t kRows, std::size_t kVectors>
struct Sums {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  static constexpr std::size_t kLanes = hn::MaxLanes(D());
  V sum[kRows * kVectors];

  HWY_INLINE Sums() {}  // GCC makes one for the baseline alone, which NEON's vectors refuse
  template <std::size_t... I>
  HWY_INLINE void load(const T* start, Index row, std::index_sequence<I...>) {
    ((sum[I] = hn::LoadU(D(), start + static_cast<Index>(I / kVectors) * row +
                                  static_cast<Index>(I % kVectors * kLanes))),
     ...);
  }
  template <std::size_t... I>
  HWY_INLINE void clear(std::index_sequence<I...>) {
    ((sum[I] = hn::Zero(D())), ...);
  }
  template <std::size_t... I>
  HWY_INLINE void store(T* out, Index row, std::index_sequence<I...>) const {
    (hn::StoreU(
         sum[I], D(),
         out + static_cast<Index>(I / kVectors) * row + static_cast<Index>(I % kVectors * kLanes)),
     ...);
  }
  template <std::size_t R>
  HWY_INLINE void add_row(V a, V b0, V b1) {
    sum[R * kVectors] = hn::MulAdd(a, b0, sum[R * kVectors]);
    if constexpr (kVectors == 2) sum[R * 2 + 1] = hn::MulAdd(a, b1, sum[R * 2 + 1]);
  }
  template <std::size_t... R>
  HWY_INLINE void add(const T* HWY_RESTRICT a, Index row, const T* HWY_RESTRICT b,
                      std::index_sequence<R...>) {
    const V b0 = hn::LoadU(D(), b);
    V b1 = b0;
    if constexpr (kVectors == 2) b1 = hn::LoadU(D(), b + kLanes);
    (add_row<R>(hn::Set(D(), a[static_cast<Index>(R) * row]), b0, b1), ...);
  }
};

template <class D, std::size_t kRows, std::size_t kVectors>
void tile(const TileProduct<hn::TFromD<D>>& p, Index row, Index column) {
  constexpr auto kAll = std::make_index_sequence<kRows * kVectors>();
  constexpr auto kEachRow = std::make_index_sequence<kRows>();
  Sums<D, kRows, kVectors> sums;
  if (p.start) {
    sums.load(p.start + row * p.start_row + column, p.start_row, kAll);
  } else {
    sums.clear(kAll);
  }
  const Index a_row = p.a_row, a_step = p.a_step, b_step = p.b_step;
  for (const Run& run : p.runs) {
    const auto* a = p.a + run.a + row * a_row;
    const auto* b = p.b + run.b + column;
    for (Index k = 0; k < run.length; ++k, a += a_step, b += b_step) {
      sums.add(a, a_row, b, kEachRow);
    }
  }
  sums.store(p.out + row * p.out_row + column, p.out_row, kAll);
}

/// All rows of a block of columns, in blocks of nearly equal height.
template <class D, std::size_t kVectors, std::size_t... R>
void rows_of_tiles(const TileProduct<hn::TFromD<D>>& p, Index column, std::index_sequence<R...>) {
  using Function = void (*)(const TileProduct<hn::TFromD<D>>&, Index, Index);
  static constexpr std::array<Function, sizeof...(R)> kTiles{tile<D, R + 1, kVectors>...};
  constexpr auto kMost = static_cast<Index>(sizeof...(R));
  const Index blocks = (p.rows + kMost - 1) / kMost;
  for (Index i = 0; i < blocks; ++i) {
    const Index begin = p.rows * i / blocks, end = p.rows * (i + 1) / blocks;
    kTiles[static_cast<std::size_t>(end - begin - 1)](p, begin, column);
  }
}

/// What is left of the columns, in vectors of half the length, and half again.
template <std::size_t kWidth, class T>
void narrow_tiles(const TileProduct<T>& p, Index column) {
  using D = hn::CappedTag<T, kWidth>;
  if (p.columns - column >= static_cast<Index>(kWidth)) {
    rows_of_tiles<D, 1>(p, column, std::make_index_sequence<kMaxRows>());
    column += static_cast<Index>(kWidth);
  }
  if constexpr (kWidth > 1) narrow_tiles<kWidth / 2>(p, column);
}

template <class T>
void tile_product_of(const TileProduct<T>& p) {
  using D = hn::ScalableTag<T>;
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  constexpr auto kWide = static_cast<Index>(2 * kLanes);
  Index column = 0;
  for (; p.columns - column >= kWide; column += kWide) {
    rows_of_tiles<D, 2>(p, column, std::make_index_sequence<kMaxWideRows>());
  }
  narrow_tiles<kLanes>(p, column);
}

void product_f32(const TileProduct<float>& p) { tile_product_of(p); }
void product_f64(const TileProduct<double>& p) { tile_product_of(p); }

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(product_f32);
HWY_EXPORT(product_f64);
void tile_product(const TileProduct<float>& product) { HWY_DYNAMIC_DISPATCH(product_f32)(product); }
void tile_product(const TileProduct<double>& product) {
  HWY_DYNAMIC_DISPATCH(product_f64)(product);
}
}  // namespace dcnn
#endif
