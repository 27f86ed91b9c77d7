// SPDX-License-Identifier: Apache-2.0
#include "models/least_squares.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "core/linear_algebra.h"

namespace dcnn {
namespace {

constexpr double kRank = 1e-11;    // relative size of a singular value that is rounding
constexpr double kLargest = 10.0;  // one term may be this many times the target: terms cancel
// Derivatives over 0.1 s make the errors of some 50 rows at 500 Hz alike.
constexpr double kCorrelated = 50.0;

}  // namespace

LeastSquares::LeastSquares(Index columns, Index targets)
    : columns_(columns), triangle_(Eigen::MatrixXd::Zero(columns + targets, columns + targets)) {}

void LeastSquares::add(const Eigen::MatrixXd& a, const Eigen::MatrixXd& y) {
  assert(a.cols() == columns_ && a.rows() == y.rows());
  const Index width = triangle_.cols();
  Eigen::MatrixXd stacked(width + a.rows(), width);
  stacked.topRows(width) = triangle_;
  stacked.bottomRows(a.rows()) << a, y;
  triangle_ = triangle_of(std::move(stacked));
  rows_ += a.rows();
}

Eigen::MatrixXd LeastSquares::factor() const { return triangle_.topLeftCorner(columns_, columns_); }

Eigen::MatrixXd LeastSquares::projected() const {
  return triangle_.topRightCorner(columns_, triangle_.cols() - columns_);
}

Eigen::VectorXd LeastSquares::residual_deviation() const {
  const Index targets = triangle_.cols() - columns_;
  const auto freedom = static_cast<double>(std::max<Index>(1, rows_ - columns_));
  return triangle_.bottomRightCorner(targets, targets).colwise().norm().transpose() /
         std::sqrt(freedom);
}

Eigen::VectorXd LeastSquares::target_rms() const {
  return triangle_.rightCols(triangle_.cols() - columns_).colwise().norm().transpose() /
         std::sqrt(static_cast<double>(std::max<Index>(1, rows_)));
}

Eigen::VectorXd LeastSquares::column_rms() const {
  return triangle_.leftCols(columns_).colwise().norm().transpose() /
         std::sqrt(static_cast<double>(std::max<Index>(1, rows_)));
}

Eigen::VectorXd solve(const DenseProblem& problem) {
  const Eigen::VectorXd inverse_size =
      problem.size.unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 1.0; });
  const auto [U, V, d] = singular_values(problem.a * inverse_size.asDiagonal());
  Eigen::VectorXd filter = d;
  for (double& value : filter) {
    value = value > kRank * d[0] ? value / (value * value + problem.ridge) : 0.0;
  }
  const Eigen::VectorXd along = U.transpose() * problem.y;
  return inverse_size.asDiagonal() * (V * filter.cwiseProduct(along));
}

Eigen::VectorXd known_before(const LeastSquares& sums) {
  const Eigen::VectorXd rms = sums.target_rms();
  const Eigen::ArrayXd share =
      sums.residual_deviation().cwiseQuotient((rms.array() > 0.0).select(rms, 1.0).matrix());
  return kCorrelated * (share / kLargest).square();
}

Eigen::VectorXd group_sizes(const Eigen::VectorXd& rms, const std::vector<Index>& groups) {
  std::map<Index, std::pair<double, double>> sums;  // of squares, and how many
  for (std::size_t k = 0; k < groups.size(); ++k) {
    auto& [square, count] = sums[groups[k]];
    square += std::pow(rms[static_cast<Index>(k)], 2);
    count += 1.0;
  }
  Eigen::VectorXd sizes(rms.size());
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const auto& [square, count] = sums[groups[k]];
    sizes[static_cast<Index>(k)] = std::sqrt(square / count);
  }
  return sizes;
}

Eigen::MatrixXd solve(const LeastSquares& sums, const std::vector<Index>& groups, double ridge) {
  const Eigen::MatrixXd projected = sums.projected();
  const Eigen::VectorXd known = known_before(sums);
  DenseProblem problem{sums.factor(), {}, group_sizes(sums.column_rms(), groups)};
  Eigen::MatrixXd weights(projected.rows(), projected.cols());
  for (Index j = 0; j < projected.cols(); ++j) {
    problem.y = projected.col(j);
    problem.ridge = known[j] + ridge * static_cast<double>(sums.rows());
    weights.col(j) = solve(problem);
  }
  return weights;
}

}  // namespace dcnn
