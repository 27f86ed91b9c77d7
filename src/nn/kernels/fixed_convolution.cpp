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
  template <std::size_t P>
  HWY_INLINE void add_both(V x, V w0, V w1) {
    constexpr auto kWidth = static_cast<std::size_t>(kInW);
    constexpr std::size_t kRow = P / kWidth * kColumns, kAt = P % kWidth;
    if constexpr (kAt < kColumns) sum[kRow + kAt] = hn::MulAdd(x, w0, sum[kRow + kAt]);
    if constexpr (kAt > 0) sum[kRow + kAt - 1] = hn::MulAdd(x, w1, sum[kRow + kAt - 1]);
  }
  template <std::size_t... P>
  HWY_INLINE void add_row(const Real* HWY_RESTRICT x, V w0, V w1, std::index_sequence<P...>) {
    (add_both<P>(hn::Set(D(), x[static_cast<Index>(P) * kInC]), w0, w1), ...);
  }
  /// Both taps of a window's row: of one vector of filters every product needs a value of the
  /// image, and as many loads as products are too many. So each value is loaded once for both.
  HWY_INLINE void add_taps(const Real* HWY_RESTRICT x, const Real* HWY_RESTRICT w, Index step) {
    HWY_UNROLL(1)
    for (Index k = 0; k < kInC; ++k, ++x, w += step) {
      add_row(x, hn::LoadU(D(), w), hn::LoadU(D(), w + kInC * step),
              std::make_index_sequence<kRows* static_cast<std::size_t>(kInW)>());
    }
  }
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
  HWY_INLINE void add_linear(const Real* w, Index inputs, Index step, Real* HWY_RESTRICT sums,
                             std::index_sequence<I...>, std::index_sequence<T...>) const {
    V total[] = {hn::LoadU(D(), sums + static_cast<Index>(T) * kLanes)...};
    (add_three<I % kChains, kChains>(
         total, sum[I],
         w + static_cast<Index>(I / kVectors) * step + static_cast<Index>(I % kVectors) * kLanes,
         inputs),
     ...);
    (hn::StoreU(total[T], D(), sums + static_cast<Index>(T) * kLanes), ...);
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
  static constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(D()));
  static constexpr std::size_t kVectors = kOutC >= 2 * kLanes ? 2 : 1;
  static constexpr Index kChains = kMostSums > 12 ? 2 : 1;  // sums of one output of a linear layer
  static constexpr Index kOutW = kSame ? kInW : kInW - 1;
  static constexpr auto kColumns = static_cast<std::size_t>(kOutW);
  /// One channel is four products a sum: GCC loads all of an image's values before the first, and
  /// of many rows spills them.
  static constexpr std::size_t kMostRows =
      kInC == 1 ? 2 : std::max<std::size_t>(1, kMostSums / (kVectors * kColumns));

  /// Output rows [row, row + kRows); those at the bottom of a `same` image see no row below.
  template <std::size_t kRows, bool kBottom>
  static HWY_INLINE void block(const FixedConvolution& c, Index row, Index filter) {
    constexpr auto kAll = std::make_index_sequence<kRows * kColumns * kVectors>();
    Positions<D, kVectors, kRows, kColumns, kInW, kInC> sums;
    sums.start(c.bias + filter, kAll);
    for (Index tap = 0; tap < (kBottom ? 1 : 2); ++tap) {
      const Real* x = c.x + (row + tap) * kInW * kInC;
      const Real* w = c.weights + tap * 2 * kInC * kOutC + filter;
      if constexpr (kVectors == 1) {
        sums.add_taps(x, w, kOutC);
      } else if constexpr (kSame) {
        sums.template add_run<kColumns>(x, w, kInC, kOutC);
        sums.template add_run<kColumns - 1>(x + kInC, w + kInC * kOutC, kInC, kOutC);
      } else {
        sums.template add_run<kColumns>(x, w, 2 * kInC, kOutC);
      }
    }
    const Index at = row * kOutW * kOutC + filter;
    if (c.linear.outputs == 0) return sums.store_positive(c.y + at, kOutC, kAll);
    for (Index o = 0; o < c.linear.outputs; o += FixedLinear::kTogether) {
      sums.template add_linear<kChains>(
          c.linear.weights + o * c.linear.inputs + at, c.linear.inputs, kOutC,
          c.linear.sums + o * kChains * kLanes, kAll, std::make_index_sequence<3 * kChains>());
    }
  }

  /// All rows in blocks of nearly equal height.
  template <std::size_t... R>
  static void rows(const FixedConvolution& c, Index filter, std::index_sequence<R...>) {
    using Function = void (*)(const FixedConvolution&, Index, Index);
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

  static void run(const FixedConvolution& c) {
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
