// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "check/kind.h"
#include "check/statistics.h"

namespace dcnn::check {
namespace {

constexpr double kOffTick = 0.2;  // of the median step; what every reader of recordings refuses
constexpr double kToleratedShare = 0.01;

/// The rule by which readers refuse a clock, so it is counted as they count.
std::vector<Fault> find_jitter(const Evidence& e) {
  if (e.log.step <= 0.0 || !e.log.smooth) return {};
  if (e.log.burst > 0) {
    return {fact_of(jitter_fault, "t",
                    "rows are stamped in bursts of " + std::to_string(e.log.burst) +
                        ": t is when they were handed over, not when they were taken")};
  }
  const Eigen::VectorXd steps = steps_of(e.log.t);
  Eigen::Index off = 0;
  for (const double step : steps) {
    const double ticks = step / e.log.step;
    if (ticks < 5.0 && std::abs(ticks - std::max(1.0, std::round(ticks))) > kOffTick) ++off;
  }
  const double share = static_cast<double>(off) / static_cast<double>(steps.size());
  if (share <= kToleratedShare) return {};
  return {fact_of(jitter_fault, "t",
                  std::to_string(std::lround(100.0 * share)) +
                      " % of the steps of t are off by more than 20 % of the median step")};
}

}  // namespace

const FaultKind jitter_fault{"jitter", false, "log on a regular clock, or put the log on one",
                             "--resample", find_jitter};

}  // namespace dcnn::check
