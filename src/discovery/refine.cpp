// SPDX-License-Identifier: Apache-2.0
#include "discovery/refine.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "discovery/handles.h"
#include "discovery/priors.h"

namespace dcnn::discovery {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSettled = 0.05;                           // of chi-square
constexpr double kFirstDamping = 1e-6, kMostDamping = 1e3;  // of the diagonal
constexpr double kDamped = 30.0;  // times more after a step that is no better, less after others

/// Sketches with the amplitudes that are best together.
struct Sum {
  std::vector<Sketch> terms;
  MatrixXd columns;  // of unit amplitudes
  VectorXd left;
  double gain = 0.0;
};

Sum balanced(const Data& data, std::vector<Sketch> terms) {
  const VectorXd& residual = data.problem().residual;
  Sum sum{std::move(terms), MatrixXd(residual.size(), 0), residual, 0.0};
  sum.columns.resize(residual.size(), static_cast<Index>(sum.terms.size()));
  for (std::size_t k = 0; k < sum.terms.size(); ++k) {
    sum.columns.col(static_cast<Index>(k)) = data.column(sum.terms[k]);
  }
  const MatrixXd gram = sum.columns.transpose() * sum.columns;
  const VectorXd score = sum.columns.transpose() * residual;
  VectorXd amplitudes = VectorXd::Zero(score.size());
  if (gram.size() == 1 && gram(0, 0) > 0.0) amplitudes = score / gram(0, 0);
  if (gram.size() > 1) amplitudes = solve_gram(gram, score, 1e-9);
  if (!amplitudes.allFinite()) amplitudes.setZero();
  for (std::size_t k = 0; k < sum.terms.size(); ++k) {
    sum.terms[k].amplitude = amplitudes(static_cast<Index>(k));
  }
  sum.left -= sum.columns * amplitudes;
  sum.gain = 2.0 * amplitudes.dot(score) - amplitudes.dot(gram * amplitudes);
  return sum;
}

/// Raw columns of a sketch whose numbers move one at a time: what they leave is computed once.
class Moving {
 public:
  Moving(const Data& data, const Sketch& sketch)
      : data_(data), vector_(data.vector_of(sketch)), others_(sketch.pieces.size()) {
    for (std::size_t k = 0; k < others_.size(); ++k) {
      auto pieces = sketch.pieces;
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
      others_[k] = data.product(pieces, sketch);
    }
  }
  VectorXd column(const Sketch& sketch, int moved_piece) const {
    if (moved_piece < 0) return data_.raw_column(sketch);
    const auto k = static_cast<std::size_t>(moved_piece);
    return data_.raw_column(others_[k].cwiseProduct(data_.product({sketch.pieces[k]}, sketch)),
                            vector_, sketch);
  }

 private:
  const Data& data_;
  MatrixXd vector_;
  std::vector<VectorXd> others_;  // the product of all factors but one
};

/// Derivatives by the search scales, unit amplitude.
MatrixXd derivatives(const Data& data, Sketch sketch) {
  const auto handles = handles_of(data, sketch);
  MatrixXd columns(data.problem().residual.size(), static_cast<Index>(handles.size()));
  const Moving moving(data, sketch);
  const VectorXd from = data.raw_column(sketch);
  for (std::size_t k = 0; k < handles.size(); ++k) {
    const double before = *handles[k].value, at = handles[k].get();
    handles[k].set(at + handles[k].step);
    double moved = handles[k].get() - at;
    if (std::abs(moved) < 0.5 * handles[k].step) {  // at the upper bound
      handles[k].set(at - handles[k].step);
      moved = handles[k].get() - at;
    }
    const VectorXd column = moving.column(sketch, handles[k].of_piece);
    columns.col(static_cast<Index>(k)) =
        moved == 0.0 ? VectorXd(VectorXd::Zero(from.size())) : VectorXd((column - from) / moved);
    *handles[k].value = before;
  }
  return data.projected(columns);
}

/// Normal equations of a step of all numbers, those of each term behind its amplitude.
struct Normal {
  MatrixXd gram;
  VectorXd score;
  std::vector<Index> begins;  // places of the amplitudes
  /// Damped by a share of the diagonal (Marquardt 1963), without the amplitudes'.
  VectorXd step(double damping) const {
    MatrixXd damped = gram;
    damped.diagonal() *= 1.0 + damping;
    for (const Index place : begins) damped(place, place) = gram(place, place);
    return solve_gram(damped, score, 1e-9);
  }
};

Normal normal_of(const Data& data, const Sum& sum) {
  std::vector<MatrixXd> slopes;
  Normal normal;
  Index count = 0;
  for (const Sketch& sketch : sum.terms) {
    slopes.push_back(sketch.amplitude * derivatives(data, sketch));
    normal.begins.push_back(count);
    count += slopes.back().cols() + 1;
  }
  MatrixXd A(sum.left.size(), count);
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    A.col(normal.begins[k]) = sum.columns.col(static_cast<Index>(k));
    A.middleCols(normal.begins[k] + 1, slopes[k].cols()) = slopes[k];
  }
  normal.gram = A.transpose() * A;
  normal.score = A.transpose() * sum.left;
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    const Index first = normal.begins[k], size = slopes[k].cols() + 1;
    MatrixXd gram = normal.gram.block(first, first, size, size);
    VectorXd score = normal.score.segment(first, size);
    add_bending(data, sum.terms[k], gram, score);
    normal.gram.block(first, first, size, size) = gram;
    normal.score.segment(first, size) = score;
  }
  return normal;
}

