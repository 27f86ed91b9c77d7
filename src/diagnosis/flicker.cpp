#include "diagnosis/flicker.h"

#include <cmath>

#include "core/elementary.h"
#include "diagnosis/spectral_lines.h"

namespace dcnn {
namespace {

constexpr double kSlow = 10.0;    // Hz, below which flicker noise is looked for
constexpr double kLargest = 0.7;  // of the floor's deviation: more is no sensor's slow part

/// Periodograms of whole segments below kSlow.
std::vector<SlowBin> bins_below_slow(const Case& study, const Signals& left, Index channel) {
  std::vector<SlowBin> bins;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    for (const Segment& s : study.logs[k].motion.segments) {
      const Index n = s.size();
      if (static_cast<double>(n) * study.dt() < 4.0) continue;
      const Eigen::VectorXd power = hann_power(left[k].col(channel).segment(s.begin, n), n);
      for (Index i = 2; i < power.size(); ++i) {  // the window leaks the mean into the first
        const double hz = static_cast<double>(i) / (static_cast<double>(n) * study.dt());
        if (hz > kSlow) break;
        bins.push_back({hz, power(i)});
      }
    }
  }
  return bins;
}

}  // namespace

std::optional<std::vector<double>> flicker_below(const Case& study, const Signals& left,
                                                 const std::vector<Floor>& floors) {
  std::vector<double> result;
  for (Index j = 0; j < study.channel_count(); ++j) {
    const Floor& floor = floors[static_cast<std::size_t>(j)];
    const std::vector<SlowBin> bins = bins_below_slow(study, left, j);
    if (bins.size() < 16) return std::nullopt;
    const double level = floor.density(kSlow);
    double best = 0.0, most = -1e300;
    for (double flicker = 0.0; flicker < 30.0 * level;
         flicker = std::max(1e-3 * level, 1.15 * flicker)) {
      double likelihood = 0.0;
      for (const SlowBin& bin : bins) {
        const double density = floor.density(bin.hz) + flicker / bin.hz;
        likelihood -= elementary::log(density) + bin.power / density;
      }
      if (likelihood > most) most = likelihood, best = flicker;
    }
    Floor slow;
    slow.flicker = best;
    slow.dt = study.dt();
    if (slow.deviation() > kLargest * floor.deviation()) return std::nullopt;
    result.push_back(best);
  }
  return result;
}

}  // namespace dcnn
