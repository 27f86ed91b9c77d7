// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/channels.h"

#include <algorithm>
#include <numeric>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/channels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Full = hn::ScalableTag<Real>;
using One = hn::CappedTag<Real, 1>;  // what is left of an array, with the same arithmetic
constexpr auto kLanes = static_cast<Index>(hn::MaxLanes(Full()));

/// (rows, C) read as blocks of lcm(C, lanes) values, in which a vector always meets the same
/// channels.
struct Blocks {
  Index period, whole, size;  // values per block, values in whole blocks, all values
  Blocks(Index rows, Index channels)
      : period(std::lcm(channels, kLanes)),
        whole(rows * channels / period * period),
        size(rows * channels) {}
};

/// A value per channel, repeated to fill a block.
class Repeated {
 public:
  Repeated(const Real* values, Index channels, Index period)
      : values_(static_cast<std::size_t>(period)) {
    for (Index i = 0; i < period; i += channels) std::copy_n(values, channels, values_.data() + i);
  }
  template <class D>
  HWY_INLINE hn::Vec<D> at(D d, Index i) const {
    return hn::LoadU(d, values_.data() + i);
  }

 private:
  std::vector<Real> values_;
};

/// map.at(d, i) gives the loop body for channel position i; it is then called for every i +
/// k·period.
template <class Map>
HWY_INLINE void for_blocks(const Blocks& blocks, const Map& map) {
  for (Index v = 0; v < blocks.period; v += kLanes) {
    const auto body = map.at(Full(), v);
    for (Index i = v; i < blocks.whole; i += blocks.period) body(i);
  }
  for (Index i = blocks.whole; i < blocks.size; ++i) map.at(One(), i % blocks.period)(i);
}

/// Sums of kTerms terms, sums[term·channels + c] of what term(d, channel position, i, out) puts
/// into out; four sums per vector and term hide the latency of addition.
template <int kTerms, class Term>
HWY_INLINE void sum_blocks(const Blocks& blocks, Index channels, const Term& term, Real* sums) {
  using V = hn::Vec<Full>;
  const Full d;
  std::fill_n(sums, kTerms * channels, Real(0));
  std::vector<Real> lanes(static_cast<std::size_t>(kLanes));
  for (Index v = 0; v < blocks.period; v += kLanes) {
    V sum[4][kTerms];
    for (auto& part : sum) {
      for (V& s : part) s = hn::Zero(d);
    }
    const auto add = [&](V* part, Index i) HWY_ATTR {
      V values[kTerms];
      term(d, v, i, values);
      for (int k = 0; k < kTerms; ++k) part[k] = hn::Add(part[k], values[k]);
    };
    Index i = v;
    for (; i + 3 * blocks.period < blocks.whole; i += 4 * blocks.period) {
      for (Index part = 0; part < 4; ++part) add(sum[part], i + part * blocks.period);
    }
    for (; i < blocks.whole; i += blocks.period) add(sum[0], i);
    for (int k = 0; k < kTerms; ++k) {
      hn::StoreU(hn::Add(hn::Add(sum[0][k], sum[1][k]), hn::Add(sum[2][k], sum[3][k])), d,
                 lanes.data());
      for (Index lane = 0; lane < kLanes; ++lane) {
        sums[k * channels + (v + lane) % channels] += lanes[static_cast<std::size_t>(lane)];
      }
    }
  }
  for (Index i = blocks.whole; i < blocks.size; ++i) {
    hn::Vec<One> values[kTerms];
    term(One(), i % blocks.period, i, values);
    for (int k = 0; k < kTerms; ++k) sums[k * channels + i % channels] += hn::GetLane(values[k]);
  }
}

void channel_sums_target(const Real* x, Index rows, Index channels, Real* sums) {
  const auto term = [=](auto d, Index, Index i, auto* out) HWY_ATTR { *out = hn::LoadU(d, x + i); };
  sum_blocks<1>(Blocks(rows, channels), channels, term, sums);
}

void channel_deviations_target(const Real* x, const Real* mean, Index rows, Index channels,
                               Real* sums) {
  const Blocks blocks(rows, channels);
  const Repeated means(mean, channels, blocks.period);
  const auto term = [&](auto d, Index v, Index i, auto* out) HWY_ATTR {
    const auto centred = hn::Sub(hn::LoadU(d, x + i), means.at(d, v));
    *out = hn::Mul(centred, centred);
  };
  sum_blocks<1>(blocks, channels, term, sums);
}

template <bool kRelu>
struct Affine {
  const Real* x;
  const Repeated &mean, &scale, &shift;
  Real* y;
  template <class D>
  HWY_INLINE auto at(D d, Index v) const {
    return [this, d, m = mean.at(d, v), a = scale.at(d, v), b = shift.at(d, v)](Index i) HWY_ATTR {
      const auto sum = hn::MulAdd(hn::Sub(hn::LoadU(d, x + i), m), a, b);
      hn::StoreU(kRelu ? hn::Max(sum, hn::Zero(d)) : sum, d, y + i);
    };
  }
};

