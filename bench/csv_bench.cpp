// SPDX-License-Identifier: Apache-2.0
// Reading a recording: MB/s of CSV, samples/s of features.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "dcnn/core/random.h"
#include "dcnn/data/csv.h"
#include "dcnn/data/features.h"

namespace dcnn {
namespace {

/// 500 Hz, a pose on slow sines and noise of a force sensor, eight digits as loggers write them.
Table make_log(Index rows) {
  Table table{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"},
              Eigen::MatrixXd(rows, 10)};
  Rng rng(1);
  for (Index i = 0; i < rows; ++i) {
    const double t = 0.002 * static_cast<double>(i);
    table.values(i, 0) = t;
    for (Index k = 1; k < 10; ++k) {
      const double value =
          0.5 * std::sin((0.1 + 0.05 * static_cast<double>(k)) * t) + 1e-4 * rng.normal();
      table.values(i, k) = std::round(value * 1e8) / 1e8;
    }
  }
  return table;
}

std::filesystem::path log_file(Index rows) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("dcnn_bench_" + std::to_string(::getpid()) + ".csv");
  write_csv(path, make_log(rows));
  return path;
}

void ReadCsv(benchmark::State& state) {
  const auto path = log_file(state.range(0));
  const auto bytes = static_cast<Index>(std::filesystem::file_size(path));
  for (auto _ : state) benchmark::DoNotOptimize(read_csv(path).values.sum());
  state.SetBytesProcessed(state.iterations() * bytes);
  std::filesystem::remove(path);
}
BENCHMARK(ReadCsv)->Arg(10000)->Arg(300000)->Unit(benchmark::kMillisecond);

void WriteCsv(benchmark::State& state) {
  const Table table = make_log(state.range(0));
  const auto path = log_file(10);
  for (auto _ : state) write_csv(path, table);
  state.SetBytesProcessed(state.iterations() *
                          static_cast<Index>(std::filesystem::file_size(path)));
  std::filesystem::remove(path);
}
BENCHMARK(WriteCsv)->Arg(300000)->Unit(benchmark::kMillisecond);

void MakeFeatures(benchmark::State& state, FeatureSpec::Set set) {
  const auto path = log_file(state.range(0));
  const Recording recording = read_recording(path, {}, {});
  FeatureSpec spec;
  spec.set = set;
  const FeatureLayout layout = make_layout({recording}, spec, {});
  for (auto _ : state) benchmark::DoNotOptimize(make_features(recording, layout).x.sum());
  state.SetItemsProcessed(state.iterations() * state.range(0));
  std::filesystem::remove(path);
}
BENCHMARK_CAPTURE(MakeFeatures, pose, FeatureSpec::Set::kPose)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(MakeFeatures, body, FeatureSpec::Set::kBody)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dcnn

BENCHMARK_MAIN();
