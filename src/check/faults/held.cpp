#include <algorithm>

#include "check/kind.h"
#include "check/rows.h"
#include "check/statistics.h"

namespace dcnn::check {
namespace {

constexpr double kFresh = 5.0;  // resolutions that a value jumps when it is new, at least
constexpr double kTwoWays = 0.5;

/// Whether new values come every k rows: p-value of so many runs of one length, were a run's end as
/// likely in any row (geometric lengths with the same mean).
double regularity_p(const std::vector<Run>& runs, double mean, Eigen::Index* length) {
  constexpr Eigen::Index kLongest = 63;  // rows; longer runs stand still and tell of no clock
  std::vector<Eigen::Index> count(kLongest + 1, 0);
  for (const Run& run : runs) {
    if (run.length <= kLongest) ++count[static_cast<std::size_t>(run.length)];
  }
  const auto most = std::max_element(count.begin() + 2, count.end());
  *length = most - count.begin();
  const double end = 1.0 / mean;
  double chance = end;
  for (Eigen::Index k = 1; k < *length; ++k) chance *= 1.0 - end;
  const auto n = static_cast<double>(runs.size());
  const double expected = n * chance, spread = std::sqrt(n * chance * (1.0 - chance));
  return tail(std::max(0.0, (static_cast<double>(*most) - expected) / std::max(spread, 1e-9)));
}

void find_held_group(const Log& log, const std::vector<std::string>& names,
                     std::vector<Fault>& out) {
  const std::vector<Run> runs = group_runs(log.block(names));
  if (runs.size() < 20) return;
  const double mean = static_cast<double>(log.rows()) / static_cast<double>(runs.size());
  if (mean < 1.0 + kTwoWays) return;
  double fresh = 0.0;
  for (const std::string& name : names) {
    const Eigen::VectorXd x = log.column(name);
    Eigen::VectorXd jumps = steps_of(x).cwiseAbs();
    const double grid = resolution(x);
    std::vector<double> moved;
    for (const double jump : jumps) {
      if (jump > 0.0) moved.push_back(jump);
    }
    if (moved.empty() || grid <= 0.0) continue;
    fresh = std::max(fresh, median(Eigen::Map<Eigen::VectorXd>(
                                moved.data(), static_cast<Eigen::Index>(moved.size()))) /
                                grid);
  }
  if (fresh < kFresh) return;
  Eigen::Index length = 0;
  const double p = regularity_p(runs, mean, &length);
  out.push_back(fault_of(held_fault, posterior_of_p(p), names[0],
                         "the values of " + names[0] +
                             (names.size() > 1 ? " and its companions" : "") + " are new every " +
                             std::to_string(length) + " rows only, held in between"));
}

std::vector<Fault> find_held(const Evidence& e) {
  std::vector<Fault> out;
  // Without a clock there is no rate: several rows of one pose at rest are alike by right.
  if (!e.log.smooth || e.log.step <= 0.0) return out;
  for (const auto& names : e.log.sensors()) find_held_group(e.log, names, out);
  const auto positions = e.log.positions();
  if (!positions.empty()) find_held_group(e.log, positions, out);
  if (out.size() > 1) out.resize(1);
  return out;
}

}  // namespace

const FaultKind held_fault{"held", false,
                           "log every source at the rate it has, or keep every k-th row alone", "",
                           find_held};

}  // namespace dcnn::check