void channel_affine_target(const Real* x, const Real* mean, const Real* scale, const Real* shift,
                           Index rows, Index channels, bool relu, Real* y) {
  const Blocks blocks(rows, channels);
  const Repeated m(mean, channels, blocks.period), a(scale, channels, blocks.period),
      b(shift, channels, blocks.period);
  if (relu) {
    for_blocks(blocks, Affine<true>{x, m, a, b, y});
  } else {
    for_blocks(blocks, Affine<false>{x, m, a, b, y});
  }
}

/// What arrives before the ReLU.
template <bool kRelu, class D>
HWY_INLINE hn::Vec<D> before_relu(D d, const OutputGradient& gradient, Index i) {
  const auto dy = hn::LoadU(d, gradient.dy + i);
  if constexpr (!kRelu) return dy;
  return hn::IfThenElseZero(hn::Gt(hn::LoadU(d, gradient.y + i), hn::Zero(d)), dy);
}

template <bool kRelu>
void gradient_sums(const OutputGradient& gradient, const Real* x, const Real* mean, Index rows,
                   Index channels, Real* sums) {
  const Blocks blocks(rows, channels);
  const Repeated means(mean, channels, blocks.period);
  const auto term = [&](auto d, Index v, Index i, auto* out) HWY_ATTR {
    out[0] = before_relu<kRelu>(d, gradient, i);
    out[1] = hn::Mul(hn::Sub(hn::LoadU(d, x + i), means.at(d, v)), out[0]);
  };
  sum_blocks<2>(blocks, channels, term, sums);
}

void channel_gradient_sums_target(const OutputGradient& gradient, const Real* x, const Real* mean,
                                  Index rows, Index channels, Real* sums) {
  (gradient.y ? gradient_sums<true> : gradient_sums<false>)(gradient, x, mean, rows, channels,
                                                            sums);
}

template <bool kRelu>
struct Gradient {
  const OutputGradient& gradient;
  const Real* x;
  const Repeated &scale, &mean, &slope, &shift;
  Tensor::GradientSlot slot;
  template <class D>
  HWY_INLINE auto at(D d, Index v) const {
    return [this, d, m = mean.at(d, v), a = scale.at(d, v), b = slope.at(d, v),
            c = shift.at(d, v)](Index i) HWY_ATTR {
      const auto start = slot.add ? hn::Add(c, hn::LoadU(d, slot.data + i)) : c;
      const auto centred = hn::Sub(hn::LoadU(d, x + i), m);
      const auto dy = before_relu<kRelu>(d, gradient, i);
      hn::StoreU(hn::MulAdd(centred, b, hn::MulAdd(dy, a, start)), d, slot.data + i);
    };
  }
};

void channel_gradient_target(const OutputGradient& gradient, const Real* scale, const Real* x,
                             const Real* mean, const Real* slope, const Real* shift, Index rows,
                             Index channels, Tensor::GradientSlot slot) {
  const Blocks blocks(rows, channels);
  const Repeated a(scale, channels, blocks.period), m(mean, channels, blocks.period),
      b(slope, channels, blocks.period), c(shift, channels, blocks.period);
  if (gradient.y) {
    for_blocks(blocks, Gradient<true>{gradient, x, a, m, b, c, slot});
  } else {
    for_blocks(blocks, Gradient<false>{gradient, x, a, m, b, c, slot});
  }
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(channel_sums_target);
HWY_EXPORT(channel_deviations_target);
HWY_EXPORT(channel_affine_target);
HWY_EXPORT(channel_gradient_sums_target);
HWY_EXPORT(channel_gradient_target);

void channel_sums(const Real* x, Index rows, Index channels, Real* sums) {
  HWY_DYNAMIC_DISPATCH(channel_sums_target)(x, rows, channels, sums);
}

void channel_deviations(const Real* x, const Real* mean, Index rows, Index channels, Real* sums) {
  HWY_DYNAMIC_DISPATCH(channel_deviations_target)(x, mean, rows, channels, sums);
}

void channel_affine(const Real* x, const Real* mean, const Real* scale, const Real* shift,
                    Index rows, Index channels, bool relu, Real* y) {
  HWY_DYNAMIC_DISPATCH(channel_affine_target)(x, mean, scale, shift, rows, channels, relu, y);
}

void channel_gradient_sums(const OutputGradient& gradient, const Real* x, const Real* mean,
                           Index rows, Index channels, Real* sums) {
  HWY_DYNAMIC_DISPATCH(channel_gradient_sums_target)(gradient, x, mean, rows, channels, sums);
}

void channel_gradient(const OutputGradient& gradient, const Real* scale, const Real* x,
                      const Real* mean, const Real* slope, const Real* shift, Index rows,
                      Index channels, Tensor::GradientSlot slot) {
  HWY_DYNAMIC_DISPATCH(channel_gradient_target)
  (gradient, scale, x, mean, slope, shift, rows, channels, slot);
}
}  // namespace dcnn
#endif
