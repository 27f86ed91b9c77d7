#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr Eigen::Index kMostShift = 40;

/// Gain of log-likelihood by shifting the force, for shifts -K … K; penalised by their number.
std::vector<Fault> find_delay(const Evidence& e) {
  const Adopted& a = e.adopted;
  if (!a.compared || a.rows.half == 0 || a.fit.mass <= 0.0) return {};
  const Eigen::Index reach = std::min(kMostShift, e.log.rows() / 20);
  const double spread =
      std::sqrt((a.fit.force.rowwise() - a.fit.force.colwise().mean()).squaredNorm() /
                static_cast<double>(3 * a.fit.force.rows()));
  const double floor = kToolError * spread,
               independent = independent_of(
                   fit_rigid(e.log, a.rows, a.motion, a.reading, {0, true}).residual);
  const auto cost = [&](Eigen::Index shift) {
    return 0.5 * independent *
           log_variance(fit_rigid(e.log, a.rows, a.motion, a.reading, {shift, true}).residual,
                        floor);
  };
  const double as_is = cost(0);
  Eigen::Index best = 0;
  double least = as_is;
  for (Eigen::Index shift = -reach; shift <= reach; ++shift) {
    const double here = shift == 0 ? as_is : cost(shift);
    if (here < least) least = here, best = shift;
  }
  if (best == 0) return {};
  const double odds = kFaultPrior / static_cast<double>(2 * reach) *
                      elementary::exp(std::min(as_is - least, 600.0));
  const double seconds = e.log.step * a.reading.clock * static_cast<double>(std::abs(best));
  Fault fault = fault_of(delay_fault, odds / (1.0 + odds), "fx",
                         std::string("the force ") + (best > 0 ? "lags" : "leads") +
                             " the logged motion by " + brief(1e3 * seconds) + " ms");
  if (fault.probability < 0.01) return {};
  return {fault};
}

}  // namespace

const FaultKind delay_fault{
    "delay", false, "log both on one clock; dcnn-diagnose finds the delay to a fraction of a row",
    "", find_delay};

}  // namespace dcnn::check
