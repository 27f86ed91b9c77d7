// SPDX-License-Identifier: Apache-2.0
#include "check/stalls.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/tails.h"
#include "data/spikes.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr Index kFewestInRun = 8;    // of a run, as of one channel alone
constexpr double kMovesOn = 0.3;     // of the usual speed: a sensor at rest may repeat its values
constexpr double kMostInRuns = 0.5;  // of the log in such runs: what is usual is no exception
constexpr Index kStepsBeside = 8;    // before and after a run

/// Chance that two neighbours are equal, and the longest run, of runs of descending length but for
/// the first ones.
class Usual {
 public:
  explicit Usual(const std::vector<Run>& runs) : runs_(runs) {
    for (const Run& run : runs) add(run, 1.0);
  }
  void leave_out_next() { add(runs_[left_out_++], -1.0); }
  double repeats() const { return equal_ / std::max(rows_, 1.0); }
  double longest() const {
    return left_out_ < runs_.size() ? static_cast<double>(runs_[left_out_].length) : 1.0;
  }

 private:
  void add(const Run& run, double sign) {
    const auto length = static_cast<double>(run.length);
    rows_ += sign * length, equal_ += sign * (length - 1.0);
  }
  const std::vector<Run>& runs_;
  std::size_t left_out_ = 0;
  double rows_ = 0.0, equal_ = 0.0;
};

/// Of each row's step, columns by their rms step; (rows-1).
Eigen::VectorXd relative_steps(const Eigen::MatrixXd& columns) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(columns.rows() - 1);
  for (Index j = 0; j < columns.cols(); ++j) {
    const Eigen::VectorXd steps = steps_of(columns.col(j)).cwiseAbs2();
    if (steps.mean() > 0.0) squares += steps / steps.mean();
  }
  return squares.cwiseSqrt();
}

/// Whether every sensor, of columns (T,k), brings new values in most rows of the run.
bool go_on(const std::vector<Eigen::MatrixXd>& sensors, const Run& run) {
  return !sensors.empty() && std::all_of(sensors.begin(), sensors.end(), [&](const auto& values) {
    const Eigen::MatrixXd here = values.middleRows(run.begin, run.length);
    return 2 * static_cast<Index>(group_runs(here).size()) > run.length;
  });
}

}  // namespace

Stalls stalls_of_sensor(const Log& log, const std::vector<std::string>& columns) {
  const Eigen::MatrixXd values = log.block(columns);
  std::vector<Run> runs = group_runs(values);
  // At rest a sensor may repeat its values for long: that is usual there alone.
  const RelativeSpeed speed(log);
  std::erase_if(runs, [&](const Run& run) {
    return run.length >= kFewestInRun && speed.in(run.begin, run.begin + run.length) < kMovesOn;
  });
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.length > b.length; });
  const auto n = static_cast<double>(log.rows());
  Stalls out;
  Usual usual(runs);
  std::vector<Run> held;
  double rows = 0.0, tried = 0.0;
  std::size_t best = 0;
  for (std::size_t k = 0; k + 1 < runs.size() && runs[k].length >= kFewestInRun; ++k) {
    const Run& run = runs[k];
    usual.leave_out_next();
    rows += static_cast<double>(run.length);
    if (rows > kMostInRuns * n) break;
    const bool lost = (values.row(run.begin).array() == 0.0).all();
    if (lost) continue;
    held.push_back(run);
    ++tried;
    const double q = std::max(usual.repeats(), 1.0 / n);
    const double length = static_cast<double>(run.length) / usual.longest();
    const double p = poisson_tail(static_cast<double>(held.size()),
                                  n * elementary::exp(length * elementary::log(q)));
    if (p < out.p) out.p = p, best = held.size();
  }
  out.p = std::min(1.0, std::max(tried, 1.0) * out.p);
  held.resize(best);
  out.runs = std::move(held);
  return out;
}

Stalls stalls_of_positions(const Log& log, const std::vector<std::string>& names,
                           const std::vector<std::vector<std::string>>& sensor_columns) {
  Stalls out;
  if (names.empty() || log.rows() < 2 * kFewestInRun) return out;
  const Eigen::MatrixXd columns = log.block(names);
  const std::vector<Run> runs = group_runs(columns);
  const Eigen::VectorXd steps = relative_steps(columns);
  std::vector<Eigen::MatrixXd> sensors;
  for (const auto& sensor : sensor_columns) sensors.push_back(log.block(sensor));
  const auto count = static_cast<Index>(runs.size());
  const auto step_before = [&](Index k) {
    return double(steps[runs[static_cast<std::size_t>(k)].begin - 1]);
  };
  double tried = 0.0;
  for (Index k = kStepsBeside; k + kStepsBeside < count; ++k) {
    const Run& run = runs[static_cast<std::size_t>(k)];
    if (run.length < kFewestInRun || !go_on(sensors, run)) continue;
    double beside = 0.0;
    for (Index j = k - kStepsBeside + 1; j <= k + 1 + kStepsBeside && j < count; ++j) {
      if (j != k + 1) beside = std::max(beside, step_before(j));
    }
    ++tried;
    const double z = step_before(k + 1) / beside;
    const double p = std::min(1.0, heavy_tail(z));
    if (p < out.p) out.p = p, out.runs = {run};
  }
  out.p = std::min(1.0, std::max(tried, 1.0) * out.p);
  return out;
}

}  // namespace dcnn::check
