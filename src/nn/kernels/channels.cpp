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

/// sums[c] of term(d, channel position, i); four sums per vector hide the latency of addition.
template <class Term>
HWY_INLINE void sum_blocks(const Blocks& blocks, Index channels, const Term& term, Real* sums) {
  const Full d;
  std::fill_n(sums, channels, Real(0));
  std::vector<Real> lanes(static_cast<std::size_t>(kLanes));
  for (Index v = 0; v < blocks.period; v += kLanes) {
    hn::Vec<Full> sum[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    Index i = v;
    for (; i + 3 * blocks.period < blocks.whole; i += 4 * blocks.period) {
      sum[0] = hn::Add(sum[0], term(d, v, i));
      sum[1] = hn::Add(sum[1], term(d, v, i + blocks.period));
      sum[2] = hn::Add(sum[2], term(d, v, i + 2 * blocks.period));
      sum[3] = hn::Add(sum[3], term(d, v, i + 3 * blocks.period));
    }
    for (; i < blocks.whole; i += blocks.period) sum[0] = hn::Add(sum[0], term(d, v, i));
    hn::StoreU(hn::Add(hn::Add(sum[0], sum[1]), hn::Add(sum[2], sum[3])), d, lanes.data());
    for (Index lane = 0; lane < kLanes; ++lane) {
      sums[(v + lane) % channels] += lanes[static_cast<std::size_t>(lane)];
    }
  }
  for (Index i = blocks.whole; i < blocks.size; ++i) {
    sums[i % channels] += hn::GetLane(term(One(), i % blocks.period, i));
  }
}

void channel_sums_target(const Real* x, Index rows, Index channels, Real* sums) {
  const auto term = [=](auto d, Index, Index i) HWY_ATTR { return hn::LoadU(d, x + i); };
  sum_blocks(Blocks(rows, channels), channels, term, sums);
}

void channel_products_target(const Real* x, const Real* mean, const Real* factor, Index rows,
                             Index channels, Real* sums) {
  const Blocks blocks(rows, channels);
  const Repeated means(mean, channels, blocks.period);
  if (factor) {
    const auto term = [&](auto d, Index v, Index i) HWY_ATTR {
      return hn::Mul(hn::Sub(hn::LoadU(d, x + i), means.at(d, v)), hn::LoadU(d, factor + i));
    };
    sum_blocks(blocks, channels, term, sums);
  } else {
    const auto term = [&](auto d, Index v, Index i) HWY_ATTR {
      const auto centred = hn::Sub(hn::LoadU(d, x + i), means.at(d, v));
      return hn::Mul(centred, centred);
    };
    sum_blocks(blocks, channels, term, sums);
  }
}

struct Affine {
  const Real* x;
  const Repeated &mean, &scale, &shift;
  Real* y;
  template <class D>
  HWY_INLINE auto at(D d, Index v) const {
    return [this, d, m = mean.at(d, v), a = scale.at(d, v), b = shift.at(d, v)](Index i) HWY_ATTR {
      hn::StoreU(hn::MulAdd(hn::Sub(hn::LoadU(d, x + i), m), a, b), d, y + i);
    };
  }
};

void channel_affine_target(const Real* x, const Real* mean, const Real* scale, const Real* shift,
                           Index rows, Index channels, Real* y) {
  const Blocks blocks(rows, channels);
  const Repeated m(mean, channels, blocks.period), a(scale, channels, blocks.period),
      b(shift, channels, blocks.period);
  for_blocks(blocks, Affine{x, m, a, b, y});
}

struct Gradient {
  const Real *dy, *x;
  const Repeated &scale, &mean, &slope, &shift;
  Tensor::GradientSlot slot;
  template <class D>
  HWY_INLINE auto at(D d, Index v) const {
    return [this, d, m = mean.at(d, v), a = scale.at(d, v), b = slope.at(d, v),
            c = shift.at(d, v)](Index i) HWY_ATTR {
      const auto start = slot.add ? hn::Add(c, hn::LoadU(d, slot.data + i)) : c;
      const auto centred = hn::Sub(hn::LoadU(d, x + i), m);
      const auto sum = hn::MulAdd(centred, b, hn::MulAdd(hn::LoadU(d, dy + i), a, start));
      hn::StoreU(sum, d, slot.data + i);
    };
  }
};

void channel_gradient_target(const Real* dy, const Real* scale, const Real* x, const Real* mean,
                             const Real* slope, const Real* shift, Index rows, Index channels,
                             Tensor::GradientSlot slot) {
  const Blocks blocks(rows, channels);
  const Repeated a(scale, channels, blocks.period), m(mean, channels, blocks.period),
      b(slope, channels, blocks.period), c(shift, channels, blocks.period);
  for_blocks(blocks, Gradient{dy, x, a, m, b, c, slot});
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(channel_sums_target);
HWY_EXPORT(channel_products_target);
HWY_EXPORT(channel_affine_target);
HWY_EXPORT(channel_gradient_target);

void channel_sums(const Real* x, Index rows, Index channels, Real* sums) {
  HWY_DYNAMIC_DISPATCH(channel_sums_target)(x, rows, channels, sums);
}

void channel_products(const Real* x, const Real* mean, const Real* factor, Index rows,
                      Index channels, Real* sums) {
  HWY_DYNAMIC_DISPATCH(channel_products_target)(x, mean, factor, rows, channels, sums);
}

void channel_affine(const Real* x, const Real* mean, const Real* scale, const Real* shift,
                    Index rows, Index channels, Real* y) {
  HWY_DYNAMIC_DISPATCH(channel_affine_target)(x, mean, scale, shift, rows, channels, y);
}

void channel_gradient(const Real* dy, const Real* scale, const Real* x, const Real* mean,
                      const Real* slope, const Real* shift, Index rows, Index channels,
                      Tensor::GradientSlot slot) {
  HWY_DYNAMIC_DISPATCH(channel_gradient_target)
  (dy, scale, x, mean, slope, shift, rows, channels, slot);
}
}  // namespace dcnn
#endif
