#include "discovery/refine.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "discovery/priors.h"

namespace dcnn::discovery {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSettled = 0.05;                           // of chi-square
constexpr double kFirstDamping = 1e-6, kMostDamping = 1e3;  // of the diagonal
constexpr double kDamped = 30.0;  // times more after a step that is no better, less after others
constexpr double kFarthestPoint = 3.0;  // diagonals of what was reached
constexpr double kSteepest = 3.0;       // of an oblique axis: beyond 1 another axis is nearer

/// A number of a sketch on the scale that it is searched on.
struct Handle {
  double* value;
  bool logarithmic;
  double low, high;
  double step;  // of a difference
  double most;  // of one Gauss-Newton step

  double get() const { return logarithmic ? elementary::log(std::abs(*value)) : *value; }
  void set(double x) const {
    if (logarithmic) {
      const double size = std::clamp(elementary::exp(x), low, high);
      *value = std::copysign(size, *value);
    } else {
      *value = std::clamp(x, low, high);
    }
  }
};

Handle positive(double& value, double low, double high) {
  return {&value, true, low, high, 0.01, 0.8};
}

void add_handles(const Data& data, Piece& piece, std::vector<Handle>& list) {
  const std::size_t c = piece.factor.coordinate;
  const law::Shape& shape = law::shapes()[piece.factor.shape];
  const bool clock_memory = piece.factor.memory == law::Memory::kLag ||
                            piece.factor.memory == law::Memory::kHighPass ||
                            piece.factor.memory == law::Memory::kDelay;
  if (clock_memory) {
    list.push_back(positive(piece.memory, 2.0 * data.dt(), 0.5 * data.seconds()));
  } else if (piece.factor.memory == law::Memory::kSecondOrder) {
    list.push_back(positive(piece.memory, 1.0 / data.seconds(), 0.25 / data.dt()));
    list.push_back(positive(piece.second, law::kLeastDamping, law::kMostDamping));
  } else if (piece.factor.memory == law::Memory::kThixotropic) {
    const double path = data.path_range(c);
    list.push_back(positive(piece.memory, 1e-3 * path, 100.0 * path));
    list.push_back(positive(piece.second, 2.0 * data.dt(), data.seconds()));
  } else if (piece.factor.memory == law::Memory::kPlay) {
    list.push_back(positive(piece.memory, 1e-3 * data.half_range(c), data.half_range(c)));
  } else if (piece.factor.memory != law::Memory::kNone) {
    list.push_back(positive(piece.memory, 1e-3 * data.path_range(c), 2.0 * data.path_range(c)));
  }
  const double range = data.half_range(c);
  if (piece.factor.centred && shape.free_centre) {
    list.push_back({&piece.centre, false, data.low(c) - range, data.high(c) + range, 5e-3 * range,
                    0.3 * range});
  }
  if (shape.free_scale) {
    const double size = std::max(range, data.rms(c));
    list.push_back(positive(piece.scale, 2e-3 * size, 50.0 * size));
  }
  for (std::size_t k = 0; k < piece.values.size(); ++k) {
    if (k != piece.factor.peak) list.push_back({&piece.values[k], false, -1e3, 1e3, 0.02, 10.0});
  }
  if (!*shape.extra) return;
  const bool is_power = shape.most < 100.0;
  list.push_back({&piece.extra, false, is_power ? prior::kLeastPower : shape.least, shape.most,
                  is_power ? 0.01 : 0.01 * (1.0 + std::abs(piece.extra)),
                  is_power ? 0.5 : 2.0 * (1.0 + std::abs(piece.extra))});
}

/// Two of an oblique axis, or the place of a point, which may lie outside what was reached.
void add_own_handles(const Data& data, Sketch& sketch, std::vector<Handle>& list) {
  if (law::is_central(sketch.direction)) {
    const std::size_t x = coordinate_named("x");
    const double diagonal = 2.0 * data.rms(coordinate_named("distance"));
    for (std::size_t k = 0; k < 3; ++k) {
      list.push_back({&sketch.own[k], false, data.low(x + k) - kFarthestPoint * diagonal,
                      data.high(x + k) + kFarthestPoint * diagonal, 2e-3 * diagonal,
                      0.15 * diagonal});
    }
  } else if (sketch.oblique) {
    for (std::size_t k = 0; k < 2; ++k) {
      list.push_back({&sketch.own[k], false, -kSteepest, kSteepest, 0.01, 0.3});
    }
  }
}

/// In the order of the law's numbers, without the amplitude and the references.
std::vector<Handle> handles_of(const Data& data, Sketch& sketch) {
  std::vector<Handle> list;
  add_own_handles(data, sketch, list);
  if (sketch.vector_lag > 0.0) {
    list.push_back(positive(sketch.vector_lag, 2.0 * data.dt(), 0.5 * data.seconds()));
  }
  if (sketch.lag > 0.0) {
    list.push_back(positive(sketch.lag, 0.5 * data.dt(), 0.5 * data.seconds()));
  }
  for (Piece& piece : sketch.pieces) add_handles(data, piece, list);
  return list;
}

void solve_amplitude(const Data& data, Trial& trial) {
  const double energy = trial.column.squaredNorm();
  const double score = trial.column.dot(data.problem().residual);
  trial.sketch.amplitude = energy > 0.0 ? score / energy : 0.0;
  trial.gain = energy > 0.0 ? score * score / energy : 0.0;
}

/// Derivatives by the search scales, unit amplitude.
MatrixXd derivatives(const Data& data, const Trial& here) {
  Sketch sketch = here.sketch;
  const auto handles = handles_of(data, sketch);
  MatrixXd columns(here.column.size(), static_cast<Index>(handles.size()));
  const VectorXd from = data.raw_column(sketch);
  for (std::size_t k = 0; k < handles.size(); ++k) {
    const double before = *handles[k].value, at = handles[k].get();
    handles[k].set(at + handles[k].step);
    double moved = handles[k].get() - at;
    if (std::abs(moved) < 0.5 * handles[k].step) {  // at the upper bound
      handles[k].set(at - handles[k].step);
      moved = handles[k].get() - at;
    }
    columns.col(static_cast<Index>(k)) = moved == 0.0
                                             ? VectorXd(VectorXd::Zero(here.column.size()))
                                             : VectorXd((data.raw_column(sketch) - from) / moved);
    *handles[k].value = before;
  }
  return data.projected(columns);
}

/// A curve where the motion hardly is goes on as beside: its second differences weigh a little of
/// what the mean value of its nodes does. In a Gram matrix whose first row is the amplitude's.
void add_bending(const Data& data, const Trial& here, MatrixXd& gram, VectorXd& score) {
  Sketch sketch = here.sketch;
  const auto handles = handles_of(data, sketch);
  for (const Piece& piece : sketch.pieces) {
    const auto count = static_cast<Index>(piece.values.size());
    MatrixXd bends = MatrixXd::Zero(std::max<Index>(0, count - 2), gram.cols());
    VectorXd now = VectorXd::Zero(bends.rows());
    double weight = 0.0;
    for (Index k = 0; k < count; ++k) {
      const double* const value = &piece.values[static_cast<std::size_t>(k)];
      const auto found = std::find_if(handles.begin(), handles.end(),
                                      [&](const Handle& handle) { return handle.value == value; });
      const Index place = found == handles.end() ? -1 : found - handles.begin() + 1;
      if (place > 0) weight += gram(place, place) / static_cast<double>(count);
      for (Index row = std::max<Index>(0, k - 2); row <= std::min(k, count - 3); ++row) {
        const double share = row == k - 1 ? -2.0 : 1.0;
        if (place > 0) bends(row, place) = share;
        now(row) += share * *value;
      }
    }
    gram += prior::kBending * weight * bends.transpose() * bends;
    score -= prior::kBending * weight * bends.transpose() * now;
  }
}

/// Normal equations of a step of the numbers, the amplitude first.
struct Normal {
  MatrixXd gram;
  VectorXd score;
  /// Damped by a share of the diagonal (Marquardt 1963), without the amplitude's.
  VectorXd step(double damping) const {
    MatrixXd damped = gram;
    damped.diagonal().tail(gram.cols() - 1) *= 1.0 + damping;
    return solve_gram(damped, score, 1e-9).bottomRows(gram.cols() - 1);
  }
};

Normal normal_of(const Data& data, const Trial& here, const MatrixXd& slopes) {
  MatrixXd A(slopes.rows(), slopes.cols() + 1);
  A << here.column, here.sketch.amplitude * slopes;
  const VectorXd left = data.problem().residual - here.sketch.amplitude * here.column;
  Normal normal{A.transpose() * A, A.transpose() * left};
  add_bending(data, here, normal.gram, normal.score);
  return normal;
}

}  // namespace

