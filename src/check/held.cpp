// SPDX-License-Identifier: Apache-2.0
#include "check/held.h"

#include <algorithm>
#include <cmath>

#include "check/statistics.h"
#include "core/tails.h"

namespace dcnn::check {
namespace {

constexpr double kFresh = 5.0;  // resolutions that a value jumps when it is new, at least
constexpr double kTwoWays = 0.5;
constexpr double kMostRuns = 0.5;       // share of the runs
constexpr std::size_t kFewestNew = 20;  // values, of which regularity is told

/// Whether new values come every k rows: p-value of so many runs of one length, were a run's end as
/// likely in any row (geometric lengths with the same mean). The length is the most frequent one,
/// so all that it might have been are paid for (Bonferroni).
double regularity_p(const std::vector<Run>& runs, double mean, Eigen::Index* length) {
  constexpr Eigen::Index kLongest = 63;  // rows; longer runs stand still and tell of no clock
  constexpr double kLengths = kLongest - 1;
  std::vector<Eigen::Index> count(kLongest + 1, 0);
  for (const Run& run : runs) {
    if (run.length <= kLongest) ++count[static_cast<std::size_t>(run.length)];
  }
  const auto most = std::max_element(count.begin() + 2, count.end());
  *length = most - count.begin();
  const double end = 1.0 / mean;
  double chance = end;
  for (Eigen::Index k = 1; k < *length; ++k) chance *= 1.0 - end;
  const double p =
      binomial_tail(static_cast<double>(*most), static_cast<double>(runs.size()), chance);
  return std::min(1.0, kLengths * p);
}

/// Share of the runs that a clock with new values every `length` rows makes, to within a row where
/// its rate is no whole part of the log's, or where a value repeats.
double share_of_clock(const std::vector<Run>& runs, Eigen::Index length) {
  const auto fits = std::count_if(runs.begin(), runs.end(), [&](const Run& run) {
    return std::abs(run.length - length) <= 1 || run.length % length == 0;
  });
  return static_cast<double>(fits) / static_cast<double>(runs.size());
}

/// Resolutions that the values of a column jump by when they are new, the median.
double freshness(const Eigen::VectorXd& x) {
  const double grid = resolution(x);
  std::vector<double> moved;
  for (const double jump : steps_of(x)) {
    if (jump != 0.0) moved.push_back(std::abs(jump));
  }
  if (moved.empty() || grid <= 0.0) return 0.0;
  return median(
             Eigen::Map<Eigen::VectorXd>(moved.data(), static_cast<Eigen::Index>(moved.size()))) /
         grid;
}

}  // namespace

Held held_of(const Log& log, const std::vector<std::string>& names) {
  const std::vector<Run> runs = group_runs(log.block(names));
  if (runs.size() < kFewestNew) return {};
  const double mean = static_cast<double>(log.rows()) / static_cast<double>(runs.size());
  if (mean < 1.0 + kTwoWays) return {};
  double fresh = 0.0;
  for (const std::string& name : names) fresh = std::max(fresh, freshness(log.column(name)));
  if (fresh < kFresh) return {};
  Held out;
  const double p = regularity_p(runs, mean, &out.length);
  // A limit cycle at rest repeats its runs too, among more that are shorter.
  if (share_of_clock(runs, out.length) >= kMostRuns) out.probability = posterior_of_p(p);
  return out;
}

}  // namespace dcnn::check
