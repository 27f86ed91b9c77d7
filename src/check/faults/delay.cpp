#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr Eigen::Index kMostShift = 40;
/// Speeds [m/s] over which dry friction changes its sign: about what the window makes of any, and a
/// sharp one.
constexpr double kFrictionSpeeds[] = {0.02, 0.005};

/// Gain of log-likelihood by shifting the force, for shifts -K … K; penalised by their number.
std::vector<Fault> find_delay(const Evidence& e) {
  const Adopted& a = e.adopted;
  if (!a.compared || a.rows.half == 0 || a.fit.mass <= 0.0) return {};
  const Eigen::Index reach = std::min(kMostShift, e.log.rows() / 20);
  const double spread =
      std::sqrt((a.fit.force.rowwise() - a.fit.force.colwise().mean()).squaredNorm() /
                static_cast<double>(3 * a.fit.force.rows()));
  std::vector<Eigen::MatrixXd> frictions;
  for (const double speed : kFrictionSpeeds) {
    if (!a.motion.has_position) break;
    frictions.push_back(smoothed_friction(e.log, a.rows, a.reading, speed));
  }
  if (frictions.empty()) frictions.emplace_back();
  const auto residual = [&](Eigen::Index shift, const Eigen::MatrixXd& friction) {
    const FitOptions options{shift, true, friction.size() > 0 ? &friction : nullptr};
    return fit_rigid(e.log, a.rows, a.motion, a.reading, options).residual;
  };
  const double floor = kToolError * spread;
  const auto cost = [&](Eigen::Index shift, const Eigen::MatrixXd& friction) {
    return 0.5 * log_variance(residual(shift, friction), floor);
  };
  // Each hypothesis with the friction that suits it best.
  const auto least_cost = [&](Eigen::Index shift) {
    double least = cost(shift, frictions[0]);
    for (std::size_t k = 1; k < frictions.size(); ++k) {
      least = std::min(least, cost(shift, frictions[k]));
    }
    return least;
  };
  Eigen::Index best = 0;
  double least = cost(0, frictions[0]);
  for (Eigen::Index shift = -reach; shift <= reach; ++shift) {
    const double here = cost(shift, frictions[0]);
    if (here < least) least = here, best = shift;
  }
  if (best == 0) return {};
  // A delay leaves a residual that is alike for long; how many are independent the better one
  // tells.
  const double independent = independent_of(residual(best, frictions[0]));
  const double gain = independent * (least_cost(0) - least_cost(best));
  const double odds =
      kFaultPrior / static_cast<double>(2 * reach) * elementary::exp(std::min(gain, 600.0));
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
