// SPDX-License-Identifier: Apache-2.0
#include "models/least_squares.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "models/recursive_least_squares.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd draw(Index rows, Index columns, std::uint64_t seed) {
  Rng rng(seed);
  MatrixXd result(rows, columns);
  for (double& value : result.reshaped()) value = rng.normal();
  return result;
}

LeastSquares rolled(const MatrixXd& a, const MatrixXd& y, Index piece) {
  LeastSquares sums(a.cols(), y.cols());
  for (Index first = 0; first < a.rows(); first += piece) {
    const Index n = std::min(piece, a.rows() - first);
    sums.add(a.middleRows(first, n), y.middleRows(first, n));
  }
  return sums;
}

TEST(LeastSquares, PiecesOfRowsAreTheWhole) {
  const MatrixXd a = draw(1000, 5, 1), y = a * draw(5, 2, 2) + 0.1 * draw(1000, 2, 3);
  const LeastSquares sums = rolled(a, y, 64);
  EXPECT_EQ(sums.rows(), 1000);
  EXPECT_TRUE((sums.factor().transpose() * sums.factor()).isApprox(a.transpose() * a, 1e-12));
  const MatrixXd plain = a.colPivHouseholderQr().solve(y);
  EXPECT_TRUE(
      sums.factor().triangularView<Eigen::Upper>().solve(sums.projected()).isApprox(plain, 1e-12));
  const VectorXd deviation = ((a * plain - y).colwise().norm() / std::sqrt(995.0)).transpose();
  EXPECT_TRUE(sums.residual_deviation().isApprox(deviation, 1e-10));
  EXPECT_TRUE(sums.target_rms().isApprox((y.colwise().norm() / std::sqrt(1000.0)).transpose()));
  EXPECT_TRUE(sums.column_rms().isApprox((a.colwise().norm() / std::sqrt(1000.0)).transpose()));
}

TEST(LeastSquares, ExactDataAreFittedExactlyInAnyUnits) {
  MatrixXd a = draw(200, 3, 1);
  const MatrixXd y = a * draw(3, 2, 2);
  a.col(1) *= 1e6;
  a.col(2) *= 1e-6;
  EXPECT_LT((a * solve(rolled(a, y, 50), {0, 1, 2}, 0.0) - y).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LeastSquares, RidgeIsThatOfTheMeanSquare) {
  const MatrixXd a = draw(400, 4, 1), y = draw(400, 1, 2);
  const LeastSquares sums = rolled(a, y, 50);
  const VectorXd size = group_sizes(sums.column_rms(), {0, 0, 1, 1});
  const double ridge = 0.3 * 400.0 + known_before(sums)[0];
  const MatrixXd normal = a.transpose() * a + ridge * MatrixXd(size.cwiseAbs2().asDiagonal());
  EXPECT_TRUE(
      solve(sums, {0, 0, 1, 1}, 0.3).isApprox(normal.llt().solve(a.transpose() * y), 1e-10));
}

TEST(LeastSquares, RepeatedAndEmptyColumnsStayFinite) {
  MatrixXd a = draw(200, 5, 1);
  a.col(3) = a.col(0);
  a.col(4).setZero();
  const MatrixXd exact = a.col(0) * 2.0 + a.col(1);
  for (const double noise : {0.0, 0.1}) {
    const MatrixXd y = exact + noise * draw(200, 1, 2);
    const MatrixXd weights = solve(rolled(a, y, 200), {0, 0, 0, 0, 1}, 0.0);
    EXPECT_LT(weights.cwiseAbs().maxCoeff(), 3.0);
    EXPECT_LT((a * weights - exact).cwiseAbs().maxCoeff(), 1e-10 + noise);
  }
  const MatrixXd nothing = MatrixXd::Zero(10, 2);
  EXPECT_TRUE(solve(rolled(nothing, nothing, 10), {0, 1}, 0.0).isZero(0.0));
}

TEST(LeastSquares, FewerRowsThanColumnsStayFinite) {
  const MatrixXd a = draw(3, 8, 1), y = draw(3, 2, 2);
  const MatrixXd weights = solve(rolled(a, y, 3), {0, 0, 0, 0, 0, 0, 0, 0}, 0.0);
  EXPECT_LT((a * weights - y).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT(weights.norm(), 10.0);
}

/// Weights forgetting^(n-1-i) on row i, and a ridge.
MatrixXd weighted(const MatrixXd& a, const MatrixXd& y, double forgetting, double ridge) {
  const Index n = a.rows(), p = a.cols();
  MatrixXd rows(n + p, p), wanted = MatrixXd::Zero(n + p, y.cols());
  for (Index i = 0; i < n; ++i) {
    const double root = std::pow(forgetting, 0.5 * static_cast<double>(n - 1 - i));
    rows.row(i) = root * a.row(i);
    wanted.row(i) = root * y.row(i);
  }
  rows.bottomRows(p) = std::sqrt(ridge) * MatrixXd::Identity(p, p);
  return rows.colPivHouseholderQr().solve(wanted);
}

TEST(RecursiveLeastSquares, IsBatchLeastSquaresWithExponentialWeights) {
  const MatrixXd a = draw(1200, 6, 1), y = a * draw(6, 2, 2) + draw(1200, 2, 3);
  for (const double forgetting : {1.0, 0.9999, 0.95}) {
    for (const double ridge : {1e-10, 1.0}) {
      RecursiveLeastSquares filter(6, 2, forgetting, ridge);
      for (Index i = 0; i < a.rows(); ++i) filter.update(a.row(i), y.row(i));
      EXPECT_LT((filter.solve() - weighted(a, y, forgetting, ridge)).cwiseAbs().maxCoeff(), 1e-8)
          << forgetting << " " << ridge;
    }
  }
}

TEST(RecursiveLeastSquares, CovarianceStaysBoundedWhereNothingMoves) {
  constexpr double kRidge = 1e-4, kForgetting = 0.99;
  RecursiveLeastSquares filter(4, 1, kForgetting, kRidge);
  Rng rng(1);
  const Eigen::Vector4d truth(1.0, -2.0, 3.0, 0.5);
  double largest = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    // All directions at first, then one alone for a time in which 1e-436 of the rest remains.
    const Eigen::Vector4d terms =
        i < 100 ? Eigen::Vector4d(rng.normal(), rng.normal(), rng.normal(), rng.normal())
                : Eigen::Vector4d(1.0, 0.0, 0.0, 0.0);
    filter.update(terms, Eigen::VectorXd::Constant(1, terms.dot(truth)));
    if (i % 997 == 0) largest = std::max(largest, filter.covariance_trace());
  }
  EXPECT_LE(largest, 4.0 / (kRidge * std::pow(kForgetting, 4)));
  EXPECT_TRUE(filter.solve().allFinite());
  EXPECT_NEAR(filter.solve()(0, 0), 1.0, 1e-4);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector4d terms(rng.normal(), rng.normal(), rng.normal(), rng.normal());
    filter.update(terms, Eigen::VectorXd::Constant(1, terms.dot(truth)));
  }
  EXPECT_LT((filter.solve() - truth).cwiseAbs().maxCoeff(), 1e-4) << "it learns again";
}

}  // namespace
}  // namespace dcnn
