// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr double kCoarse =
    0.4;  // of neighbours that are equal: a step of some 2 deviations of the noise
constexpr double kRounding = 1e-6;      // of a step: values are printed with so many digits
constexpr double kGaussian = 0.288675;  // deviation of a rounding error, in steps: 1/sqrt(12)

std::vector<double> levels_of(const Eigen::VectorXd& x) {
  std::vector<double> levels(x.begin(), x.end());
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

struct Lattice {
  double step = 0.0;
  double p = 1.0;  ///< that levels in any places lie so near to a lattice's
};

/// Of levels whose least distance is a step: the step by least squares, and how near the levels
/// come to multiples of it. Printing rounds them a little off.
Lattice lattice_of(const std::vector<double>& levels) {
  Lattice out;
  if (levels.size() < 3) return out;
  double least = levels.back() - levels.front();
  for (std::size_t k = 1; k < levels.size(); ++k) {
    least = std::min(least, levels[k] - levels[k - 1]);
  }
  double places = 0.0, off = 0.0, sum = 0.0, squares = 0.0;
  std::vector<double> place{0.0};
  for (std::size_t k = 1; k < levels.size(); ++k) {
    place.push_back(places += std::round((levels[k] - levels[k - 1]) / least));
    sum += place[k] * (levels[k] - levels[0]), squares += place[k] * place[k];
  }
  out.step = sum / squares;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    off = std::max(off, std::abs((levels[k] - levels[0]) / out.step - place[k]));
  }
  const double share = std::min(1.0, 2.0 * std::max(off, kRounding));
  out.p = elementary::pow(share, static_cast<int>(levels.size()) - 2);
  return out;
}

/// Step of a channel that repeats its value more often than not and else goes on by one step; 0
/// where it does not. Where neighbours differ by more as a rule the samples are held, not coarse.
double coarse_step(const Eigen::VectorXd& x, double* p) {
  if (repeats(x) < kCoarse) return 0.0;
  const Lattice lattice = lattice_of(levels_of(x));
  const Eigen::VectorXd steps = steps_of(x).cwiseAbs();
  const auto moved = (steps.array() > 0.0).count(),
             by_one = (steps.array() > 0.0 && steps.array() < 1.5 * lattice.step).count();
  *p = lattice.p;
  return 2 * by_one < moved || moved < 3 ? 0.0 : lattice.step;
}

void add_fault(const std::string& name, const Eigen::VectorXd& x, double step, double p,
               const std::string& than, std::vector<Fault>& out) {
  out.push_back(fault_of(quantisation_fault, posterior_of_p(p), name,
                         name + " has steps of " + brief(step) + ", coarser than " + than + ": " +
                             std::to_string(std::lround(100.0 * repeats(x))) +
                             " % of neighbours are equal"));
}

/// Deviation of the force that rounding a column of the pose makes: of weight by an angle, of
/// inertia by a position.
double force_of_rounding(const Evidence& e, const std::string& name, double step) {
  const Adopted& a = e.adopted;
  const bool position = std::find(kPosition.begin(), kPosition.end(), name) != kPosition.end();
  if (!position) {
    const double rad = e.log.has_quaternion() ? 2.0 : a.reading.angle;  // |dq| is half the turn
    return a.fit.mass * kEarthGravity * rad * kGaussian * step;
  }
  const double rate = 1.0 / (e.log.step * a.reading.clock);
  return a.fit.mass * rate * rate * a.rows.second.norm() * a.reading.position * kGaussian * step;
}

/// A pose in steps is a fault where the force shows them above its noise, both smoothed alike.
void find_in_pose(const Evidence& e, std::vector<Fault>& out) {
  const Adopted& a = e.adopted;
  if (!a.compared || a.rows.half == 0 || e.log.step <= 0.0) return;
  double noise = 0.0;
  for (const char* name : {"fx", "fy", "fz"}) {
    noise = std::max(noise, a.reading.force * noise_of(e.log.column(name)));
  }
  noise *= a.rows.value.norm();
  for (const std::string& name : e.log.positions()) {
    const Eigen::VectorXd x = e.log.column(name);
    double p = 1.0;
    const double step = coarse_step(x, &p);
    if (step <= 0.0 || force_of_rounding(e, name, step) < noise) continue;
    add_fault(name, x, step, p, "what the force shows of the pose", out);
  }
}

std::vector<Fault> find_quantisation(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  for (const std::string& name : measured_columns(e.log)) {
    const Eigen::VectorXd x = e.log.column(name);
    double p = 1.0;
    const double step = coarse_step(x, &p);
    if (step > 0.0) add_fault(name, x, step, p, "its noise", out);
  }
  find_in_pose(e, out);
  return out;
}

}  // namespace

const FaultKind quantisation_fault{"quantisation", false,
                                   "log more digits; dcnn-diagnose knows the effect", "",
                                   find_quantisation};

}  // namespace dcnn::check
