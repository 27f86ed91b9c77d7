// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/slow_part.h"

#include <cmath>
#include <map>

#include "core/elementary.h"
#include "dcnn/data/fourier.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn {
namespace {

constexpr double kSlow = 10.0;               // Hz, below which slow noise is looked for
constexpr double kRatio = 1.2;               // from one corner or level that is tried to the next
constexpr double kLeastLevel = 0.1;          // that is tried, of the floor
constexpr std::size_t kFewestSlowBins = 32;  // that tell a form

/// Squares of the orthonormal cosine transforms of whole segments below kSlow, without their means:
/// one of density S is S times a chi-square of one degree of freedom. (Its lowest ones, of half a
/// period and of one, hold most of a random walk; a tapered periodogram lets nothing of them pass.)
std::vector<SlowBin> bins_below_slow(const Case& study, const Signals& left, Index channel) {
  std::vector<SlowBin> bins;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    for (const Segment& s : study.logs[k].motion.segments) {
      const Index n = s.size();
      if (static_cast<double>(n) * study.dt() < 4.0) continue;
      const Eigen::VectorXd sums = cosine_transform(left[k].col(channel).segment(s.begin, n));
      for (Index i = 1; i < n; ++i) {
        const double hz = static_cast<double>(i) / (2.0 * static_cast<double>(n) * study.dt());
        if (hz > kSlow) break;
        bins.push_back({hz, sums(i) * sums(i) * 2.0 / static_cast<double>(n)});
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

double log_likelihood(const SlowPart& part, const std::vector<Cell>& cells) {
  Floor slow;
  part.add_to(slow);
  double likelihood = 0.0;
  for (const Cell& cell : cells) {
    const double density = cell.floor + slow.density(cell.hz);
    likelihood -= 0.5 * (cell.count * elementary::log(density) + cell.power / density);
  }
  return likelihood;
}

/// The likeliest level of a form beside `part`, none included.
Leveled leveled(const Form& form, const std::vector<Cell>& cells, double floor_level,
                const SlowPart& part = {}) {
  Leveled best{part, log_likelihood(part, cells)};
  const auto consider = [&](const SlowPart& with) {
    const double likelihood = log_likelihood(with, cells);
    if (likelihood > best.likelihood) best = {with, likelihood};
  };
  if (form.corner_hz == 0.0) {
    for (double corner = prior::kLeastCorner; corner < prior::kMostCorner; corner *= kRatio) {
      SlowPart with = part;
      with.power = floor_level * elementary::pow(corner, form.slope), with.slope = form.slope;
      consider(with);
    }
    return best;
  }
  for (double at_rest = kLeastLevel; at_rest < prior::kMostSlowNoise; at_rest *= kRatio) {
    SlowPart with = part;
    with.markov = at_rest * floor_level, with.corner_hz = form.corner_hz;
    consider(with);
  }
  return best;
}

/// Of both kinds, where that is likelier than `own`, of one, by its numbers: a colour that the band
/// above the motion shows too high further down stands in for the one, and hides the other. Each in
/// turn is the likeliest beside the other.
SlowPart of_both_kinds(const Leveled& own, const std::vector<Cell>& cells, double floor_level,
                       const std::vector<Form>& forms) {
  constexpr int kRounds = 3;
  Leveled best = own;
  if (!(own.part.power > 0.0) && !(own.part.markov > 0.0)) return own.part;
  for (int round = 0; round < kRounds; ++round) {
    for (const bool is_markov : {own.part.power > 0.0, own.part.markov > 0.0}) {
      SlowPart other = best.part;
      (is_markov ? other.markov : other.power) = 0.0;
      Leveled now{other, log_likelihood(other, cells)};
      for (const Form& form : forms) {
        if ((form.corner_hz > 0.0) != is_markov) continue;
        const Leveled both = leveled(form, cells, floor_level, other);
        if (both.likelihood > now.likelihood) now = both;
      }
      best = now;
    }
  }
  return best.likelihood - own.likelihood < 2.0 * prior::kSlowNoiseNumber ? own.part : best.part;
}

std::vector<Form> all_forms() {
  constexpr double kSteepest = 2.0;  // a random walk
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
  std::vector<std::vector<Cell>> cells(channels);
  for (std::size_t j = 0; j < channels; ++j) {
    const std::vector<SlowBin> bins = bins_below_slow(study, left, static_cast<Index>(j));
    if (bins.size() < kFewestSlowBins) return std::nullopt;
    cells[j] = gathered(bins);
    for (Cell& cell : cells[j]) cell.floor = floors[j].density(cell.hz);
    double most = -kInfinity;
    for (std::size_t k = 0; k < forms.size(); ++k) {
      all[k][j] = leveled(forms[k], cells[j], floors[j].density(kSlow));
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
  for (std::size_t j = 0; j < channels; ++j) {
    result.push_back(of_both_kinds(own[j], cells[j], floors[j].density(kSlow), forms));
  }
  return result;
}

}  // namespace dcnn
