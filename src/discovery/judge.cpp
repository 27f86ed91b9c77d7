// SPDX-License-Identifier: Apache-2.0
#include "discovery/judge.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/linear_algebra.h"
#include "core/tails.h"
#include "discovery/priors.h"

namespace dcnn::discovery {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kFolds = 4;

/// Stretches of rows of one recording and channel without a gap.
std::vector<std::pair<Index, Index>> stretches(const std::vector<Row>& rows) {
  std::vector<std::pair<Index, Index>> list;
  Index begin = 0;
  const auto count = static_cast<Index>(rows.size());
  for (Index k = 1; k <= count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (k < count && rows[at].record == rows[at - 1].record &&
        rows[at].channel == rows[at - 1].channel && rows[at].t > rows[at - 1].t) {
      continue;
    }
    list.emplace_back(begin, k);
    begin = k;
  }
  return list;
}

/// Sum over stretches of x_i x_(i + lag).
double lagged_product(const VectorXd& x, const std::vector<std::pair<Index, Index>>& list,
                      Index lag) {
  double sum = 0.0;
  for (const auto& [begin, end] : list) {
    const Index count = end - begin - lag;
    if (count > 0) sum += x.segment(begin, count).dot(x.segment(begin + lag, count));
  }
  return sum;
}

/// Var(c·r)/(c·c) of a residual r that is stationary but not white, from the autocorrelations of
/// both with a triangular window (Newey and West 1987); at least 1.
double inflation_of(const Data& data, const VectorXd& residual, const VectorXd& column) {
  const auto& rows = data.problem().rows;
  const auto list = stretches(rows);
  const double energy = column.squaredNorm(), power = residual.squaredNorm();
  const auto used = static_cast<double>((data.problem().residual.array() != 0.0).count());
  if (!(energy > 0.0) || !(power > 0.0)) return 1.0;
  Index longest = 0;
  for (const auto& [begin, end] : list) longest = std::max(longest, end - begin);
  const double step = rows.size() > 1 ? std::abs(rows[1].t - rows[0].t) : data.dt();
  const Index most =
      std::min(longest / 4, static_cast<Index>(prior::kCorrelated / std::max(step, 1e-6)));
  double sum = 1.0;
  for (Index lag = 1; lag <= most; ++lag) {
    const double window = 1.0 - static_cast<double>(lag) / static_cast<double>(most + 1);
    sum += 2.0 * window * lagged_product(residual, list, lag) / power *
           lagged_product(column, list, lag) / energy;
  }
  return std::max(1.0, std::max(1.0, power / used) * sum);
}

/// Rows by block of time, all channels together.
std::vector<std::vector<Index>> blocks_of(const std::vector<Row>& rows) {
  std::map<std::pair<std::size_t, long>, std::vector<Index>> blocks;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const long block = static_cast<long>(std::floor(rows[k].t / prior::kBlockSeconds));
    blocks[{rows[k].record, block}].push_back(static_cast<Index>(k));
  }
  std::vector<std::vector<Index>> list;
  for (auto& [key, block] : blocks) list.push_back(std::move(block));
  return list;
}

/// Chi-square gained in folds of blocks whose numbers come from the others, along the tangent,
/// curves as stiff as in a fit.
double held_out_gain(const Data& data, const Sketch& sketch, const MatrixXd& tangent,
                     const std::vector<std::vector<Index>>& blocks) {
  const VectorXd& residual = data.problem().residual;
  double gain = 0.0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    std::vector<Index> fit, held;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      auto& part = b % kFolds == fold ? held : fit;
      part.insert(part.end(), blocks[b].begin(), blocks[b].end());
    }
    const MatrixXd A = tangent(fit, Eigen::all);
    MatrixXd gram = A.transpose() * A;
    VectorXd score = A.transpose() * residual(fit);
    add_bending(data, sketch, gram, score);
    const VectorXd x = solve_gram(gram, score, 1e-9);
    const VectorXd there = residual(held);
    gain += there.squaredNorm() - (there - tangent(held, Eigen::all) * x).squaredNorm();
  }
  return gain;
}

/// Variance of the strength over blocks in units of what the noise makes of it: 1 where it is
/// constant.
double disagreement_of(const VectorXd& residual, const VectorXd& column, double amplitude,
                       const std::vector<std::vector<Index>>& blocks) {
  double sum = 0.0, count = 0.0;
  const double total = column.squaredNorm();
  for (const auto& block : blocks) {
    const VectorXd c = column(block);
    const double information = c.squaredNorm();
    if (!(information > 1e-6 * total)) continue;  // the law does not act there
    const double score = c.dot(residual(block)) - amplitude * information;
    sum += score * score / information;
    count += 1.0;
  }
  return count > 1.5 ? sum / (count - 1.0) : 0.0;
}

/// Whether a file could hold the law: of a shape far from its centre the amplitude has no bound.
bool has_bounded_numbers(const law::Law& law) {
  const auto numbers = law::numbers_of(law.structure);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const double value = law.numbers(static_cast<Index>(k));
    if (!(value >= numbers[k].low && value <= numbers[k].high)) return false;
  }
  return true;
}

/// Deviations of the law's numbers from the tangent's Gram matrix, references 0.
VectorXd deviations(const law::Structure& structure, const MatrixXd& tangent, double inflation) {
  const MatrixXd gram = tangent.transpose() * tangent;
  const MatrixXd inverse = solve_gram(gram, MatrixXd::Identity(gram.rows(), gram.cols()), 1e-9);
  const auto numbers = law::numbers_of(structure);
  VectorXd result = VectorXd::Zero(static_cast<Index>(numbers.size()));
  Index next = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (numbers[k].is_reference) continue;
    result(static_cast<Index>(k)) = std::sqrt(std::max(0.0, inflation * inverse(next, next)));
    ++next;
  }
  return result;
}

}  // namespace

Discovered judged(const Data& data, const Trial& trial) {
  const VectorXd& residual = data.problem().residual;
  const double amplitude = trial.sketch.amplitude;
  const MatrixXd tangent = tangent_of(data, trial.sketch);
  const auto blocks = blocks_of(data.problem().rows);
  Discovered found;
  found.law = law_of(trial.sketch, data.signals());
  found.gain = trial.gain;
  found.inflation = inflation_of(data, residual - amplitude * trial.column, trial.column);
  // The model's error is a share of gains, which a residual that is not white inflates as well.
  const double numbers = penalty(trial.sketch, 0.0);
  found.score = (trial.score + numbers) / found.inflation - numbers;
  found.held_out_gain = held_out_gain(data, trial.sketch, tangent, blocks);
  found.disagreement = disagreement_of(residual, trial.column, amplitude, blocks);
  found.deviation = deviations(found.law.structure, tangent, found.inflation);
  // Where not even its sign is known, other numbers undo the amplitude: the form is not told.
  found.established = found.disagreement <= prior::kConstant &&
                      std::abs(amplitude) > kNormal95 * found.deviation(0);
  return found;
}

bool is_accepted(const Discovered& found) {
  return has_bounded_numbers(found.law) && found.score >= prior::kAccepted &&
         found.held_out_gain >= prior::kHeldOutShare * found.gain;
}

}  // namespace dcnn::discovery
