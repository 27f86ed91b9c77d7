// SPDX-License-Identifier: Apache-2.0
#include "discovery/scan.h"

#include <algorithm>
#include <map>
#include <set>

#include "dcnn/core/parallel.h"
#include "discovery/own_directions.h"
#include "discovery/priors.h"

namespace dcnn::discovery {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBatch = 64;
// Estimates leave out what is known beside a law: many are weighed exactly, and the best of them
// behind lags too.
constexpr std::size_t kExact = 300, kLagged = 100;
constexpr double kLags[] = {0.1, 0.3, 1.0, 3.0, 10.0};  // s

/// Power that whitening makes of a channel's signals of motion, per sample.
Eigen::RowVector3d power_gains(const Data& data) {
  Eigen::RowVector3d gains = Eigen::RowVector3d::Zero();
  const std::size_t velocity = coordinate_named("v_base_x");
  for (Index j = 0; j < 3; ++j) {
    double energy = 0.0, whitened = 0.0;
    for (std::size_t c = velocity; c < velocity + 3; ++c) {
      MatrixXd force = MatrixXd::Zero(data.samples(), 3);
      force.col(j) = data.coordinate(c);
      energy += force.squaredNorm();
      whitened += data.whiten(force).squaredNorm();
    }
    gains(j) = energy > 0.0 ? whitened / energy : 0.0;
  }
  return gains;
}

/// A gain that is worth being remembered.
bool is_worth(double gain) { return gain > prior::kNumber; }

/// A trial whose gain is an estimate and whose column is not made yet.
Trial told(const Sketch& sketch, double gain) { return {sketch, gain, 0.0, VectorXd()}; }

/// By direction: e·x of the residual brought back through the whitening, and e·e in its metric.
struct Weights {
  MatrixXd back;
  Eigen::RowVector3d gains;
  MatrixXd score, energy;
};

Weights weights_of(const Data& data, const std::vector<Sketch>& directions) {
  const auto count = static_cast<Index>(directions.size());
  Weights weights{data.transposed(data.problem().residual), power_gains(data),
                  MatrixXd(data.samples(), count), MatrixXd(data.samples(), count)};
  for (Index d = 0; d < count; ++d) {
    const MatrixXd e = data.vector_of(directions[static_cast<std::size_t>(d)]);
    weights.score.col(d) = e.cwiseProduct(weights.back).rowwise().sum();
    weights.energy.col(d) = e.cwiseAbs2() * weights.gains.transpose();
  }
  return weights;
}

/// Whether the directions from d on are the three axes of a frame, or vector products with them.
bool begins_axes(const std::vector<Sketch>& directions, std::size_t d) {
  const std::size_t first = directions[d].direction;
  return law::has_axis(first) && first % 3 == 0 && d + 2 < directions.size() &&
         directions[d + 2].direction == first + 2;
}

/// The oblique axis of three that gains most, from the strengths along each.
Sketch turned(const std::vector<Sketch>& directions, std::size_t d,
              const Eigen::Vector3d& strengths, const Atom& atom) {
  Eigen::Vector3d e = strengths;
  for (std::size_t i = 0; i < 3; ++i) e[static_cast<Index>(i)] /= directions[d + i].vector_scale;
  Sketch sketch = with_axis(directions[d], e);
  sketch.pieces = atom;
  return sketch;
}

bool has_free_constant(const Atom& atom) {
  return atom.size() == 1 && atom[0].factor.centred &&
         atom[0].factor.shape == shape_named("linear") &&
         atom[0].factor.memory == law::Memory::kNone;
}

/// `centre`: of a linear factor whose constant is free.
Sketch sketch_of(const Data& data, const Sketch& direction, const Atom& atom, double centre) {
  Sketch sketch = direction;
  sketch.pieces = atom;
  if (has_free_constant(sketch.pieces)) {
    const std::size_t c = sketch.pieces[0].factor.coordinate;
    const double reach = 2.0 * data.half_range(c);
    sketch.pieces[0].centre = std::clamp(centre, data.middle(c) - reach, data.middle(c) + reach);
  }
  return sketch;
}

/// Of a batch of atoms, by atom and direction: products with the score, and with the energy of the
/// atom and of its square.
struct Sums {
  MatrixXd scores, means, energies;
};

/// The oblique axes that gain most, of every frame.
void add_turned(const Sums& sums, Index row, const Atom& atom,
                const std::vector<Sketch>& directions, std::vector<Trial>& list) {
  for (std::size_t d = 0; d < directions.size(); ++d) {
    if (!begins_axes(directions, d)) continue;
    if (atom.empty() && law::is_axis(directions[d].direction)) continue;
    const auto first = static_cast<Index>(d);
    const Eigen::Array3d score = sums.scores.row(row).segment<3>(first).transpose(),
                         energy = sums.energies.row(row).segment<3>(first).transpose();
    if (!(energy.minCoeff() > 0.0)) continue;
    const double gain = (score * score / energy).sum();
    if (is_worth(gain)) list.push_back(told(turned(directions, d, score / energy, atom), gain));
  }
}

/// The directions as they are; a linear factor with the constant that gains most.
void add_straight(const Data& data, const Sums& sums, Index row, const Atom& atom,
                  const Weights& weights, const std::vector<Sketch>& directions,
                  std::vector<Trial>& list) {
  for (Index d = 0; d < sums.scores.cols(); ++d) {
    const Sketch& direction = directions[static_cast<std::size_t>(d)];
    if (atom.empty() && law::is_axis(direction.direction)) continue;
    const double whole = sums.energies(row, d);
    double score = sums.scores(row, d), energy = whole, extra = 0.0, centre = 0.0;
    if (!(energy > 0.0)) continue;
    if (has_free_constant(atom)) {
      const double constant_score = weights.score.col(d).sum(),
                   constant_energy = weights.energy.col(d).sum();
      const double mean = sums.means(row, d) / constant_energy;
      const double constant = constant_score / constant_energy;
      score -= mean * constant_score;
      energy -= mean * mean * constant_energy;
      if (!(energy > 1e-9 * whole)) continue;
      extra = constant * constant_score;
      const double u0 = mean - constant * energy / score;  // where the line is zero
      centre = atom[0].centre + u0 * atom[0].scale;
    }
    const double gain = score * score / energy + extra;
    if (is_worth(gain)) list.push_back(told(sketch_of(data, direction, atom, centre), gain));
  }
}

/// Candidates of one batch of atoms.
std::vector<Trial> batch_gains(const Data& data, const std::vector<Atom>& atoms, std::size_t first,
                               std::size_t count, const Weights& weights,
                               const std::vector<Sketch>& directions) {
  MatrixXd columns(data.samples(), static_cast<Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    columns.col(static_cast<Index>(k)) = data.product(atoms[first + k], {});
  }
  const Sums sums{columns.transpose() * weights.score, columns.transpose() * weights.energy,
                  columns.cwiseAbs2().transpose() * weights.energy};
  std::vector<Trial> list;
  for (std::size_t k = 0; k < count; ++k) {
    const auto row = static_cast<Index>(k);
    add_turned(sums, row, atoms[first + k], directions, list);
    add_straight(data, sums, row, atoms[first + k], weights, directions, list);
  }
  return list;
}

/// Candidates of one direction with numbers of its own.
std::vector<Trial> own_gains(const Data& data, const Sketch& direction, const Weights& weights) {
  const MatrixXd e = data.vector_of(direction);
  const VectorXd score = e.cwiseProduct(weights.back).rowwise().sum();
  const VectorXd energy = e.cwiseAbs2() * weights.gains.transpose();
  std::vector<Trial> list;
  for (const Atom& atom : own_atoms(data, direction)) {
    const VectorXd column = data.product(atom, direction);
    const double size = column.cwiseAbs2().dot(energy), found = column.dot(score);
    if (!(size > 0.0) || !is_worth(found * found / size)) continue;
    list.push_back(told(direction, found * found / size));
    list.back().sketch.pieces = atom;
  }
  return list;
}

/// Admits two of one direction and set of coordinates.
class PerKeyLimit {
 public:
  bool admits(const Sketch& sketch) {
    std::multiset<std::size_t> key{1000 + 2 * sketch.direction + sketch.oblique};
    for (const Piece& piece : sketch.pieces) key.insert(piece.factor.coordinate);
    return ++counts_[key] <= 2;
  }

