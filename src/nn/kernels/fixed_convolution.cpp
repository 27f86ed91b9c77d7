#include "nn/kernels/fixed_convolution.h"

#include <algorithm>
#include <array>
#include <utility>

// width, channels and filters of the images of DCNN, `same` and `valid`
#define DCNN_FIXED_CONVOLUTIONS(SHAPE) \
  SHAPE(5, 1, 8, true)                 \
  SHAPE(5, 8, 16, true)                \
  SHAPE(5, 16, 32, true)               \
  SHAPE(5, 32, 32, true)               \
  SHAPE(5, 1, 8, false) SHAPE(4, 8, 16, false) SHAPE(3, 16, 32, false) SHAPE(2, 32, 32, false)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/fixed_convolution.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Accumulators that leave registers for the weights and one value of the image.
constexpr std::size_t kMostSums = HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM_A64 ? 24 : 12;

/// Sums of kRows x kColumns output positions, kVectors vectors of filters each, in registers. A
/// position of the image is kInC values, a row of it kInW positions.
template <class D, std::size_t kVectors, std::size_t kRows, std::size_t kColumns, Index kInW,
          Index kInC>
struct Positions {
  using V = hn::Vec<D>;
  static constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(D()));
  V sum[kRows * kColumns * kVectors];

  template <std::size_t... I>
  HWY_INLINE void start(const Real* bias, std::index_sequence<I...>) {
    ((sum[I] = hn::LoadU(D(), bias + static_cast<Index>(I % kVectors) * kLanes)), ...);
  }
  template <std::size_t P>
  HWY_INLINE void add_one(V x, V w0, V w1) {
    sum[P * kVectors] = hn::MulAdd(x, w0, sum[P * kVectors]);
    if constexpr (kVectors == 2) sum[P * 2 + 1] = hn::MulAdd(x, w1, sum[P * 2 + 1]);
  }
  /// One value of each of the first kActive positions of every row times one row of weights.
  template <std::size_t kActive, std::size_t... I>
  HWY_INLINE void add(const Real* HWY_RESTRICT x, const Real* HWY_RESTRICT w,
                      std::index_sequence<I...>) {
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
  HWY_INLINE void add_run(const Real* HWY_RESTRICT x, const Real* HWY_RESTRICT w, Index count,
                          Index step) {
    HWY_UNROLL(2)
    for (Index k = 0; k < count; ++k, ++x, w += step) {
      add<kActive>(x, w, std::make_index_sequence<kRows * kActive>());
    }
  }
  template <std::size_t... I>
  HWY_INLINE void store_positive(Real* y, Index step, std::index_sequence<I...>) const {
    (hn::StoreU(
         hn::Max(sum[I], hn::Zero(D())), D(),
         y + static_cast<Index>(I / kVectors) * step + static_cast<Index>(I % kVectors) * kLanes),
     ...);
  }
};

template <Index kInW, Index kInC, Index kOutC, bool kSame>
struct Fixed {
  static constexpr std::size_t kNative = hn::MaxLanes(hn::ScalableTag<Real>());
  static constexpr std::size_t kFilters = static_cast<std::size_t>(kOutC);
  using D = hn::CappedTag<Real, std::min(kNative, kFilters)>;
  static constexpr std::size_t kLanes = hn::MaxLanes(D());
  static constexpr std::size_t kVectors = kFilters >= 2 * kLanes ? 2 : 1;
  static constexpr Index kOutW = kSame ? kInW : kInW - 1;
  static constexpr auto kColumns = static_cast<std::size_t>(kOutW);
  /// One channel is four products a sum: GCC loads all of an image's values before the first, and
  /// of many rows spills them.
  static constexpr std::size_t kMostRows =
      kInC == 1 ? 2 : std::max<std::size_t>(1, kMostSums / (kVectors * kColumns));

  /// Output rows [row, row + kRows); those at the bottom of a `same` image see no row below.
  template <std::size_t kRows, bool kBottom>
  static void block(const FixedConvolution& c, Index row, Index filter) {
    constexpr auto kAll = std::make_index_sequence<kRows * kColumns * kVectors>();
    Positions<D, kVectors, kRows, kColumns, kInW, kInC> sums;
    sums.start(c.bias + filter, kAll);
    for (Index tap = 0; tap < (kBottom ? 1 : 2); ++tap) {
      const Real* x = c.x + (row + tap) * kInW * kInC;
      const Real* w = c.weights + tap * 2 * kInC * kOutC + filter;
      if constexpr (kSame) {
        sums.template add_run<kColumns>(x, w, kInC, kOutC);
        sums.template add_run<kColumns - 1>(x + kInC, w + kInC * kOutC, kInC, kOutC);
      } else {
        sums.template add_run<kColumns>(x, w, 2 * kInC, kOutC);
      }
    }
    sums.store_positive(c.y + row * kOutW * kOutC + filter, kOutC, kAll);
  }

  /// All rows in blocks of nearly equal height.
  template <std::size_t... R>
  static void rows(const FixedConvolution& c, Index filter, std::index_sequence<R...>) {
    using Function = void (*)(const FixedConvolution&, Index, Index);
    static constexpr std::array<Function, sizeof...(R)> kBlocks{block<R + 1, false>...};
    constexpr auto kMost = static_cast<int>(sizeof...(R));
    const int whole = static_cast<int>(c.in_h) - 1, count = (whole + kMost - 1) / kMost;
    const int height = count > 0 ? whole / count : 0, higher = whole - height * count;
    for (int i = 0, begin = 0; i < count; ++i) {
      const int rows_of_block = height + (i < higher ? 1 : 0);
      kBlocks[static_cast<std::size_t>(rows_of_block - 1)](c, begin, filter);
      begin += rows_of_block;
    }
    if constexpr (kSame) block<1, true>(c, whole, filter);
  }

  static void run(const FixedConvolution& c) {
    for (Index filter = 0; filter < kOutC; filter += static_cast<Index>(kVectors * kLanes)) {
      rows(c, filter, std::make_index_sequence<kMostRows>());
    }
  }
};

void fixed_convolution_target(int kind, const FixedConvolution& c) {
  using Function = void (*)(const FixedConvolution&);
#define DCNN_RUN(width, channels, filters, same) Fixed<width, channels, filters, same>::run,
  static constexpr Function kRuns[] = {DCNN_FIXED_CONVOLUTIONS(DCNN_RUN)};
#undef DCNN_RUN
  kRuns[kind](c);
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(fixed_convolution_target);

int fixed_convolution_kind(const ConvShape& s) {
  struct Kind {
    Index width, channels, filters;
    bool same;
  };
#define DCNN_KIND(width, channels, filters, same) {width, channels, filters, same},
  static constexpr Kind kKinds[] = {DCNN_FIXED_CONVOLUTIONS(DCNN_KIND)};
#undef DCNN_KIND
  if (s.window_h != 2 || s.window_w != 2 || s.before_h != 0 || s.before_w != 0) return -1;
  const auto found = std::ranges::find_if(kKinds, [&](const Kind& k) {
    const Index lost = k.same ? 0 : 1;
    return k.width == s.in_w && k.channels == s.in_c && k.filters == s.out_c &&
           s.out_w == s.in_w - lost && s.out_h == s.in_h - lost;
  });
  return found == std::end(kKinds) ? -1 : static_cast<int>(found - std::begin(kKinds));
}

void fixed_convolution(int kind, const FixedConvolution& convolution) {
  HWY_DYNAMIC_DISPATCH(fixed_convolution_target)(kind, convolution);
}
}  // namespace dcnn
#endif
