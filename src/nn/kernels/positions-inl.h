// SPDX-License-Identifier: Apache-2.0
// A 2x2 convolution of one image whose every extent but the height is known to the compiler, in
// floats or in pairs of 16-bit numbers. Compiled anew for every instruction set: included by the
// kernels, after highway.h.
#if defined(DCNN_NN_KERNELS_POSITIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DCNN_NN_KERNELS_POSITIONS_INL_H_
#undef DCNN_NN_KERNELS_POSITIONS_INL_H_
#else
#define DCNN_NN_KERNELS_POSITIONS_INL_H_
#endif

#include <hwy/highway.h>

#include <utility>

#include "dcnn/core/tensor.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Accumulators that leave registers for the weights and one value of the image.
constexpr std::size_t kMostSums = HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM_A64 ? 24 : 12;

template <class D, class V>
HWY_INLINE V multiply_add(D /*d*/, V x, V w, V sum) {
  if constexpr (hwy::IsFloat<hn::TFromD<D>>()) {
    return hn::MulAdd(x, w, sum);
  } else {  // a lane is two 16-bit numbers: both products
#if HWY_TARGET == HWY_AVX3_DL
    // By name: what Highway 1.0 tells the compiler of this target leaves the instruction out.
    if constexpr (sizeof(V) == 64) {
      asm("vpdpwssd %2, %1, %0" : "+v"(sum.raw) : "v"(x.raw), "v"(w.raw));
      return sum;
    }
#endif
#if HWY_ARCH_X86 && HWY_TARGET < HWY_EMU128
    const hn::Repartition<std::int16_t, D> halves;
    V unused = hn::Zero(D());
    return hn::ReorderWidenMulAccumulate(D(), hn::BitCast(halves, x), hn::BitCast(halves, w), sum,
                                         unused);
#else
    const auto low = [](V v) HWY_ATTR { return hn::ShiftRight<16>(hn::ShiftLeft<16>(v)); };
    const auto high = [](V v) HWY_ATTR { return hn::ShiftRight<16>(v); };
    return hn::Add(sum, hn::Add(hn::Mul(low(x), low(w)), hn::Mul(high(x), high(w))));
#endif
  }
}

/// Sums of kRows x kColumns output positions, kVectors vectors of filters each, in registers. A
/// position of the image is kInC values of D's type, a row of it kInW positions.
template <class D, std::size_t kVectors, std::size_t kRows, std::size_t kColumns, Index kInW,
          Index kInC>
struct Positions {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  static constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(D()));
  static constexpr auto kAll = std::make_index_sequence<kRows * kColumns * kVectors>();
  V sum[kRows * kColumns * kVectors];

  HWY_INLINE Positions() {}  // GCC makes one for the baseline alone, which NEON's vectors refuse
  template <std::size_t... I>
  HWY_INLINE void start(const T* bias, std::index_sequence<I...>) {
    ((sum[I] = hn::LoadU(D(), bias + static_cast<Index>(I % kVectors) * kLanes)), ...);
  }
  template <std::size_t... I>
  HWY_INLINE void clear(std::index_sequence<I...>) {
    ((sum[I] = hn::Zero(D())), ...);
  }
  template <std::size_t P>
  HWY_INLINE void add_one(V x, V w0, V w1) {
    sum[P * kVectors] = multiply_add(D(), x, w0, sum[P * kVectors]);
    if constexpr (kVectors == 2) sum[P * 2 + 1] = multiply_add(D(), x, w1, sum[P * 2 + 1]);
  }
  /// One value of each of the first kActive positions of every row times one row of weights.
  template <std::size_t kActive, std::size_t... I>
  HWY_INLINE void add(const T* HWY_RESTRICT x, const T* HWY_RESTRICT w, std::index_sequence<I...>) {
    const V w0 = hn::LoadU(D(), w);
    V w1 = w0;
    if constexpr (kVectors == 2) w1 = hn::LoadU(D(), w + kLanes);
    (add_one<I / kActive * kColumns + I % kActive>(
         hn::Set(
             D(),
             x[(static_cast<Index>(I / kActive) * kInW + static_cast<Index>(I % kActive)) * kInC]),
         w0, w1),
     ...);
  }
  /// `count` values that lie side by side, their weights `step` apart.
  template <std::size_t kActive>
  HWY_INLINE void add_run(const T* HWY_RESTRICT x, const T* HWY_RESTRICT w, Index count,
                          Index step) {
    HWY_UNROLL(2)
    for (Index k = 0; k < count; ++k, ++x, w += step) {
      add<kActive>(x, w, std::make_index_sequence<kRows * kActive>());
    }
  }
  template <std::size_t P>
  HWY_INLINE void add_both(V x, V w0, V w1) {
    constexpr auto kWidth = static_cast<std::size_t>(kInW);
    constexpr std::size_t kRow = P / kWidth * kColumns, kAt = P % kWidth;
    if constexpr (kAt < kColumns) sum[kRow + kAt] = multiply_add(D(), x, w0, sum[kRow + kAt]);
    if constexpr (kAt > 0) sum[kRow + kAt - 1] = multiply_add(D(), x, w1, sum[kRow + kAt - 1]);
  }
  template <std::size_t... P>
  HWY_INLINE void add_row(const T* HWY_RESTRICT x, V w0, V w1, std::index_sequence<P...>) {
    (add_both<P>(hn::Set(D(), x[static_cast<Index>(P) * kInC]), w0, w1), ...);
  }
  /// Both taps of a window's row: of one vector of filters every product needs a value of the
  /// image, and as many loads as products are too many. So each value is loaded once for both.
  HWY_INLINE void add_taps(const T* HWY_RESTRICT x, const T* HWY_RESTRICT w, Index step) {
    HWY_UNROLL(1)
    for (Index k = 0; k < kInC; ++k, ++x, w += step) {
      add_row(x, hn::LoadU(D(), w), hn::LoadU(D(), w + kInC * step),
              std::make_index_sequence<kRows* static_cast<std::size_t>(kInW)>());
    }
  }
  /// Both rows of the window, or the upper one alone.
  template <bool kSame, Index kOutC>
  HWY_INLINE void add_window(const T* image, const T* weights, bool upper_alone) {
    for (Index tap = 0; tap < (upper_alone ? 1 : 2); ++tap) {
      const T* x = image + tap * kInW * kInC;
      const T* w = weights + tap * 2 * kInC * kOutC;
      if constexpr (kVectors == 1) {
        add_taps(x, w, kOutC);
      } else if constexpr (kSame) {
        add_run<kColumns>(x, w, kInC, kOutC);
        add_run<kColumns - 1>(x + kInC, w + kInC * kOutC, kInC, kOutC);
      } else {
        add_run<kColumns>(x, w, 2 * kInC, kOutC);
      }
    }
  }
};

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
