// SPDX-License-Identifier: Apache-2.0
// dcnn_bench: one prediction after another through the plan that runs online, in multiply-adds per
// second and as a share of what one thread of the machine can do. Both are the best of many short
// stretches, taken in turns: what other programs take of a shared machine then hardly counts. The
// floor is the multiply-adds at that peak in single precision; where each row meets all weights of
// an LSTM anew it is reading them, four bytes a product, from the cache that holds them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "dcnn/nn/batch_plan.h"
#include "dcnn/nn/peak.h"
#include "experiment/peers/training.h"

namespace dcnn {
namespace {

/// Multiply-adds of `same` padding without those of its zeros, which a plain count includes.
constexpr double kSameProducts = 443592;
/// Of a row whose window has a state before it.
constexpr double kStepProducts = 15 * 600 + 150 * 600 + 3 * 150;
constexpr int kTurns = 8, kPredictions = 10;
constexpr double kTurn = 0.02;  // s, without the peak

/// What comes in: a sample alone, a window that slides by a row, a row that the state goes on from.
enum class Input { kSample, kSlides, kCarries };

const Real* predict(Plan& plan, const Tensor& x, Input input, bool begins) {
  if (input == Input::kSlides) return plan.slide(x.data(), begins);
  if (input == Input::kCarries) return plan.carry(x.data(), begins);
  return plan.run(x.data());
}

/// Seconds of one prediction in the best of some stretches.
double best_seconds(Plan& plan, const Tensor& x, Input input) {
  using Clock = std::chrono::steady_clock;
  double best = 1e9;
  const auto start = Clock::now();
  while (std::chrono::duration<double>(Clock::now() - start).count() < kTurn) {
    const auto begin = Clock::now();
    for (int i = 0; i < kPredictions; ++i) {
      benchmark::DoNotOptimize(predict(plan, x, input, false));
    }
    const std::chrono::duration<double> seconds = Clock::now() - begin;
    best = std::min(best, seconds.count() / kPredictions);
  }
  return best;
}

constexpr int kLstmKilobytes = 396;  // of its weights

/// `products`: of one prediction.
void online(benchmark::State& state, const Task& task, double products,
            Input input = Input::kSample, Precision precision = Precision::kSingle) {
  const bool streams_weights = task.name.starts_with("lstm") && input != Input::kSlides;
  set_threads(1);
  Rng rng(1);
  Plan plan = Network(task.layers, task.input, rng).plan(precision);
  Tensor x(task.input);
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  predict(plan, x, input, true);
  double peak = 0.0, best = 1e9, read = 0.0;
  for (auto _ : state) {
    for (int turn = 0; turn < kTurns; ++turn) {
      peak = std::max(peak, peak_multiply_adds());
      if (streams_weights) read = std::max(read, peak_read_bytes(kLstmKilobytes));
      best = std::min(best, best_seconds(plan, x, input));
    }
  }
  set_threads(0);
  state.counters["best_us"] = 1e6 * best;
  state.counters["products/s"] = products / best;
  state.counters["peak"] = peak;
  state.counters["share_of_peak"] = products / best / peak;
  double floor = products / peak;
  if (streams_weights) {
    state.counters["read_bytes/s"] = read;
    floor = std::max(floor, 4 * products / read);
  }
  state.counters["over_floor"] = best / floor;
}

const Task kValid = dcnn_task("valid"), kSame = dcnn_task("same");
const Task kLstm = lstm_task(1), kLstm25 = lstm_task(25);

/// n samples a call, on all threads.
void batch(benchmark::State& state, const Task& task, double products) {
  const Index n = state.range(0);
  Rng rng(1);
  const BatchPlan plan(Network(task.layers, task.input, rng));
  Shape shape = task.input;
  shape.insert(shape.begin(), n);
  Tensor x(shape), y({n, 3});
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  double peak = 0.0, best = 1e9;
  using Clock = std::chrono::steady_clock;
  for (auto _ : state) {
    for (int turn = 0; turn < 3 * kTurns; ++turn) {
      peak = std::max(peak, peak_multiply_adds(4));
      const auto begin = Clock::now();
      while (Clock::now() - begin < std::chrono::duration<double>(kTurn)) {
        const auto start = Clock::now();
        plan.run(x.data(), n, y.data());
        best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
      }
    }
  }
  const double rate = products * static_cast<double>(n) / best;
  state.counters["best_us"] = 1e6 * best;
  state.counters["peak"] = peak;
  state.counters["over_floor"] = peak / rate;
}

BENCHMARK_CAPTURE(online, valid, kValid, kValid.products)->Iterations(1);
BENCHMARK_CAPTURE(online, same, kSame, kSameProducts)->Iterations(1);
BENCHMARK_CAPTURE(online, valid_int16, kValid, kValid.products, Input::kSample, Precision::kInt16)
    ->Iterations(1);
BENCHMARK_CAPTURE(online, same_int16, kSame, kSameProducts, Input::kSample, Precision::kInt16)
    ->Iterations(1);
BENCHMARK_CAPTURE(online, lstm, kLstm, kLstm.products)->Iterations(1);
BENCHMARK_CAPTURE(online, lstm_step, kLstm, kStepProducts, Input::kCarries)->Iterations(1);
BENCHMARK_CAPTURE(online, lstm_25, kLstm25, kLstm25.products)->Iterations(1);
BENCHMARK_CAPTURE(online, lstm_25_slides, kLstm25, kLstm25.products, Input::kSlides)->Iterations(1);

BENCHMARK_CAPTURE(batch, valid, kValid, kValid.products)->Arg(10)->Arg(32045)->Iterations(1);
BENCHMARK_CAPTURE(batch, same, kSame, kSameProducts)->Arg(10)->Iterations(1);
BENCHMARK_CAPTURE(batch, lstm_25, kLstm25, kLstm25.products)->Arg(10)->Iterations(1);

}  // namespace
}  // namespace dcnn
