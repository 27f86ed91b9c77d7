// SPDX-License-Identifier: Apache-2.0
// A sample through dcnn.h beside the same sample through the C++ call: both are the best of many
// short stretches, taken in turns, so that what other programs take of a shared machine hardly
// counts. `more` is what the C call costs more, as a share.
#include <benchmark/benchmark.h>
#include <dcnn.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dcnn/runtime/open.h"

namespace dcnn {
namespace {

constexpr int kTurns = 200, kSteps = 200;

/// A pose that swings and the weight it shows, at sample k.
OnlineSample sample(int k, double dt) {
  OnlineSample s;
  s.t = k * dt;
  const double half = 0.25 * std::sin(0.5 * s.t);
  s.position = {0.1 * std::sin(s.t), 0.0, 0.3};
  s.quaternion = {std::cos(half), std::sin(half), 0.0, 0.0};
  s.wrench << 0.0, 0.0, -6.9, 0.0, 0.0, 0.0;
  return s;
}

template <class Step>
double stretch(int first, double dt, Step step) {
  using Clock = std::chrono::steady_clock;
  std::array<OnlineSample, kSteps> samples;
  for (int k = 0; k < kSteps; ++k) samples[static_cast<std::size_t>(k)] = sample(first + k, dt);
  const auto begin = Clock::now();
  for (const OnlineSample& s : samples) step(s);
  return std::chrono::duration<double>(Clock::now() - begin).count() / kSteps;
}

void through_c(benchmark::State& state) {
  const std::string file = DCNN_SOURCE_DIR "/data/sample/sim.json";
  OnlineCompensator direct = open_compensator({file, "", ""}, {}, [](const std::string&) {});
  dcnn_tool* handle = dcnn_open(file.c_str(), nullptr, nullptr, nullptr, 0);
  if (!handle) return state.SkipWithError("dcnn_open failed");
  double best_c = 1e9, best_cpp = 1e9;
  for (auto _ : state) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const int first = turn * kSteps;
      best_cpp = std::min(best_cpp, stretch(first, direct.dt(), [&](const OnlineSample& s) {
                            benchmark::DoNotOptimize(&direct.step(s));
                          }));
      double own[6], external[6];
      best_c = std::min(best_c, stretch(first, direct.dt(), [&](const OnlineSample& s) {
                          dcnn_step(handle, s.t, s.position.data(), s.quaternion.data(),
                                    s.wrench.data(), own, external);
                          benchmark::DoNotOptimize(external);
                        }));
    }
  }
  dcnn_close(handle);
  state.counters["c_us"] = 1e6 * best_c;
  state.counters["cpp_us"] = 1e6 * best_cpp;
  state.counters["more"] = best_c / best_cpp - 1.0;
}
BENCHMARK(through_c)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dcnn
