// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/left_out.h"

#include <algorithm>
#include <cmath>

#include "core/linear_algebra.h"
#include "diagnosis/judgement.h"

namespace dcnn {
namespace {

constexpr double kFoldRidge = 1e-10;
constexpr double kElsewhere = 0.01;  // of a column's square, without which other pieces do not tell

/// Which piece of its recording each row belongs to, numbered over all recordings.
std::vector<int> pieces_of(const Setting& setting) {
  const auto& info = setting.whitener.row_info();
  std::vector<int> piece(info.size());
  for (std::size_t row = 0; row < info.size(); ++row) {
    piece[row] = static_cast<int>(info[row].log) * kRecordingParts +
                 part_of(setting.study.logs[info[row].log].motion, info[row].t);
  }
  return piece;
}

/// Sums of products of columns and target, over all rows and over each piece.
struct Sums {
  Eigen::MatrixXd gram;
  Eigen::VectorXd match;
};

/// Coefficients by all but one piece. A column that lives in that piece alone, as the state of a
/// cable when the recording begins, is told by no other: it stays zero.
Eigen::VectorXd fit_elsewhere(const Sums& whole, const Sums& own) {
  std::vector<Index> told;
  for (Index k = 0; k < whole.match.size(); ++k) {
    if (whole.gram(k, k) - own.gram(k, k) > kElsewhere * whole.gram(k, k)) told.push_back(k);
  }
  Eigen::VectorXd c = Eigen::VectorXd::Zero(whole.match.size());
  c(told) = solve_gram(whole.gram(told, told) - own.gram(told, told),
                       whole.match(told) - own.match(told), kFoldRidge);
  return c;
}

/// What a fit to all but one piece explains of that piece (or, with no piece left out, of all).
double explained(const Sums& all, const std::vector<Sums>& pieces,
                 const std::vector<Index>& columns, bool leave_out) {
  const auto part = [&](const Sums& sums) {
    return Sums{sums.gram(columns, columns), sums.match(columns)};
  };
  double sum = 0.0;
  const Sums whole = part(all);
  const Eigen::VectorXd fitted = solve_gram(whole.gram, whole.match, kFoldRidge);
  for (const Sums& piece : pieces) {
    const Sums own = part(piece);
    const Eigen::VectorXd c = leave_out ? fit_elsewhere(whole, own) : fitted;
    sum += 2.0 * c.dot(own.match) - c.dot(own.gram * c);
  }
  return sum;
}

}  // namespace

int part_of(const Motion& motion, double t) {
  const double first = motion.t(0), length = motion.t(motion.samples() - 1) - first;
  const double place = (t - first) / std::max(length, 1e-300);
  return std::clamp(static_cast<int>(kRecordingParts * place), 0, kRecordingParts - 1);
}

std::vector<double> left_out_shares(const Setting& setting, const JointFit& fit) {
  // The target as the tangent sees it: what is left, and what the members' own columns put there.
  Eigen::VectorXd back = Eigen::VectorXd::Zero(fit.tangent.cols());
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const auto [first, count] = tangent_columns(fit, m);
    const Member& member = fit.members[m];
    if (count == 0) continue;
    back.segment(first, member.amplitudes.size()) = member.amplitudes;
    // A lag is proportional to its only number, which the tangent knows on a logarithmic scale.
    if (member.amplitudes.size() == 0) back.segment(first, count).setOnes();
  }
  back.tail(fit.nuisance.size()) = fit.nuisance;
  const Eigen::VectorXd target = fit.residual + fit.tangent * back;
  const auto piece_of = pieces_of(setting);
  std::vector<std::vector<Index>> rows(setting.study.logs.size() * kRecordingParts);
  for (std::size_t row = 0; row < piece_of.size(); ++row) {
    rows[static_cast<std::size_t>(piece_of[row])].push_back(static_cast<Index>(row));
  }
  const Index width = fit.tangent.cols();
  Sums all{Eigen::MatrixXd::Zero(width, width), Eigen::VectorXd::Zero(width)};
  std::vector<Sums> pieces;
  for (const auto& list : rows) {
    if (list.empty()) continue;
    const Eigen::MatrixXd T = fit.tangent(list, Eigen::all);
    pieces.push_back({T.transpose() * T, T.transpose() * target(list)});
    all.gram += pieces.back().gram;
    all.match += pieces.back().match;
  }
  // Shapes stay: their tangents hold for small steps, and a piece that is left out asks for large
  // ones. A lag's only number moves.
  const auto moves = [&](const Member& member, Index column) {
    return member.amplitudes.size() == 0 || column < member.amplitudes.size();
  };
  std::vector<Index> every;
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const auto [first, count] = tangent_columns(fit, m);
    for (Index k = 0; k < count; ++k) {
      if (moves(fit.members[m], k)) every.push_back(first + k);
    }
  }
  for (Index k = fit.free_parameters(); k < width; ++k) every.push_back(k);
  std::vector<double> shares(fit.members.size(), 1.0);
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const auto [first, count] = tangent_columns(fit, m);
    if (count == 0) continue;
    std::vector<Index> others = every;
    std::erase_if(others,
                  [from = first, to = first + count](Index k) { return k >= from && k < to; });
    const double in = explained(all, pieces, every, false) - explained(all, pieces, others, false);
    const double out = explained(all, pieces, every, true) - explained(all, pieces, others, true);
    shares[m] = in > 0.0 ? out / in : 0.0;
  }
  return shares;
}

}  // namespace dcnn
