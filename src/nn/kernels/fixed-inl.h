// SPDX-License-Identifier: Apache-2.0
// What surrounds the products of positions-inl.h: blocks of rows, the ReLU, a fully connected layer
// behind it. Compiled anew for every instruction set: included by the kernels, after highway.h.
#if defined(DCNN_NN_KERNELS_FIXED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DCNN_NN_KERNELS_FIXED_INL_H_
#undef DCNN_NN_KERNELS_FIXED_INL_H_
#else
#define DCNN_NN_KERNELS_FIXED_INL_H_
#endif

#include <algorithm>
#include <array>

#include "nn/kernels/fixed_convolution.h"
#include "nn/kernels/positions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {

/// What becomes of kCount sums of outputs, kVectors vectors of each position.
template <class D, std::size_t kVectors, std::size_t kCount>
struct Outputs {
  using V = hn::Vec<D>;
  static constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(D()));
  static constexpr auto kAll = std::make_index_sequence<kCount>();

  /// One positive part times its weights of three outputs, `inputs` apart.
  template <std::size_t kChain, std::size_t kChains>
  static HWY_INLINE void add_three(V* total, V value, const Real* HWY_RESTRICT w, Index inputs) {
    value = hn::Max(value, hn::Zero(D()));
    total[kChain] = hn::MulAdd(value, hn::LoadU(D(), w), total[kChain]);
    total[kChains + kChain] =
        hn::MulAdd(value, hn::LoadU(D(), w + inputs), total[kChains + kChain]);
    total[2 * kChains + kChain] =
        hn::MulAdd(value, hn::LoadU(D(), w + 2 * inputs), total[2 * kChains + kChain]);
  }
  template <std::size_t kChains, std::size_t... I, std::size_t... T>
  static HWY_INLINE void add_linear(const V* sum, const Real* w, Index inputs, Index step,
                                    Real* HWY_RESTRICT sums, std::index_sequence<I...>,
                                    std::index_sequence<T...>) {
    V total[] = {hn::LoadU(D(), sums + static_cast<Index>(T) * kLanes)...};
    (add_three<I % kChains, kChains>(
         total, sum[I],
         w + static_cast<Index>(I / kVectors) * step + static_cast<Index>(I % kVectors) * kLanes,
         inputs),
     ...);
    (hn::StoreU(total[T], D(), sums + static_cast<Index>(T) * kLanes), ...);
  }
  template <std::size_t... I>
  static HWY_INLINE void store_positive(const V* sum, Real* y, Index step,
                                        std::index_sequence<I...>) {
    (hn::StoreU(
         hn::Max(sum[I], hn::Zero(D())), D(),
         y + static_cast<Index>(I / kVectors) * step + static_cast<Index>(I % kVectors) * kLanes),
     ...);
  }
};