 private:
  std::map<std::multiset<std::size_t>, int> counts_;
};

void weigh(const Data& data, std::vector<Trial>& trials) {
  for_each_piece(static_cast<Index>(trials.size()), [&](Index k) {
    Trial& trial = trials[static_cast<std::size_t>(k)];
    trial = weighed(data, trial.sketch);
  });
}

/// The first of them with the product behind a lag, the best first.
std::vector<Trial> lagged(const Data& data, const std::vector<Trial>& trials) {
  std::vector<Trial> lagged;
  for (std::size_t k = 0; k < std::min(kLagged, trials.size()); ++k) {
    const Sketch& sketch = trials[k].sketch;
    if (sketch.pieces.empty()) continue;  // of a direction: dictionaries hold these
    for (const double tau : kLags) {
      lagged.push_back(told(sketch, 0.0));
      lagged.back().sketch.lag = tau;
    }
  }
  weigh(data, lagged);
  rank(lagged);
  return lagged;
}

/// Adds the first `count` of a list that are not alike.
void add_best(const std::vector<Trial>& from, std::size_t count, std::vector<Trial>& list) {
  PerKeyLimit per_key;
  for (const Trial& trial : from) {
    if (count > 0 && per_key.admits(trial.sketch)) list.push_back(trial), --count;
  }
}

}  // namespace

std::vector<Trial> scan(const Data& data, std::size_t count) {
  const auto atoms = dictionary(data);
  const auto directions = direction_sketches(data);
  const Weights weights = weights_of(data, directions);
  const auto own = own_directions(data);
  const auto batches = (static_cast<Index>(atoms.size()) + kBatch - 1) / kBatch;
  std::vector<std::vector<Trial>> found(static_cast<std::size_t>(batches) + own.size());
  for_each_piece(static_cast<Index>(found.size()), [&](Index b) {
    if (b >= batches) {
      const auto k = static_cast<std::size_t>(b - batches);
      found[static_cast<std::size_t>(b)] = own_gains(data, own[k], weights);
      return;
    }
    const auto first = static_cast<std::size_t>(b * kBatch);
    const std::size_t size = std::min(static_cast<std::size_t>(kBatch), atoms.size() - first);
    found[static_cast<std::size_t>(b)] = batch_gains(data, atoms, first, size, weights, directions);
  });
  std::vector<Trial> all;
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  rank(all);
  PerKeyLimit per_key;
  std::vector<Trial> exact, best;
  for (const Trial& candidate : all) {
    if (exact.size() >= kExact) break;
    if (per_key.admits(candidate.sketch)) exact.push_back(candidate);
  }
  weigh(data, exact);
  rank(exact);
  const std::vector<Trial> late = lagged(data, exact);
  add_best(exact, count, best);
  add_best(late, count / 2, best);
  rank(best);
  return best;
}

}  // namespace dcnn::discovery
