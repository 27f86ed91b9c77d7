#include "experiment/reproduction/timing.h"

#include <sched.h>

#include <algorithm>
#include <chrono>

#include "dcnn/core/parallel.h"
#include "dcnn/experiment/metrics.h"

namespace dcnn {
namespace {

constexpr int kLengths[] = {1, 5, 10};
constexpr Index kWarmUpCalls = 1000;

/// One thread on one core while it lives.
class Pinned {
 public:
  Pinned() : threads_(threads()) {
    set_threads(1);
    ::sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(::sched_getcpu(), &one);
    ::sched_setaffinity(0, sizeof one, &one);  // where it is forbidden, the thread may wander
  }
  ~Pinned() {
    ::sched_setaffinity(0, sizeof before_, &before_);
    set_threads(threads_);
  }
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;

 private:
  int threads_;
  cpu_set_t before_;
};

/// Seconds of every call of one repetition.
std::vector<double> time_once(const Model& model, const Eigen::MatrixXd& x, Index length,
                              const StepSession& session) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> seconds;
  const Index calls = (x.rows() + length - 1) / length;
  double sum = 0;  // the results are used, so that no call can be left out
  const auto call = [&](Index k) {
    const Index first = k * length, rows = std::min(length, x.rows() - first);
    const Stream stream{x.middleRows(first, rows), {{0, rows}}};
    const auto begin = Clock::now();
    const Eigen::MatrixXd forces = model.predict(stream);
    const std::chrono::duration<double> took = Clock::now() - begin;
    sum += forces(0, 0);
    return took.count();
  };
  for (Index k = 0; k < std::min(kWarmUpCalls, calls); ++k) call(k);
  for (Index k = 0; k < calls; ++k) {
    if (k % 256 == 0 && session.stop_wanted && session.stop_wanted()) throw Stopped{};
    seconds.push_back(call(k));
  }
  require(std::isfinite(sum), Exit::kFailure, "timing: a prediction is not finite");
  return seconds;
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

Json time_calls(const Identifier& identifier, const Recording& recording, Index samples,
                int repetitions, const StepSession& session) {
  const Features features = make_features(recording, identifier.layout);
  const Eigen::MatrixXd x = features.x.topRows(std::min(samples, features.x.rows()));
  const Pinned pinned;
  Json rows = Json::array();
  int done = 0;
  for (const int length : kLengths) {
    std::vector<double> means, totals, all;
    for (int r = 0; r < repetitions; ++r) {
      const auto seconds = time_once(*identifier.model, x, length, session);
      means.push_back(spread(seconds).mean);
      totals.push_back(means.back() * static_cast<double>(seconds.size()));
      all.insert(all.end(), seconds.begin(), seconds.end());
      session.progress(++done / (3.0 * repetitions));
    }
    const Spread mean = spread(means), total = spread(totals);
    rows.push_back({{"model", identifier.name},
                    {"length", length},
                    {"calls", (x.rows() + length - 1) / length},
                    {"mean_s", mean.mean},
                    {"std_s", mean.deviation},
                    {"total_s", total.mean},
                    {"total_std_s", total.deviation},
                    {"p50_s", quantile(all, 0.5)},
                    {"p99_s", quantile(all, 0.99)},
                    {"max_s", *std::max_element(all.begin(), all.end())},
                    {"features_included", false}});
  }
  return {{"threads", 1}, {"repetitions", repetitions}, {"rows", rows}};
}

}  // namespace dcnn
