// dcnn_bench: an epoch of training and a single prediction, in multiply-adds per second and as a
// share of what the machine can do.
#include <benchmark/benchmark.h>

#include "bench/training.h"

namespace dcnn {
namespace {

double peak() {
  static const double value = peak_multiply_adds();
  return value;
}

void count_products(benchmark::State& state, double per_iteration) {
  const double total = per_iteration * static_cast<double>(state.iterations());
  state.counters["products/s"] = benchmark::Counter(total, benchmark::Counter::kIsRate);
  state.counters["share_of_peak"] = benchmark::Counter(total / peak(), benchmark::Counter::kIsRate);
}

void epoch(benchmark::State& state, const std::string& padding) {
  Training training(padding);
  for (auto _ : state) training.epoch();
  count_products(state,
                 training_products(padding) * static_cast<double>(kSamples / kBatch * kBatch));
}

void prediction(benchmark::State& state, const std::string& padding) {
  const Training training(padding);
  const Network network = training.network.folded();
  const Tensor x({1, 15, 5, 1});
  const NoGradient guard;
  Pass pass;
  for (auto _ : state) benchmark::DoNotOptimize(network.forward(x, pass).data());
  count_products(state, products(padding));
}

BENCHMARK_CAPTURE(epoch, valid, "valid")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(epoch, same, "same")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(prediction, valid, "valid")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK_CAPTURE(prediction, same, "same")->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace dcnn