/// T: Real, or std::int32_t for pairs of channels in 16 bits, kInC pairs of them.
template <class T, Index kInW, Index kInC, Index kOutC, bool kSame>
struct Fixed {
  static constexpr bool kPairs = !std::is_same_v<T, Real>;
  static constexpr std::size_t kNative = hn::MaxLanes(hn::ScalableTag<Real>());
  static constexpr std::size_t kFilters = static_cast<std::size_t>(kOutC);
  using D = hn::CappedTag<Real, std::min(kNative, kFilters)>;
  static constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(D()));
  static constexpr std::size_t kVectors = kOutC >= 2 * kLanes ? 2 : 1;
  static constexpr Index kChains = kMostSums > 12 ? 2 : 1;  // sums of one output of a linear layer
  static constexpr Index kOutW = kSame ? kInW : kInW - 1;
  static constexpr auto kColumns = static_cast<std::size_t>(kOutW);
  /// One channel is four products a sum: GCC loads all of an image's values before the first, and
  /// of many rows spills them.
  static constexpr std::size_t kMostRows =
      kInC == 1 ? 2 : std::max<std::size_t>(1, kMostSums / (kVectors * kColumns));

  template <std::size_t kCount>
  static HWY_INLINE void put(const FixedConvolution<T>& c, const hn::Vec<D>* sum, Index at) {
    using Out = Outputs<D, kVectors, kCount>;
    if (c.linear.outputs == 0) return Out::store_positive(sum, c.y + at, kOutC, Out::kAll);
    for (Index o = 0; o < c.linear.outputs; o += FixedLinear::kTogether) {
      Out::template add_linear<kChains>(
          sum, c.linear.weights + o * c.linear.inputs + at, c.linear.inputs, kOutC,
          c.linear.sums + o * kChains * kLanes, Out::kAll, std::make_index_sequence<3 * kChains>());
    }
  }

  /// Sums of integers as what they stand for.
  template <std::size_t... I>
  static HWY_INLINE void put_integers(const FixedConvolution<T>& c,
                                      const hn::Vec<hn::Rebind<T, D>>* sum, Index filter, Index at,
                                      std::index_sequence<I...>) {
    const D d;
    const auto unit = hn::Set(d, c.x_unit);
    const auto unit0 = hn::Mul(unit, hn::LoadU(d, c.units + filter));
    const auto bias0 = hn::LoadU(d, c.bias + filter);
    auto unit1 = unit0, bias1 = bias0;
    if constexpr (kVectors == 2) {
      unit1 = hn::Mul(unit, hn::LoadU(d, c.units + filter + kLanes));
      bias1 = hn::LoadU(d, c.bias + filter + kLanes);
    }
    const hn::Vec<D> values[] = {hn::MulAdd(hn::ConvertTo(d, sum[I]),
                                            I % kVectors == 0 ? unit0 : unit1,
                                            I % kVectors == 0 ? bias0 : bias1)...};
    put<sizeof...(I)>(c, values, at);
  }

  /// Output rows [row, row + kRows); those at the bottom of a `same` image see no row below.
  template <std::size_t kRows, bool kBottom>
  static HWY_INLINE void block(const FixedConvolution<T>& c, Index row, Index filter) {
    using Sums = Positions<hn::Rebind<T, D>, kVectors, kRows, kColumns, kInW, kInC>;
    constexpr auto kAll = Sums::kAll;
    const Index at = row * kOutW * kOutC + filter;
    Sums sums;
    if constexpr (kPairs) {
      sums.clear(kAll);
    } else {
      sums.start(c.bias + filter, kAll);
    }
    sums.template add_window<kSame, kOutC>(c.x + row * kInW * kInC, c.weights + filter, kBottom);
    if constexpr (kPairs) {
      put_integers(c, sums.sum, filter, at, kAll);
    } else {
      put<kAll.size()>(c, sums.sum, at);
    }
  }

  /// All rows in blocks of nearly equal height.
  template <std::size_t... R>
  static void rows(const FixedConvolution<T>& c, Index filter, std::index_sequence<R...>) {
    using Function = void (*)(const FixedConvolution<T>&, Index, Index);
    static constexpr std::array<Function, sizeof...(R)> kBlocks{block<R + 1, false>...};
    constexpr auto kMost = static_cast<int>(sizeof...(R));
    const int whole = static_cast<int>(c.in_h) - 1, count = (whole + kMost - 1) / kMost;
    if constexpr (kInC == 1) {  // little work in a block: calls would take a third of the time
      for (int begin = 0; begin < whole; begin += kMost) {
        begin + 1 < whole ? block<2, false>(c, begin, filter) : block<1, false>(c, begin, filter);
      }
      if constexpr (kSame) block<1, true>(c, whole, filter);
      return;
    }
    const int height = count > 0 ? whole / count : 0, higher = whole - height * count;
    for (int i = 0, begin = 0; i < count; ++i) {
      const int rows_of_block = height + (i < higher ? 1 : 0);
      kBlocks[static_cast<std::size_t>(rows_of_block - 1)](c, begin, filter);
      begin += rows_of_block;
    }
    if constexpr (kSame) block<1, true>(c, whole, filter);
  }

  static void run(const FixedConvolution<T>& c) {
    const FixedLinear& linear = c.linear;
    for (Index k = 0; k < linear.outputs * kChains; ++k) {
      hn::StoreU(hn::Zero(D()), D(), linear.sums + k * kLanes);
    }
    for (Index filter = 0; filter < kOutC; filter += static_cast<Index>(kVectors) * kLanes) {
      rows(c, filter, std::make_index_sequence<kMostRows>());
    }
    for (Index o = 0; o < linear.outputs; ++o) {
      const Real* sums = linear.sums + o * kChains * kLanes;
      auto total = hn::LoadU(D(), sums);
      if constexpr (kChains == 2) total = hn::Add(total, hn::LoadU(D(), sums + kLanes));
      c.y[o] = linear.bias[o] + hn::GetLane(hn::SumOfLanes(D(), total));
    }
  }
};

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