/// The terms with their numbers changed, each by no more than it may.
std::vector<Sketch> changed(const Data& data, std::vector<Sketch> terms, const Normal& normal,
                            const VectorXd& change) {
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const auto handles = handles_of(data, terms[t]);
    for (std::size_t k = 0; k < handles.size(); ++k) {
      const double most = handles[k].most;
      const double step = change(normal.begins[t] + 1 + static_cast<Index>(k));
      handles[k].set(handles[k].get() + std::clamp(step, -most, most));
    }
  }
  return terms;
}

/// Gauss-Newton steps of all numbers together.
Sum fitted_together(const Data& data, const std::vector<Sketch>& terms, int most_steps) {
  Sum here = balanced(data, terms);
  double damping = kFirstDamping;
  for (int step = 0; step < most_steps && here.gain > 0.0; ++step) {
    const Normal normal = normal_of(data, here);
    if (normal.gram.cols() == static_cast<Index>(terms.size())) break;  // amplitudes alone
    const double before = here.gain;
    bool better = false;
    for (; damping < kMostDamping && !better; damping *= better ? 1.0 : kDamped) {
      const VectorXd change = normal.step(damping);
      if (!change.allFinite()) break;
      Sum there = balanced(data, changed(data, here.terms, normal, change));
      better = there.gain > here.gain;
      if (better) here = std::move(there);
    }
    if (!better || here.gain - before < kSettled) break;
    damping = std::max(kFirstDamping, damping / kDamped);
  }
  return here;
}

Trial trial_of(const Sum& sum) { return {sum.terms.front(), sum.gain, 0.0, sum.columns.col(0)}; }

}  // namespace

void add_bending(const Data& data, Sketch sketch, MatrixXd& gram, VectorXd& score) {
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

Trial weighed(const Data& data, const Sketch& sketch) { return trial_of(balanced(data, {sketch})); }

Trial refined(const Data& data, const Sketch& sketch, int most_steps) {
  return trial_of(fitted_together(data, {sketch}, most_steps));
}

std::vector<Sketch> refined_together(const Data& data, const std::vector<Sketch>& terms,
                                     int most_steps) {
  return fitted_together(data, terms, most_steps).terms;
}

MatrixXd tangent_of(const Data& data, const Sketch& sketch) {
  const VectorXd column = data.column(sketch);
  const MatrixXd slopes = derivatives(data, sketch);
  MatrixXd columns(column.size(), slopes.cols() + 1);
  columns << column, sketch.amplitude * slopes;
  Sketch copy = sketch;
  const auto handles = handles_of(data, copy);
  for (std::size_t k = 0; k < handles.size(); ++k) {
    if (handles[k].logarithmic)
      columns.col(static_cast<Index>(k) + 1) /= std::abs(*handles[k].value);
  }
  return columns;
}

}  // namespace dcnn::discovery
