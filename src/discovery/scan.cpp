#include "discovery/scan.h"

#include <algorithm>
#include <map>
#include <set>

#include "dcnn/core/parallel.h"
#include "discovery/dictionary.h"

namespace dcnn::discovery {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBatch = 64;
constexpr std::size_t kExact = 4;  // times as many are weighed exactly as are asked for

struct Candidate {
  double gain;
  std::size_t atom, direction;
  double centre;  // of a linear factor whose constant is free
};

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

/// By direction: e·x of the residual brought back through the whitening, and e·e in its metric.
struct Weights {
  MatrixXd score, energy;
};

Weights weights_of(const Data& data, const std::vector<Sketch>& directions) {
  const MatrixXd back = data.transposed(data.problem().residual);
  const Eigen::RowVector3d gains = power_gains(data);
  const auto count = static_cast<Index>(directions.size());
  Weights weights{MatrixXd(data.samples(), count), MatrixXd(data.samples(), count)};
  for (Index d = 0; d < count; ++d) {
    const MatrixXd e = data.vector_of(directions[static_cast<std::size_t>(d)]);
    weights.score.col(d) = e.cwiseProduct(back).rowwise().sum();
    weights.energy.col(d) = e.cwiseAbs2() * gains.transpose();
  }
  return weights;
}

bool has_free_constant(const Atom& atom) {
  return atom.size() == 1 && atom[0].factor.centred &&
         atom[0].factor.shape == shape_named("linear") &&
         atom[0].factor.memory == law::Memory::kNone;
}

/// Candidates of one batch of atoms.
std::vector<Candidate> batch_gains(const Data& data, const std::vector<Atom>& atoms,
                                   std::size_t first, std::size_t count, const Weights& weights,
                                   const std::vector<Sketch>& directions) {
  MatrixXd columns(data.samples(), static_cast<Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    columns.col(static_cast<Index>(k)) = data.product(atoms[first + k]);
  }
  const MatrixXd scores = columns.transpose() * weights.score;
  const MatrixXd means = columns.transpose() * weights.energy;
  const MatrixXd energies = columns.cwiseAbs2().transpose() * weights.energy;
  const Eigen::RowVectorXd constant_score = weights.score.colwise().sum();
  const Eigen::RowVectorXd constant_energy = weights.energy.colwise().sum();
  std::vector<Candidate> list;
  for (std::size_t k = 0; k < count; ++k) {
    const Atom& atom = atoms[first + k];
    for (Index d = 0; d < scores.cols(); ++d) {
      const auto direction = static_cast<std::size_t>(d);
      if (atom.empty() && law::is_axis(directions[direction].direction)) continue;
      const auto row = static_cast<Index>(k);
      double score = scores(row, d), energy = energies(row, d), extra = 0.0, centre = 0.0;
      if (!(energy > 0.0)) continue;
      if (has_free_constant(atom)) {
        const double mean = means(row, d) / constant_energy(d);
        const double constant = constant_score(d) / constant_energy(d);
        score -= mean * constant_score(d);
        energy -= mean * mean * constant_energy(d);
        if (!(energy > 1e-9 * energies(row, d))) continue;
        extra = constant * constant_score(d);
        const double u0 = mean - constant * energy / score;  // where the line is zero
        centre = atom[0].centre + u0 * atom[0].scale;
      }
      list.push_back({score * score / energy + extra, first + k, direction, centre});
    }
  }
  return list;
}

Sketch sketch_of(const Data& data, const Candidate& candidate, const std::vector<Atom>& atoms,
                 const std::vector<Sketch>& directions) {
  Sketch sketch = directions[candidate.direction];
  sketch.pieces = atoms[candidate.atom];
  if (has_free_constant(sketch.pieces)) {
    const std::size_t c = sketch.pieces[0].factor.coordinate;
    const double reach = 2.0 * data.half_range(c);
    sketch.pieces[0].centre =
        std::clamp(candidate.centre, data.middle(c) - reach, data.middle(c) + reach);
  }
  return sketch;
}

/// At most two of one direction and set of coordinates.
class Crowd {
 public:
  bool admits(const Sketch& sketch) {
    std::multiset<std::size_t> key{1000 + sketch.direction};
    for (const Piece& piece : sketch.pieces) key.insert(piece.factor.coordinate);
    return ++counts_[key] <= 2;
  }

 private:
  std::map<std::multiset<std::size_t>, int> counts_;
};

void sort_by_gain(std::vector<Trial>& trials) {
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.gain > b.gain; });
}

}  // namespace

std::vector<Trial> scan(const Data& data, std::size_t count) {
  const auto atoms = dictionary(data);
  const auto directions = direction_sketches(data);
  const Weights weights = weights_of(data, directions);
  const auto batches = (static_cast<Index>(atoms.size()) + kBatch - 1) / kBatch;
  std::vector<std::vector<Candidate>> found(static_cast<std::size_t>(batches));
  for_each_piece(batches, [&](Index b) {
    const auto first = static_cast<std::size_t>(b * kBatch);
    const std::size_t size = std::min(static_cast<std::size_t>(kBatch), atoms.size() - first);
    found[static_cast<std::size_t>(b)] = batch_gains(data, atoms, first, size, weights, directions);
  });
  std::vector<Candidate> all;
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
  Crowd crowd, final_crowd;
  std::vector<Trial> exact, best;
  for (const Candidate& candidate : all) {
    if (exact.size() >= kExact * count) break;
    const Sketch sketch = sketch_of(data, candidate, atoms, directions);
    if (crowd.admits(sketch)) exact.push_back(weighed(data, sketch));
  }
  sort_by_gain(exact);
  for (Trial& trial : exact) {
    if (best.size() < count && final_crowd.admits(trial.sketch)) best.push_back(std::move(trial));
  }
  return best;
}

}  // namespace dcnn::discovery
