// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr Eigen::Index kFewestOrdered = 12;
constexpr double kDwells = 0.3;  // of the rms step
constexpr double kGoesOn = 0.5;  // correlation of neighbouring steps: 0 where each leads to a dwell

double normal_density(double log_ratio, const Typical& typical) {
  const double z = (log_ratio - elementary::log(typical.median)) / typical.below;
  return elementary::exp(-0.5 * z * z) / typical.below;
}

/// Of von Neumann's ratio of one channel: that of a motion over that of a list of poses, most of
/// whose channels are in no order; a few go from one end to the other.
double motion_log_odds(double ratio) {
  const double r = elementary::log(std::max(ratio, 1e-9));
  const double listed = (1.0 - kSlowChannels) * normal_density(r, kOrderedRows) +
                        kSlowChannels * normal_density(r, kOrderedSlow);
  return elementary::log(std::max(normal_density(r, kMovingRows), 1e-300) /
                         std::max(listed, 1e-300));
}

/// Correlation of each step with the next one: a motion that pauses goes on for several rows; from
/// a pose at rest to the next it is one step, whatever the rows of each.
double correlation_of(const Eigen::VectorXd& steps) {
  const auto n = steps.size() - 1;
  return steps.head(n).dot(steps.tail(n)) / std::max(steps.squaredNorm(), 1e-300);
}

/// Without a clock, rows are taken as poses at rest. All channels of a motion resemble their
/// neighbours.
std::vector<Fault> find_moving_rows(const Evidence& e) {
  if (e.log.t.size() > 0 || e.log.rows() < kFewestOrdered) return {};
  double log_odds = log_odds_of(kFaultPrior);
  bool moves = false;
  double goes_on = 0.0, columns = 0.0;
  for (const std::string& name : e.log.positions()) {
    const Eigen::VectorXd x = e.log.column(name), steps = steps_of(x);
    if (!varies(x)) continue;
    const double spread = (x.array() - x.mean()).square().sum();
    log_odds += motion_log_odds(steps.squaredNorm() / spread);
    goes_on += correlation_of(steps), ++columns;
    // Dwells with several rows each are at rest most of the time: then steps are noise, or nothing
    // beside those from one pose to the next.
    const double usual = median(steps.cwiseAbs());
    moves = moves || usual > 3.0 * noise_of(x) ||
            usual > kDwells * std::sqrt(steps.squaredNorm() / static_cast<double>(steps.size()));
  }
  if (!moves && goes_on <= kGoesOn * columns) return {};
  return {fault_of(moving_rows_fault, probability_of_log_odds(log_odds), "t",
                   "there is no column t, yet the rows are samples of a motion (neighbours are "
                   "alike): they are no list of poses at rest")};
}

}  // namespace

const FaultKind moving_rows_fault{
    "moving_rows", true, "add a column t in seconds: row number times the sampling interval", "",
    find_moving_rows};

}  // namespace dcnn::check
