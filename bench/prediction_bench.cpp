// dcnn_bench: one prediction after another through the plan that runs online, in multiply-adds per
// second and as a share of what one thread of the machine can do. Both are the best of many short
// stretches, taken in turns: what other programs take of a shared machine then hardly counts.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "dcnn/nn/peak.h"
#include "experiment/peers/training.h"

namespace dcnn {
namespace {

/// Multiply-adds of `same` padding without those of its zeros, which spec 2.0 counts.
constexpr double kSameProducts = 443592;
constexpr int kTurns = 8, kPredictions = 10;
constexpr double kTurn = 0.02;  // s, without the peak

/// Seconds of one prediction in the best of some stretches; of the next row of a window where it
/// slides.
double best_seconds(Plan& plan, const Tensor& x, bool slides) {
  const auto predict = [&] { return slides ? plan.slide(x.data(), false) : plan.run(x.data()); };
  using Clock = std::chrono::steady_clock;
  double best = 1e9;
  const auto start = Clock::now();
  while (std::chrono::duration<double>(Clock::now() - start).count() < kTurn) {
    const auto begin = Clock::now();
    for (int i = 0; i < kPredictions; ++i) benchmark::DoNotOptimize(predict());
    const std::chrono::duration<double> seconds = Clock::now() - begin;
    best = std::min(best, seconds.count() / kPredictions);
  }
  return best;
}

/// `products`: of one prediction.
void online(benchmark::State& state, const Task& task, double products, bool slides = false) {
  set_threads(1);
  Rng rng(1);
  Plan plan = Network(task.layers, task.input, rng).plan();
  Tensor x(task.input);
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  if (slides) plan.slide(x.data(), true);
  double peak = 0.0, best = 1e9;
  for (auto _ : state) {
    for (int turn = 0; turn < kTurns; ++turn) {
      peak = std::max(peak, peak_multiply_adds());
      best = std::min(best, best_seconds(plan, x, slides));
    }
  }
  set_threads(0);
  state.counters["best_us"] = 1e6 * best;
  state.counters["products/s"] = products / best;
  state.counters["peak"] = peak;
  state.counters["share_of_peak"] = products / best / peak;
}

const Task kValid = dcnn_task("valid"), kSame = dcnn_task("same");
const Task kLstm = lstm_task(1), kLstm25 = lstm_task(25);

BENCHMARK_CAPTURE(online, valid, kValid, kValid.products)->Iterations(1);
BENCHMARK_CAPTURE(online, same, kSame, kSameProducts)->Iterations(1);
BENCHMARK_CAPTURE(online, lstm, kLstm, kLstm.products)->Iterations(1);
BENCHMARK_CAPTURE(online, lstm_25, kLstm25, kLstm25.products)->Iterations(1);
BENCHMARK_CAPTURE(online, lstm_25_slides, kLstm25, kLstm25.products, true)->Iterations(1);

}  // namespace
}  // namespace dcnn
