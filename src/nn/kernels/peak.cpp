// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/peak.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "dcnn/core/tensor.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nn/kernels/peak.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dcnn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Twelve independent chains: more than latency times units. Returns the multiply-adds done.
double chains(Index steps, Real* sink) {
  const hn::ScalableTag<Real> d;
  constexpr int kChains = 12;
  hn::Vec<decltype(d)> sum[kChains];
  for (int i = 0; i < kChains; ++i) sum[i] = hn::Set(d, static_cast<Real>(i));
  const auto factor = hn::Set(d, sink[0]), term = hn::Set(d, sink[1]);
  for (Index k = 0; k < steps; ++k) {
    sum[0] = hn::MulAdd(sum[0], factor, term);
    sum[1] = hn::MulAdd(sum[1], factor, term);
    sum[2] = hn::MulAdd(sum[2], factor, term);
    sum[3] = hn::MulAdd(sum[3], factor, term);
    sum[4] = hn::MulAdd(sum[4], factor, term);
    sum[5] = hn::MulAdd(sum[5], factor, term);
    sum[6] = hn::MulAdd(sum[6], factor, term);
    sum[7] = hn::MulAdd(sum[7], factor, term);
    sum[8] = hn::MulAdd(sum[8], factor, term);
    sum[9] = hn::MulAdd(sum[9], factor, term);
    sum[10] = hn::MulAdd(sum[10], factor, term);
    sum[11] = hn::MulAdd(sum[11], factor, term);
  }
  auto total = sum[0];
  for (int i = 1; i < kChains; ++i) total = hn::Add(total, sum[i]);
  sink[2] = hn::GetLane(hn::SumOfLanes(d, total));
  return static_cast<double>(steps) * kChains * static_cast<double>(hn::Lanes(d));
}

/// Adds up n values, a multiple of 16 vectors.
void read_all(const Real* x, Index n, Real* sink) {
  const hn::ScalableTag<Real> d;
  const auto lanes = static_cast<Index>(hn::Lanes(d));
  auto a = hn::Zero(d), b = a, c = a, e = a;
  for (Index i = 0; i < n; i += 4 * lanes) {
    a = hn::Add(a, hn::Load(d, x + i));
    b = hn::Add(b, hn::Load(d, x + i + lanes));
    c = hn::Add(c, hn::Load(d, x + i + 2 * lanes));
    e = hn::Add(e, hn::Load(d, x + i + 3 * lanes));
  }
  sink[0] = hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
}

}  // namespace dcnn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dcnn {
HWY_EXPORT(chains);
HWY_EXPORT(read_all);

double peak_read_bytes(int kilobytes, int repetitions) {
  using Clock = std::chrono::steady_clock;
  constexpr int kPasses = 50;
  const Tensor values({Index{256} * kilobytes});  // of four bytes
  Real sink[1] = {};
  double best = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const auto begin = Clock::now();
    for (int k = 0; k < kPasses; ++k) {
      HWY_DYNAMIC_DISPATCH(read_all)(values.data(), values.size(), sink);
    }
    const std::chrono::duration<double> seconds = Clock::now() - begin;
    best = std::max(best, kPasses * 1024.0 * kilobytes / seconds.count());
  }
  return best;
}

double peak_multiply_adds(int repetitions) {
  using Clock = std::chrono::steady_clock;
  const Index count = threads();
  std::vector<double> done(static_cast<std::size_t>(count) * 16);  // apart: no shared cache line
  double best = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const auto begin = Clock::now();
    for_each_piece(count, [&](Index k) {
      Real sink[3] = {Real(0.5), Real(0.25), 0};
      done[static_cast<std::size_t>(k) * 16] = HWY_DYNAMIC_DISPATCH(chains)(1000000, sink);
    });
    const std::chrono::duration<double> seconds = Clock::now() - begin;
    best = std::max(best, done[0] * static_cast<double>(count) / seconds.count());
  }
  return best;
}

}  // namespace dcnn
#endif
