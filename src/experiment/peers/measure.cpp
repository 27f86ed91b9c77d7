// SPDX-License-Identifier: Apache-2.0
#include "experiment/peers/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "dcnn/nn/peak.h"

namespace dcnn {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kStretch = 0.001;   // s: long against the clock, short against a neighbour's visit
constexpr double kSingle = 0.05;     // s of single calls
constexpr double kRowSeconds = 6.0;  // s: rows of slow calls have fewer rounds
constexpr int kFewestRounds = 3;
constexpr Index kOverheadCalls = 100;
constexpr Index kMostSingle = 20000, kFewestSingle = 10;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Threads that others' calls left spinning go to sleep within milliseconds.
void settle(int threads) {
  if (threads > 1) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// As many calls as fill a stretch; the least of three, since a neighbour's visit would fill one.
Index stretch_calls(Contestant& contestant, double& seconds) {
  for (Index calls = 1;; calls *= 2) {
    seconds = std::min({contestant.run(calls), contestant.run(calls), contestant.run(calls)});
    if (seconds >= kStretch || calls > (Index{1} << 24)) return calls;
  }
}

Index single_count(double seconds) {
  return std::clamp(static_cast<Index>(kSingle / seconds), kFewestSingle, kMostSingle);
}

/// p99 over p50 of a loop that needs nothing but the processor and takes so long.
double loop_tail(double seconds) {
  volatile double sink = 1.0;
  const auto loop = [&](Index steps) {
    const auto begin = Clock::now();
    double x = sink;
    for (Index k = 0; k < steps; ++k) x = 0.999 * x + 0.001;
    sink = x;
    return seconds_since(begin);
  };
  constexpr Index kTrial = 100000;
  const double step = std::min({loop(kTrial), loop(kTrial), loop(kTrial)}) / kTrial;
  const auto steps = static_cast<Index>(seconds / step);
  std::vector<double> times(static_cast<std::size_t>(single_count(seconds)));
  for (double& time : times) time = loop(steps);
  std::ranges::sort(times);
  return quantile(times, 0.99) / quantile(times, 0.5);
}

void single_calls(Contestant& contestant, CallTimes& times) {
  std::vector<double> seconds = contestant.each(single_count(times.median));
  std::ranges::sort(seconds);
  times.p50 = quantile(seconds, 0.5);
  times.p99 = quantile(seconds, 0.99);
  times.maximum = seconds.back();
}

}  // namespace

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

Ours::Ours(const PeerCase& what, const Tensor& samples, Index batch, int threads)
    : samples_(samples),
      y_({batch, element_count(what.network.shapes().back())}),
      plan_(what.network.plan()),
      batch_plan_(what.network),
      batch_(batch),
      cells_(samples.size() / samples.dim(0)),
      calls_(std::min<Index>(kMostDistinctCalls, samples.dim(0) / batch)),
      threads_(threads),
      succession_(what.succession) {}

const Real* Ours::call(Index k) {
  const Real* x = samples_.data() + k % calls_ * batch_ * cells_;
  if (succession_ == Succession::kSlides) return plan_.slide(x, k % calls_ == 0);
  if (succession_ == Succession::kCarries) return plan_.carry(x, k % calls_ == 0);
  if (batch_ == 1) return plan_.run(x);
  batch_plan_.run(x, batch_, y_.data());
  return y_.data();
}

std::vector<double> Ours::outputs(Index count) {
  set_threads(threads_);
  std::vector<double> values;
  for (Index first = 0; first < count; first += batch_) {
    const Real* y = call(first / batch_);
    values.insert(values.end(), y, y + std::min(batch_, count - first) * y_.dim(1));
  }
  return values;
}

double Ours::run(Index calls) {
  set_threads(threads_);
  const auto begin = Clock::now();
  for (Index k = 0; k < calls; ++k) call(k);
  return seconds_since(begin);
}

std::vector<double> Ours::each(Index calls) {
  set_threads(threads_);
  std::vector<double> seconds;
  seconds.reserve(static_cast<std::size_t>(calls));
  for (Index k = 0; k < calls; ++k) {
    const auto begin = Clock::now();
    call(k);
    seconds.push_back(seconds_since(begin));
  }
  return seconds;
}

double Theirs::run(Index calls) {
  return child_.ask("run " + std::to_string(calls))["seconds"].get<double>();
}

std::vector<double> Theirs::each(Index calls) {
  return child_.ask("each " + std::to_string(calls))["seconds"].get<std::vector<double>>();
}

double Theirs::overhead(Index calls) {
  if (!hosted_) return 0.0;
  return child_.ask("overhead " + std::to_string(calls))["seconds"].get<double>();
}

Measured measure(const std::vector<Contestant*>& contestants, int rounds, int threads) {
  const std::size_t count = contestants.size();
  Measured result;
  result.contestants.resize(count);
  std::vector<Index> calls(count);
  double round_seconds = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    double seconds = 0.0;
    calls[i] = stretch_calls(*contestants[i], seconds);
    round_seconds += seconds;
    settle(threads);
  }
  rounds = std::clamp(static_cast<int>(kRowSeconds / round_seconds),
                      std::min(rounds, kFewestRounds), rounds);
  set_threads(threads);
  for (int round = 0; round < rounds; ++round) {
    result.peak = std::max(result.peak, peak_multiply_adds(1));
    for (std::size_t i = 0; i < count; ++i) {
      Turns& turns = result.contestants[i];
      settle(threads);
      const double overhead = contestants[i]->overhead(kOverheadCalls) / kOverheadCalls;
      const double call = contestants[i]->run(calls[i]) / static_cast<double>(calls[i]);
      turns.overhead.push_back(overhead);
      turns.calls.push_back(call);
      turns.net.push_back(std::max(0.0, call - overhead));
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    Turns& turns = result.contestants[i];
    turns.times.median = median_of(turns.calls);
    turns.times.least = *std::ranges::min_element(turns.calls);
    settle(threads);
    single_calls(*contestants[i], turns.times);
    if (i == 0) result.loop_tail = loop_tail(turns.times.p50);
  }
  return result;
}

}  // namespace dcnn
