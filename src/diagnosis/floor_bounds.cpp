// SPDX-License-Identifier: Apache-2.0
// No noise exceeds what the model leaves.
#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/noise_floor.h"

namespace dcnn {
namespace {

constexpr double kBinsOfOne = 1.5;  // that the window makes of one independent bin

/// The residual's density over the floor's in an octave, and its relative sampling error.
struct Octave {
  double hz, ratio, error;
  /// Below the 0.1 % quantile of a mean of exponential variables (Wilson and Hilferty 1931).
  bool is_below() const {
    constexpr double kDeviations = 3.1;
    const double root = 1.0 - error * error / 9.0 - kDeviations * error / 3.0;
    return root > 0.0 && ratio < root * root * root;
  }
};

/// Octaves below the windows' bins, of whole segments.
std::vector<Octave> slow_octaves(const std::vector<SlowBin>& bins, const Floor& floor) {
  constexpr int kFewest = 3;
  std::vector<Octave> list;
  double to = 0.0;
  for (const SlowBin& bin : bins) to = std::max(to, bin.hz);
  for (; to > 0.0; to /= 2.0) {
    double residual = 0.0, fitted = 0.0;
    int count = 0;
    for (const SlowBin& bin : bins) {
      if (bin.hz <= 0.5 * to || bin.hz > to) continue;
      residual += bin.power, fitted += floor.density(bin.hz), ++count;
    }
    if (count < kFewest) break;
    list.insert(list.begin(), {to * std::sqrt(0.5), residual / std::max(fitted, 1e-300),
                               1.0 / std::sqrt(static_cast<double>(count) / kBinsOfOne)});
  }
  return list;
}

std::vector<Octave> octaves(const Periodograms& p, const Eigen::VectorXd& density,
                            const std::vector<SlowBin>& slow, const Floor& floor) {
  std::vector<Octave> list = slow_octaves(slow, floor);
  // The window takes the mean off the two lowest bins, and the highest has no imaginary part.
  const Index last = p.hz.size() - 1;
  for (Index first = 2; first + 1 < last;) {
    Index end = std::min(last, 2 * first);
    if (2 * end > 2 * last - first) end = last;  // less than half an octave more
    double residual = 0.0, fitted = 0.0;
    for (Index i = first; i < end; ++i) residual += density(i), fitted += floor.density(p.hz(i));
    // Of a mean of medians of exponential variables, one bin in 1.5 independent behind the window.
    const double independent = static_cast<double>((end - first) * p.power.cols()) / kBinsOfOne;
    list.push_back({std::sqrt(p.hz(first) * p.hz(end - 1)), residual / std::max(fitted, 1e-300),
                    1.44 / std::sqrt(std::max(1.0, independent))});
    first = end;
  }
  return list;
}

}  // namespace

bool exceeds(const Floor& floor, const Periodograms& p, const Eigen::VectorXd& density,
             const std::vector<SlowBin>& slow) {
  const auto list = octaves(p, density, slow, floor);
  return std::any_of(list.begin(), list.end(), [](const Octave& o) { return o.is_below(); });
}

void bound_by_residual(const Case& study, const Signals& residual, const Signals& levels,
                       std::vector<Floor>& floors) {
  if (study.is_static()) return;
  const Signals even = evened(study, residual, levels);
  for (std::size_t j = 0; j < floors.size(); ++j) {
    const Periodograms p = periodograms(study, even, static_cast<Index>(j));
    if (p.power.cols() == 0) continue;
    Floor& floor = floors[j];
    const double lowpass = std::exchange(floor.lowpass_hz, 0.0);
    std::vector<std::pair<double, double>> bounds;
    bool bound = false;
    const Eigen::VectorXd density = density_of(p, study.rounding_step > 0.0);
    const auto slow = slow_bins(study, even, static_cast<Index>(j));
    for (const Octave& octave : octaves(p, density, slow, floor)) {
      const bool below = octave.is_below();
      bounds.emplace_back(octave.hz, below ? octave.ratio : 1.0);
      bound = bound || below;
    }
    if (bound) {
      floor.bounds = std::move(bounds);
      const std::string bounded = ", nowhere more than the residual";
      if (!floor.source.ends_with(bounded)) floor.source += bounded;
    }
    floor.lowpass_hz = lowpass;
  }
}

}  // namespace dcnn