double penalty(const Sketch& sketch, double largest) {
  const auto factors = static_cast<double>(sketch.pieces.size());
  return (prior::kNumber + prior::kModelError * largest) * free_numbers(sketch) +
         prior::kFactor * std::max(0.0, factors - 1.0) + prior::kMemory * memories(sketch);
}

void rank(std::vector<Trial>& trials) {
  double largest = 0.0;
  for (const Trial& trial : trials) largest = std::max(largest, trial.gain);
  for (Trial& trial : trials) trial.score = trial.gain - penalty(trial.sketch, largest);
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.score > b.score; });
}

Trial weighed(const Data& data, const Sketch& sketch) {
  Trial trial{sketch, 0.0, 0.0, data.column(sketch)};
  solve_amplitude(data, trial);
  return trial;
}

Trial refined(const Data& data, const Sketch& sketch, int most_steps) {
  Trial here = weighed(data, sketch);
  double damping = kFirstDamping;
  for (int step = 0; step < most_steps && here.gain > 0.0; ++step) {
    const MatrixXd slopes = derivatives(data, here);
    if (slopes.cols() == 0) break;
    const Normal normal = normal_of(data, here, slopes);
    const double before = here.gain;
    bool better = false;
    for (; damping < kMostDamping && !better; damping *= better ? 1.0 : kDamped) {
      const VectorXd change = normal.step(damping);
      if (!change.allFinite()) break;
      Sketch next = here.sketch;
      const auto handles = handles_of(data, next);
      for (std::size_t k = 0; k < handles.size(); ++k) {
        const double most = handles[k].most;
        handles[k].set(handles[k].get() + std::clamp(change(static_cast<Index>(k)), -most, most));
      }
      Trial there = weighed(data, next);
      better = there.gain > here.gain;
      if (better) here = std::move(there);
    }
    if (!better || here.gain - before < kSettled) break;
    damping = std::max(kFirstDamping, damping / kDamped);
  }
  return here;
}

MatrixXd tangent_of(const Data& data, const Sketch& sketch) {
  Trial here{sketch, 0.0, 0.0, data.column(sketch)};
  const MatrixXd slopes = derivatives(data, here);
  MatrixXd columns(here.column.size(), slopes.cols() + 1);
  columns << here.column, sketch.amplitude * slopes;
  Sketch copy = sketch;
  const auto handles = handles_of(data, copy);
  for (std::size_t k = 0; k < handles.size(); ++k) {
    if (handles[k].logarithmic)
      columns.col(static_cast<Index>(k) + 1) /= std::abs(*handles[k].value);
  }
  return columns;
}

}  // namespace dcnn::discovery
