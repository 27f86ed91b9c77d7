// dcnn_bench: one prediction after another through the plan that runs online, in multiply-adds per
// second and as a share of what one thread of the machine can do. The peak is measured anew before
// each: on a shared machine the shares are those of one moment.
#include <benchmark/benchmark.h>

#include "bench/training.h"

namespace dcnn {
namespace {

/// Multiply-adds of `same` padding without those of its zeros: spec 2.0 counts them.
constexpr double kSameProducts = 443592;

/// `products`: of one prediction.
void online(benchmark::State& state, const Task& task, double products) {
  set_threads(1);
  const double peak = peak_multiply_adds();
  set_threads(0);
  Rng rng(1);
  Plan plan = Network(task.layers, task.input, rng).plan();
  Tensor x(task.input);
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  for (auto _ : state) benchmark::DoNotOptimize(plan.run(x.data()));
  const double total = products * static_cast<double>(state.iterations());
  state.counters["products/s"] = benchmark::Counter(total, benchmark::Counter::kIsRate);
  state.counters["share_of_peak"] = benchmark::Counter(total / peak, benchmark::Counter::kIsRate);
}

const Task kValid = dcnn_task("valid"), kSame = dcnn_task("same");
const Task kLstm = lstm_task(1), kLstm25 = lstm_task(25);

BENCHMARK_CAPTURE(online, valid, kValid, kValid.products)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(online, same, kSame, kSameProducts)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(online, lstm, kLstm, kLstm.products)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(online, lstm_25, kLstm25, kLstm25.products)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dcnn
