// SPDX-License-Identifier: Apache-2.0
// dcnn_bench: an epoch of training and a single prediction, in multiply-adds per second and as a
// share of what the machine can do; an iteration of Levenberg and Marquardt.
#include <benchmark/benchmark.h>

#include "dcnn/nn/peak.h"
#include "experiment/peers/training.h"
#include "models/shallow_residuals.h"

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

void epoch(benchmark::State& state, const Task& task) {
  Training training(task);
  for (auto _ : state) training.epoch();
  count_products(state, task.training_products * static_cast<double>(task.batches() * task.batch));
}

void prediction(benchmark::State& state, const Task& task) {
  const Training training(task);
  const Network network = training.network.folded();
  Shape shape = task.input;
  shape.insert(shape.begin(), 1);
  const Tensor x(shape);
  const NoGradient guard;
  Pass pass;
  for (auto _ : state) benchmark::DoNotOptimize(network.forward(x, pass).data());
  count_products(state, task.products);
}

RowMatrix drawn(Index rows, Index columns, Rng& rng) {
  RowMatrix values(rows, columns);
  for (Index i = 0; i < values.size(); ++i) values.data()[i] = rng.normal();
  return values;
}

/// FFNN-S on the training part (70 %) of the paper's data.
void levenberg_marquardt(benchmark::State& state) {
  constexpr Index kRows = 29210;
  Rng rng(1);
  const ShallowNetwork network({15, {20}, 3});
  const ShallowResiduals errors(network, drawn(kRows, 15, rng), drawn(kRows, 3, rng),
                                Eigen::VectorXd::Ones(3));
  LevenbergMarquardt optimiser(errors, nullptr, {}, network.initial_weights(rng));
  for (auto _ : state) {
    if (!optimiser.iterate()) state.SkipWithError("there is nothing left to improve");
  }
}
BENCHMARK(levenberg_marquardt)->Iterations(20)->Unit(benchmark::kMillisecond)->UseRealTime();

BENCHMARK_CAPTURE(epoch, valid, dcnn_task("valid"))->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(epoch, same, dcnn_task("same"))->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(epoch, lstm, lstm_task(1))->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(epoch, lstm_10, lstm_task(10))->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(epoch, lstm_25, lstm_task(25))->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(prediction, valid, dcnn_task("valid"))
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(prediction, same, dcnn_task("same"))
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(prediction, lstm_25, lstm_task(25))->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace dcnn
