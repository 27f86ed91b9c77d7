// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/tails.h"

namespace dcnn::check {
namespace {

constexpr Eigen::Index kFewestAtLimit = 4;  // rows of a run
constexpr double kJumps = 5.0;              // deviations of the channel's noise, as of dropouts

/// Rows exactly at the largest value, and those at the next level below it. A limit is come to from
/// nearby; a channel that jumps to zero and back was lost.
struct End {
  Eigen::Index at = 0, next = 0, longest = 0, begin = 0;
};

/// Without `lost` runs: those in which all columns of the sensor stand still.
End end_of(const Eigen::VectorXd& x, double grid, double noise, const std::vector<Run>& lost) {
  End end;
  const double most = x.maxCoeff();
  const auto far = [&](Eigen::Index i) {
    return i >= 0 && i < x.size() && std::abs(x[i] - most) > kJumps * noise;
  };
  for (const Run& run : runs_of(x)) {
    if (run.value == 0.0 && far(run.begin - 1) && far(run.begin + run.length)) continue;
    const auto after =
        std::upper_bound(lost.begin(), lost.end(), run.begin,
                         [](Eigen::Index begin, const Run& other) { return begin < other.begin; });
    const bool within =
        after != lost.begin() &&
        run.begin + run.length <= std::prev(after)->begin + std::prev(after)->length;
    if (within) continue;
    if (run.value == most) {
      end.at += run.length;
      if (run.length > end.longest) end.longest = run.length, end.begin = run.begin;
    } else if (run.value >= most - 1.5 * grid) {
      end.next += run.length;
    }
  }
  return end;
}

/// Rows that come together where a channel keeps a value for several, by their runs between its two
/// ends: sum of squares of lengths over the sum. 1 where no value repeats. At zero it may be off.
double rows_of_an_event(const Eigen::VectorXd& x) {
  const double low = x.minCoeff(), high = x.maxCoeff();
  double rows = 0.0, squares = 0.0;
  for (const Run& run : runs_of(x)) {
    if (run.value == low || run.value == high || run.value == 0.0) continue;
    const auto length = static_cast<double>(run.length);
    rows += length;
    squares += length * length;
  }
  return squares / std::max(rows, 1.0);
}

/// Runs in which several columns of a sensor keep their values together.
std::vector<Run> runs_together(const Log& log, const std::vector<std::string>& names) {
  if (names.size() < 2) return {};
  std::vector<Run> runs = group_runs(log.block(names));
  std::erase_if(runs, [](const Run& run) { return run.length < kFewestAtLimit; });
  return runs;
}

void find_saturation_in(const Log& log, const std::string& name, const std::vector<Run>& lost,
                        std::vector<Fault>& out) {
  const Eigen::VectorXd x = log.column(name);
  const double noise = noise_of(x), grid = std::max(resolution(x), 0.3 * noise);
  if (grid <= 0.0) return;
  const double together = rows_of_an_event(x);
  for (const double side : {1.0, -1.0}) {
    const End end = end_of(side * x, grid, std::max(noise, 0.5 * resolution(x)), lost);
    if (end.longest < kFewestAtLimit) continue;
    // Were the end a level like any other, the density at a peak is at most thrice that below,
    // where neighbours within the noise count together.
    const double expected = 3.0 * static_cast<double>(end.next + 1) * resolution(x) / grid;
    const double p = poisson_tail(static_cast<double>(end.at) / together, expected / together);
    if (p >= 1.0) continue;
    Fault fault = fault_of(saturation_fault, posterior_of_p(p), name,
                           name + " stays at its limit of " + brief(side * (side * x).maxCoeff()) +
                               " in " + std::to_string(end.at) + " rows");
    set_interval(log, end.begin, end.begin + end.longest, fault);
    out.push_back(fault);
  }
}

std::vector<Fault> find_saturation(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  for (const auto& names : e.log.sensors()) {
    const std::vector<Run> lost = runs_together(e.log, names);
    for (const std::string& name : names) find_saturation_in(e.log, name, lost, out);
  }
  return out;
}

}  // namespace

const FaultKind saturation_fault{
    "saturation", false, "widen the sensor's range, or move more gently", "", find_saturation};

}  // namespace dcnn::check
