#include "diagnosis/slow_part.h"

#include <cmath>
#include <map>

#include "core/elementary.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/spectral_lines.h"

namespace dcnn {
namespace {

namespace prior = evidence::prior;

constexpr double kSlow = 10.0;   // Hz, below which slow noise is looked for
constexpr double kCorner = 3.0;  // of the log-likelihood, that a corner must gain as one number
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

/// Bins near one frequency: their number and the sum of their powers.
struct Cell {
  double hz, count, power, floor;
};

std::vector<Cell> gathered(const std::vector<SlowBin>& bins) {
  constexpr double kWidth = 1.1;  // over which no slow noise changes much
  std::map<int, Cell> cells;
  for (const SlowBin& bin : bins) {
    Cell& cell =
        cells[static_cast<int>(std::floor(elementary::log(bin.hz) / elementary::log(kWidth)))];
    cell.hz += bin.hz, ++cell.count, cell.power += bin.power;
  }
  std::vector<Cell> list;
  for (auto& [place, cell] : cells) {
    cell.hz /= cell.count;
    list.push_back(cell);
  }
  return list;
}

}  // namespace

void SlowPart::add_to(Floor& floor) const {
  floor.flicker += flicker;
  floor.markov += markov;
  floor.corner_hz = corner_hz;
}

std::optional<std::vector<SlowPart>> slow_parts(const Case& study, const Signals& left,
                                                const std::vector<Floor>& floors) {
  std::vector<SlowPart> result;
  for (Index j = 0; j < study.channel_count(); ++j) {
    const Floor& floor = floors[static_cast<std::size_t>(j)];
    const std::vector<SlowBin> bins = bins_below_slow(study, left, j);
    if (bins.size() < 16) return std::nullopt;
    std::vector<Cell> cells = gathered(bins);
    const double level = floor.density(kSlow);
    for (Cell& cell : cells) cell.floor = floor.density(cell.hz);
    SlowPart best;
    double most = -1e300;
    const auto consider = [&](const SlowPart& part, double price) {
      Floor slow;
      part.add_to(slow);
      double likelihood = -price;
      for (const Cell& cell : cells) {
        const double density = cell.floor + slow.density(cell.hz);
        likelihood -= cell.count * elementary::log(density) + cell.power / density;
      }
      if (likelihood > most) most = likelihood, best = part;
    };
    consider({}, 0.0);
    for (double corner = prior::kLeastCorner; corner < prior::kMostCorner; corner *= 1.2) {
      consider({.flicker = corner * level}, 0.0);
      for (double at_rest = 0.1 * level; at_rest < prior::kMostSlowNoise * level; at_rest *= 1.2) {
        consider({.markov = at_rest, .corner_hz = corner}, kCorner);
      }
    }
    result.push_back(best);
  }
  return result;
}

}  // namespace dcnn
