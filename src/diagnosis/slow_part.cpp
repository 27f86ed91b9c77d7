// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/slow_part.h"

#include <cmath>
#include <map>

#include "core/elementary.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/spectral_lines.h"

namespace dcnn {
namespace {

constexpr double kSlow = 10.0;               // Hz, below which slow noise is looked for
constexpr double kRatio = 1.2;               // from one corner or level that is tried to the next
constexpr double kLeastLevel = 0.1;          // that is tried, of the floor
constexpr std::size_t kFewestSlowBins = 16;  // that tell a form

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

/// A form of slow noise without its level: 1/f^slope, or a Gauss-Markov process of this corner
/// [Hz].
struct Form {
  double corner_hz = 0.0;  ///< 0 for the former
  double slope = 1.0;
  double price() const { return corner_hz > 0.0 || slope != 1.0 ? prior::kSlowNoiseNumber : 0.0; }
};

/// The likeliest level of a form in one channel, none included, and its log-likelihood (Whittle).
struct Leveled {
  SlowPart part;
  double likelihood = -kInfinity;
};

Leveled leveled(const Form& form, const std::vector<Cell>& cells, double floor_level) {
  Leveled best;
  const auto consider = [&](const SlowPart& part) {
    Floor slow;
    part.add_to(slow);
    double likelihood = 0.0;
    for (const Cell& cell : cells) {
      const double density = cell.floor + slow.density(cell.hz);
      likelihood -= cell.count * elementary::log(density) + cell.power / density;
    }
    if (likelihood > best.likelihood) best = {part, likelihood};
  };
  consider({});
  if (form.corner_hz == 0.0) {
    for (double corner = prior::kLeastCorner; corner < prior::kMostCorner; corner *= kRatio) {
      consider({.power = floor_level * elementary::pow(corner, form.slope), .slope = form.slope});
    }
    return best;
  }
  for (double at_rest = kLeastLevel; at_rest < prior::kMostSlowNoise; at_rest *= kRatio) {
    consider({.markov = at_rest * floor_level, .corner_hz = form.corner_hz});
  }
  return best;
}

std::vector<Form> all_forms() {
  constexpr double kSteepest = 1.5;  // the finite power of steeper noise is a drift
  std::vector<Form> forms{{}};
  for (double slope = 0.5; slope <= kSteepest; slope += 0.25) {
    if (slope != 1.0) forms.push_back({.slope = slope});
  }
  for (double hz = prior::kLeastCorner; hz < prior::kMostCorner; hz *= kRatio)
    forms.push_back({hz});
  return forms;
}

}  // namespace

void SlowPart::add_to(Floor& floor) const {
  floor.power += power;
  floor.slope = slope;
  floor.markov += markov;
  floor.corner_hz = corner_hz;
}

std::optional<std::vector<SlowPart>> slow_parts(const Case& study, const Signals& left,
                                                const std::vector<Floor>& floors) {
  const std::vector<Form> forms = all_forms();
  const auto channels = static_cast<std::size_t>(study.channel_count());
  std::vector<Leveled> own(channels);  // each in the form that is likeliest in it
  double apart = 0.0;
  std::vector<std::vector<Leveled>> all(forms.size(), std::vector<Leveled>(channels));
  for (std::size_t j = 0; j < channels; ++j) {
    const std::vector<SlowBin> bins = bins_below_slow(study, left, static_cast<Index>(j));
    if (bins.size() < kFewestSlowBins) return std::nullopt;
    std::vector<Cell> cells = gathered(bins);
    for (Cell& cell : cells) cell.floor = floors[j].density(cell.hz);
    double most = -kInfinity;
    for (std::size_t k = 0; k < forms.size(); ++k) {
      all[k][j] = leveled(forms[k], cells, floors[j].density(kSlow));
      const double likelihood = all[k][j].likelihood - forms[k].price();
      if (likelihood > most) most = likelihood, own[j] = all[k][j];
    }
    apart += most;
  }
  // The channels of a sensor are alike: one form serves all, unless a form of its own for each,
  // which is another choice each, is likelier.
  std::size_t shared = 0;
  double together = -kInfinity;
  for (std::size_t k = 0; k < forms.size(); ++k) {
    double likelihood = -forms[k].price();
    for (const Leveled& channel : all[k]) likelihood += channel.likelihood;
    if (likelihood > together) together = likelihood, shared = k;
  }
  if (together >= apart - prior::kSlowNoiseNumber * (static_cast<double>(channels) - 1.0))
    own = all[shared];
  std::vector<SlowPart> result;
  for (const Leveled& channel : own) result.push_back(channel.part);
  return result;
}

}  // namespace dcnn
