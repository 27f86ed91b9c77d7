#include "check/stalls.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr Index kFewestInRun = 8;    // of a run, as of one channel alone
constexpr double kMovesOn = 0.3;     // of the usual speed: a sensor at rest may repeat its values
constexpr double kMostInRuns = 0.5;  // of the log in such runs: what is usual is no exception
constexpr Index kStepsBeside = 8;    // before and after a run

/// Chance that two neighbours are equal, and the longest run, of all but the `count` first runs.
struct Usual {
  double repeats = 0.0, longest = 1.0;
};

Usual usual_of(const std::vector<Run>& runs, std::size_t count) {
  Usual usual;
  double rows = 0.0, equal = 0.0;
  for (std::size_t k = count; k < runs.size(); ++k) {
    const auto length = static_cast<double>(runs[k].length);
    rows += length, equal += length - 1.0;
    usual.longest = std::max(usual.longest, length);
  }
  usual.repeats = equal / std::max(rows, 1.0);
  return usual;
}

/// Of each row's step, columns by their rms step; (rows-1).
Eigen::VectorXd relative_steps(const Eigen::MatrixXd& columns) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(columns.rows() - 1);
  for (Index j = 0; j < columns.cols(); ++j) {
    const Eigen::VectorXd steps = steps_of(columns.col(j)).cwiseAbs2();
    if (steps.mean() > 0.0) squares += steps / steps.mean();
  }
  return squares.cwiseSqrt();
}

/// Whether every sensor brings new values in most rows of the run.
bool sensors_go_on(const Log& log, const Run& run) {
  const auto sensors = log.sensors();
  return !sensors.empty() && std::all_of(sensors.begin(), sensors.end(), [&](const auto& names) {
    const Eigen::MatrixXd values = log.block(names).middleRows(run.begin, run.length);
    return 2 * static_cast<Index>(group_runs(values).size()) > run.length;
  });
}

}  // namespace

Stalls stalls_of_sensor(const Log& log, const std::vector<std::string>& columns) {
  const Eigen::MatrixXd values = log.block(columns);
  std::vector<Run> runs = group_runs(values);
  // At rest a sensor may repeat its values for long: that is usual there alone.
  std::erase_if(runs, [&](const Run& run) {
    return run.length >= kFewestInRun &&
           relative_motion(log, run.begin, run.begin + run.length) < kMovesOn;
  });
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.length > b.length; });
  const auto n = static_cast<double>(log.rows());
  Stalls out;
  std::vector<Run> held;
  double rows = 0.0, tried = 0.0;
  std::size_t best = 0;
  for (std::size_t k = 0; k + 1 < runs.size() && runs[k].length >= kFewestInRun; ++k) {
    const Run& run = runs[k];
    rows += static_cast<double>(run.length);
    if (rows > kMostInRuns * n) break;
    const bool lost = (values.row(run.begin).array() == 0.0).all();
    if (lost) continue;
    held.push_back(run);
    ++tried;
    const Usual usual = usual_of(runs, k + 1);
    const double q = std::max(usual.repeats, 1.0 / n);
    const double length = static_cast<double>(run.length) / usual.longest;
    const double p = poisson_tail(static_cast<double>(held.size()),
                                  n * elementary::exp(length * elementary::log(q)));
    if (p < out.p) out.p = p, best = held.size();
  }
  out.p = std::min(1.0, std::max(tried, 1.0) * out.p);
  held.resize(best);
  out.runs = std::move(held);
  return out;
}

Stalls stalls_of_pose(const Log& log) {
  Stalls out;
  const std::vector<std::string> names = log.positions();
  if (names.empty() || log.rows() < 2 * kFewestInRun) return out;
  const Eigen::MatrixXd columns = log.block(names);
  const std::vector<Run> runs = group_runs(columns);
  const Eigen::VectorXd steps = relative_steps(columns);
  const auto count = static_cast<Index>(runs.size());
  const auto step_before = [&](Index k) {
    return double(steps[runs[static_cast<std::size_t>(k)].begin - 1]);
  };
  double tried = 0.0;
  for (Index k = kStepsBeside; k + kStepsBeside < count; ++k) {
    const Run& run = runs[static_cast<std::size_t>(k)];
    if (run.length < kFewestInRun || !sensors_go_on(log, run)) continue;
    double beside = 0.0;
    for (Index j = k - kStepsBeside + 1; j <= k + 1 + kStepsBeside && j < count; ++j) {
      if (j != k + 1) beside = std::max(beside, step_before(j));
    }
    ++tried;
    const double z = step_before(k + 1) / beside;
    const double p = std::min(1.0, 19.0 / elementary::pow(z, 5));
    if (p < out.p) out.p = p, out.runs = {run};
  }
  out.p = std::min(1.0, std::max(tried, 1.0) * out.p);
  return out;
}

}  // namespace dcnn::check
