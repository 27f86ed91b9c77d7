// SPDX-License-Identifier: Apache-2.0
#include "discovery/mutate.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "dcnn/core/parallel.h"
#include "discovery/own_directions.h"
#include "discovery/priors.h"

namespace dcnn::discovery {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kMostPieces = 3, kParents = 3, kModulators = 5;
constexpr int kRounds = 3;
constexpr int kFirstSteps = 2, kNextSteps = 3, kLastSteps = 15;
constexpr std::size_t kFewestNext = 8, kNextShare = 3;  // of the trials, one in so many
constexpr double kLeastProduct = 0.01;  // of factors, somewhere: else the amplitude is no size
constexpr double kLeastExtra = 10.0;    // of chi-square, for a modulator to be refined
constexpr double kSameScore = 1.0;      // of chi-square, for finer curves: a limit of computation

/// What a second column adds to the gain of the first.
double extra_gain(const Data& data, const Trial& trial, const VectorXd& column) {
  const double energy = trial.column.squaredNorm();
  if (!(energy > 0.0)) return 0.0;
  const VectorXd beside = column - trial.column * (trial.column.dot(column) / energy);
  const double own = beside.squaredNorm();
  if (!(own > 1e-6 * column.squaredNorm())) return 0.0;
  const double score = beside.dot(data.problem().residual);
  return score * score / own;
}

/// The sketch times each modulator, those that gain most.
std::vector<Sketch> modulated(const Data& data, const Trial& trial) {
  const auto pieces = modulators(data);
  std::vector<std::pair<double, std::size_t>> gains(pieces.size());
  const VectorXd strength = data.product(trial.sketch.pieces, trial.sketch);
  const MatrixXd vector = data.vector_of(trial.sketch);
  for_each_piece(static_cast<Index>(pieces.size()), [&](Index k) {
    const auto at = static_cast<std::size_t>(k);
    const VectorXd product = strength.cwiseProduct(data.product({pieces[at]}, trial.sketch));
    const VectorXd column = data.projected(data.raw_column(product, vector, trial.sketch));
    gains[at] = {extra_gain(data, trial, column), at};
  });
  std::stable_sort(gains.begin(), gains.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Sketch> list;
  std::set<std::tuple<std::size_t, std::size_t, law::Memory>> seen;
  for (const auto& [gain, at] : gains) {
    if (gain < kLeastExtra || list.size() >= kModulators) break;
    const law::Factor& factor = pieces[at].factor;
    if (!seen.insert({factor.coordinate, factor.shape, factor.memory}).second) continue;
    Sketch sketch = trial.sketch;
    sketch.pieces.push_back(pieces[at]);
    list.push_back(sketch);
  }
  return list;
}

void add_deletions(const Data& data, const Sketch& from, std::vector<Sketch>& list) {
  for (std::size_t k = 0; k < from.pieces.size(); ++k) {
    if (from.pieces.size() > 1 || !law::is_axis(from.direction)) {
      Sketch sketch = from;
      sketch.pieces.erase(sketch.pieces.begin() + static_cast<std::ptrdiff_t>(k));
      list.push_back(sketch);
    }
    if (from.pieces[k].factor.centred) {
      Sketch sketch = from;
      sketch.pieces[k].factor.centred = false;
      list.push_back(sketch);
    }
    if (from.pieces[k].factor.memory != law::Memory::kNone) {
      Sketch sketch = from;
      sketch.pieces[k].factor.memory = law::Memory::kNone;
      if (!from.pieces[k].values.empty()) sketch.pieces[k] = without_memory(data, from.pieces[k]);
      list.push_back(sketch);
    }
  }
  for (const Sketch& plain : made_plain(from)) list.push_back(plain);
  using Size = double Sketch::*;
  for (const Size size :
       {&Sketch::lag, &Sketch::vector_lag, &Sketch::vector_length, &Sketch::spread}) {
    if (!(from.*size > 0.0)) continue;
    if (from.pieces.empty() && law::is_axis(from.direction)) continue;  // a constant force is left
    Sketch sketch = from;
    sketch.*size = 0.0;
    if (!(sketch.lag > 0.0)) sketch.spread = 0.0;
    list.push_back(sketch);
  }
}

}  // namespace

std::vector<Sketch> plainer(const Data& data, const Sketch& from) {
  std::vector<Sketch> list;
  add_deletions(data, from, list);
  std::erase_if(list, [numbers = free_numbers(from)](const Sketch& sketch) {
    return free_numbers(sketch) >= numbers || has_constant(sketch);
  });
  for (std::size_t k = 0; k < from.pieces.size(); ++k) {
    for (const Piece& piece : without_constant(from.pieces[k])) {
      Sketch sketch = from;
      sketch.amplitude *= from.pieces[k].extra;
      sketch.pieces[k] = piece;
      list.push_back(sketch);
    }
  }
  return list;
}

namespace {

/// Shapes of one coordinate as one curve, and curves with more and with fewer nodes.
std::vector<Sketch> with_curves(const Data& data, const Sketch& from) {
  std::vector<Sketch> list;
  for (std::size_t k = 0; k < from.pieces.size(); ++k) {
    for (const Piece& piece : as_curves(data, from.pieces[k])) {
      list.push_back(from);
      list.back().pieces[k] = piece;
    }
    for (std::size_t i = 0; i < k; ++i) {
      for (const Piece& piece : merged(data, from.pieces[i], from.pieces[k])) {
        list.push_back(from);
        list.back().pieces[i] = piece;
        list.back().pieces.erase(list.back().pieces.begin() + static_cast<std::ptrdiff_t>(k));
      }
    }
  }
  return list;
}

/// The product behind a lag or many, the direction behind a lag or a presliding.
void add_lags(const Data& data, const Sketch& from, std::vector<Sketch>& list) {
  const auto add = [&](double Sketch::*size, double value) {
    list.push_back(from);
    list.back().*size = value;
  };
  if (!(from.lag > 0.0)) {
    add(&Sketch::lag, 0.15);
    add(&Sketch::lag, 1.0);
    list.back().spread = 30.0;
  } else if (!(from.spread > 0.0)) {
    add(&Sketch::spread, 10.0);
  }
  if (from.vector_lag > 0.0 || from.vector_length > 0.0) return;
  if (!law::is_axis(from.direction)) add(&Sketch::vector_lag, 0.15);
  if (from.direction == direction_named("along_velocity")) {
    for (const double share : {0.01, 0.1}) add(&Sketch::vector_length, share * data.diagonal());
  }
}

std::vector<Sketch> variants(const Data& data, const Trial& trial) {
  const Sketch& from = trial.sketch;
  std::vector<Sketch> list = with_curves(data, from);
  add_deletions(data, from, list);
  for (std::size_t k = 0; k < from.pieces.size(); ++k) {
    const Piece& piece = from.pieces[k];
    for (const auto& pieces : {other_shapes(data, piece), with_memories(data, piece)}) {
      for (const Piece& other : pieces) {
        Sketch sketch = from;
        sketch.pieces[k] = other;
        list.push_back(sketch);
      }
    }
    if (kind_of(piece.factor.coordinate) != Kind::kPlace && !piece.factor.centred &&
        law::shapes()[piece.factor.shape].free_centre) {
      Sketch sketch = from;
      sketch.pieces[k] = centred(sketch.pieces[k], 0.0);
      list.push_back(sketch);
    }
  }
  if (!data.of_axis()) {
    for (const Sketch& oblique : made_oblique(from)) list.push_back(oblique);
    for (const Sketch& along : made_along(from)) list.push_back(along);
  }
  add_lags(data, from, list);
  if (from.pieces.size() < kMostPieces) {
    const auto more = modulated(data, trial);
    list.insert(list.end(), more.begin(), more.end());
  }
  std::erase_if(list, has_constant);
  return list;
}

/// All of them fitted, in their order.
std::vector<Trial> fitted(const Data& data, const std::vector<Sketch>& sketches, int steps) {
  std::vector<Trial> trials(sketches.size());
  for_each_piece(static_cast<Index>(sketches.size()), [&](Index k) {
    trials[static_cast<std::size_t>(k)] =
        refined(data, sketches[static_cast<std::size_t>(k)], steps);
  });
  return trials;
}

/// All of them fitted a little, and the better ones more: those of the best score. A sketch that
/// gains little in its first steps seldom gains in later ones (successive halving, Jamieson and
/// Talwalkar 2016).
std::vector<Trial> screened(const Data& data, const std::vector<Sketch>& sketches) {
  std::vector<Trial> trials = fitted(data, sketches, kFirstSteps);
  rank(trials);
  std::vector<Sketch> better;
  const std::size_t count =
      std::min(trials.size(), std::max(kFewestNext, trials.size() / kNextShare));
  for (std::size_t k = 0; k < count; ++k) better.push_back(trials[k].sketch);
  std::vector<Trial> next = fitted(data, better, kNextSteps);
  std::move(next.begin(), next.end(), trials.begin());
  return trials;
}

/// Whether the factors never come near the amplitude: numbers that undo each other, whose sizes no
/// recording tells.
bool is_degenerate(const Data& data, const Sketch& sketch) {
  return data.product(sketch.pieces, sketch).cwiseAbs().maxCoeff() < kLeastProduct;
}

/// The best first, one trial a structure.
void rank_structures(const Data& data, std::vector<Trial>& trials) {
  for (Trial& trial : trials) {
    if (is_degenerate(data, trial.sketch)) trial.gain = 0.0;
  }
  rank(trials);
  std::vector<Trial> unique;
  for (Trial& trial : trials) {
    const auto structure = structure_of(trial.sketch);
    const bool known = std::any_of(unique.begin(), unique.end(), [&](const Trial& other) {
      return structure_of(other.sketch) == structure;
    });
    if (!known) unique.push_back(std::move(trial));
  }
  trials = std::move(unique);
}

/// The same, and with a factor fewer, which a finer curve may make needless.
std::vector<Sketch> with_other_curves(const Data& data, const Sketch& from) {
  std::vector<Sketch> list = with_curves(data, from);
  for (std::size_t k = 0; k < from.pieces.size() && from.pieces.size() > 1; ++k) {
    Sketch fewer = from;
    fewer.pieces.erase(fewer.pieces.begin() + static_cast<std::ptrdiff_t>(k));
    const auto more = with_curves(data, fewer);
    list.insert(list.end(), more.begin(), more.end());
  }
  return list;
}

}  // namespace

std::vector<Trial> evolved(const Data& data, std::vector<Trial> trials) {
  std::vector<Sketch> sketches;
  for (const Trial& trial : trials) sketches.push_back(trial.sketch);
  trials = fitted(data, sketches, kFirstSteps + 2 * kNextSteps);
  rank_structures(data, trials);
  std::vector<law::Structure> done;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Sketch> next;
    const std::size_t parents = round == 0 ? kParents : 2;
    for (std::size_t k = 0; k < std::min(parents, trials.size()); ++k) {
      const auto structure = structure_of(trials[k].sketch);
      if (std::find(done.begin(), done.end(), structure) != done.end()) continue;
      done.push_back(structure);
      const auto more = variants(data, trials[k]);
      next.insert(next.end(), more.begin(), more.end());
    }
    if (next.empty()) break;
    auto children = screened(data, next);
    trials.insert(trials.end(), children.begin(), children.end());
    rank_structures(data, trials);
    // The best few to the end: what is compared must have converged.
    for (std::size_t k = 0; k < std::min(kParents, trials.size()); ++k) {
      trials[k] = refined(data, trials[k].sketch, kLastSteps);
    }
    rank_structures(data, trials);
    if (trials.size() > 40) trials.resize(40);
  }
  return trials;
}

Sketch with_finer_curves(const Data& data, const Sketch& from) {
  std::vector<Trial> trials{weighed(data, from)};
  rank(trials);
  for (;;) {
    const double before = trials.front().score;
    auto children = fitted(data, with_other_curves(data, trials.front().sketch), kLastSteps);
    trials.resize(1);
    trials.insert(trials.end(), children.begin(), children.end());
    rank_structures(data, trials);
    if (trials.front().score <= before + kSameScore) return trials.front().sketch;
  }
}

}  // namespace dcnn::discovery
