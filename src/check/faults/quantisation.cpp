#include <algorithm>
#include <cmath>

#include "check/rows.h"

namespace dcnn::check {
namespace {

constexpr double kCoarse =
    0.4;  // of neighbours that are equal: a step of some 2 deviations of the noise
constexpr double kOnLattice = 1e-6;

bool on_lattice(const Eigen::VectorXd& x, double step) {
  for (const double value : x) {
    const double places = (value - x[0]) / step;
    if (std::abs(places - std::round(places)) > kOnLattice * (1.0 + std::abs(places))) return false;
  }
  return true;
}

std::vector<Fault> find_quantisation(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  for (const std::string& name : measured_columns(e.log)) {
    const Eigen::VectorXd x = e.log.column(name);
    const double step = resolution(x), share = repeats(x);
    if (step <= 0.0 || share < kCoarse || !on_lattice(x, step)) continue;
    // Neighbours that differ do so by one step as a rule: else the samples are held, not coarse.
    const Eigen::VectorXd steps = steps_of(x).cwiseAbs();
    const auto moved = (steps.array() > 0.0).count(),
               by_one = (steps.array() > 0.0 && steps.array() < 1.5 * step).count();
    if (2 * by_one < moved || moved < 3) continue;
    out.push_back(fault_of(quantisation_fault, 1.0, name,
                           name + " has steps of " + brief(step) + ", coarser than its noise: " +
                               std::to_string(std::lround(100.0 * share)) +
                               " % of neighbours are equal"));
  }
  return out;
}

}  // namespace

const FaultKind quantisation_fault{"quantisation", false,
                                   "log more digits; dcnn-diagnose knows the effect", "",
                                   find_quantisation};

}  // namespace dcnn::check
