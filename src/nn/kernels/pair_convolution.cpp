// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/pair_convolution.h"

#include <cmath>
#include <limits>

#include "nn/kernels/fixed_shapes.h"

// One instruction of AVX-512 VNNI multiplies both numbers of a pair and adds: twice the products of
// floats. Only here, so only here compiled for it.
#ifdef DCNN_WITH_VNNI
#define HWY_WANT_AVX3_DL
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3)
#endif

// width, pairs of channels and filters of the images of DCNN, `same` and `valid`
#define DCNN_PAIR_CONVOLUTIONS(SHAPE) \
  SHAPE(5, 4, 16, true)               \
  SHAPE(5, 8, 32, true)               \
  SHAPE(5, 16, 32, true)              \
  SHAPE(4, 4, 16, false) SHAPE(3, 8, 32, false) SHAPE(2, 16, 32, false)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/pair_convolution.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "nn/kernels/fixed-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
#ifndef DCNN_DOUBLE

using Native = hn::ScalableTag<float>;

/// n is at least kBlock: the last block overlaps the one before it.
constexpr auto kLanesOf = static_cast<Index>(hn::MaxLanes(Native()));
constexpr Index kBlock = 2 * kLanesOf;

float largest_magnitude(const float* x, Index n) {
  const Native d;
  auto a = hn::Zero(d), b = a;
  const auto take = [&](Index i) HWY_ATTR {
    a = hn::Max(a, hn::Abs(hn::LoadU(d, x + i)));
    b = hn::Max(b, hn::Abs(hn::LoadU(d, x + i + kLanesOf)));
  };
  for (Index i = 0; i + kBlock < n; i += kBlock) take(i);
  take(n - kBlock);
  return hn::GetLane(hn::MaxOfLanes(d, hn::Max(a, b)));
}

void round_scaled(const float* x, Index n, float scale, std::int32_t* pairs) {
  const Native d;
  auto* to = reinterpret_cast<std::int16_t*>(pairs);
  const hn::Rebind<std::int16_t, Native> half;
  const auto factor = hn::Set(d, scale);
  const auto put = [&](Index i) HWY_ATTR {
    hn::StoreU(hn::DemoteTo(half, hn::NearestInt(hn::Mul(factor, hn::LoadU(d, x + i)))), half,
               to + i);
  };
  for (Index i = 0; i + kLanesOf < n; i += kLanesOf) put(i);
  put(n - kLanesOf);
}

void pair_convolution_target(int kind, const FixedConvolution<std::int32_t>& c) {
  using Function = void (*)(const FixedConvolution<std::int32_t>&);
#define DCNN_RUN(width, pairs, filters, same) Fixed<std::int32_t, width, pairs, filters, same>::run,
  static constexpr Function kRuns[] = {DCNN_PAIR_CONVOLUTIONS(DCNN_RUN)};
#undef DCNN_RUN
  kRuns[kind](c);
}

#endif
}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
namespace {

constexpr double kMostSum = 2147483647.0, kMostWeight = 32767.0;
constexpr Real kLeast = Real(1e-30);  // of an image's largest value: its scale is finite

}  // namespace

#ifdef DCNN_DOUBLE  // there is no single precision to be faster than

std::unique_ptr<PairConvolution> PairConvolution::make(const ConvShape&, const Tensor&) {
  return nullptr;
}
bool PairConvolution::run(const Real*, const Real*, const FixedLinear&, Real*) noexcept {
  return false;
}

#else

HWY_EXPORT(largest_magnitude);
HWY_EXPORT(round_scaled);
HWY_EXPORT(pair_convolution_target);

std::unique_ptr<PairConvolution> PairConvolution::make(const ConvShape& shape,
                                                       const Tensor& weights) {
#define DCNN_KIND(width, pairs, filters, same) {width, 2 * pairs, filters, same},
  static constexpr FixedShape kShapes[] = {DCNN_PAIR_CONVOLUTIONS(DCNN_KIND)};
#undef DCNN_KIND
  const int kind = find_fixed(kShapes, shape);
  if (kind < 0) return nullptr;
  return std::unique_ptr<PairConvolution>(new PairConvolution(kind, shape, weights));
}

bool PairConvolution::run(const Real* x, const Real* bias, const FixedLinear& linear,
                          Real* y) noexcept {
  const Real largest = HWY_DYNAMIC_DISPATCH(largest_magnitude)(x, cells_);
  if (!(largest <= std::numeric_limits<Real>::max())) return false;
  const Real full = std::max(largest, kLeast);
  HWY_DYNAMIC_DISPATCH(round_scaled)(x, cells_, most_ / full, x_.data());
  HWY_DYNAMIC_DISPATCH(pair_convolution_target)
  (kind_, {x_.data(), weights_.data(), bias, y, in_h_, linear, units_.data(), full / most_});
  return true;
}

#endif

/// `most` is where both roundings, of image and weights, weigh the same.
PairConvolution::PairConvolution(int kind, const ConvShape& shape, const Tensor& weights)
    : kind_(kind),
      in_h_(shape.in_h),
      cells_(shape.in_size()),
      products_(shape.weight_size() / shape.out_c),
      most_(std::floor(std::sqrt(static_cast<Real>(kMostSum / static_cast<double>(products_))))),
      weights_(static_cast<std::size_t>(shape.weight_size() / 2)),
      x_(static_cast<std::size_t>(cells_ / 2)) {
  const double sum_limit = std::floor(kMostSum / static_cast<double>(most_)) -
                           0.5 * static_cast<double>(products_);  // rounding adds a half each
  for (Index f = 0; f < shape.out_c; ++f) {
    double sum = 0.0, largest = 0.0;
    for (Index k = 0; k < products_; ++k) {
      const double w = std::abs(static_cast<double>(weights.data()[k * shape.out_c + f]));
      sum += w;
      largest = std::max(largest, w);
    }
    const double scale = sum > 0.0 ? std::min({sum_limit / sum, kMostWeight / largest, 1e30}) : 1.0;
    const auto rounded = [&](Index k) {
      return static_cast<std::uint16_t>(
          std::lrint(scale * static_cast<double>(weights.data()[k * shape.out_c + f])));
    };
    for (Index k = 0; k < products_; k += 2) {
      const std::uint32_t pair = rounded(k) | static_cast<std::uint32_t>(rounded(k + 1)) << 16;
      weights_[static_cast<std::size_t>(k / 2 * shape.out_c + f)] = static_cast<std::int32_t>(pair);
    }
    units_.push_back(static_cast<Real>(1.0 / scale));
    magnitudes_.push_back(sum);
  }
}

double PairConvolution::bound(Index filter, double largest) const {
  const auto f = static_cast<std::size_t>(filter);
  largest = std::max(largest, static_cast<double>(kLeast));
  const double x_error = 0.5 * largest / static_cast<double>(most_);
  const double w_error = 0.5 * static_cast<double>(units_[f]);
  return x_error * magnitudes_[f] + static_cast<double>(products_) * w_error * (largest + x_error);
}

}  // namespace dcnn
#endif
