// SPDX-License-Identifier: Apache-2.0
// Selectors against closed forms, and on two columns of twenty in little noise.
#include "dcnn/rivals/selectors.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"

namespace dcnn::rivals {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Columns are orthogonal with unit rms: least squares gives `ordinary`.
Block orthonormal_design(const VectorXd& ordinary, double rows) {
  const Index count = ordinary.size();
  return {rows * Eigen::MatrixXd::Identity(count, count), rows * ordinary,
          rows * (ordinary.squaredNorm() + 0.01), rows};
}

const VectorXd kOrdinary = (VectorXd(6) << 0.9, -0.5, 0.31, -0.29, 0.02, 0.0).finished();

TEST(Selectors, LassoOnAnOrthonormalDesignIsTheSoftThreshold) {
  const VectorXd theta = lasso(orthonormal_design(kOrdinary, 400.0), 0.3);
  for (Index k = 0; k < theta.size(); ++k) {
    const double shrunk = std::max(0.0, std::abs(kOrdinary(k)) - 0.3);
    EXPECT_NEAR(theta(k), std::copysign(shrunk, kOrdinary(k)), 1e-9) << k;
  }
}

TEST(Selectors, StlsqOnAnOrthonormalDesignIsTheHardThreshold) {
  const VectorXd theta = stlsq(orthonormal_design(kOrdinary, 400.0), 0.3);
  for (Index k = 0; k < theta.size(); ++k) {
    const double kept = std::abs(kOrdinary(k)) < 0.3 ? 0.0 : kOrdinary(k);
    EXPECT_NEAR(theta(k), kept, 1e-5) << k;  // the ridge
    EXPECT_EQ(theta(k) == 0.0, kept == 0.0) << k;
  }
}

/// Correlated columns, y exactly in the span of three.
TEST(Selectors, MatchingPursuitRecoversWhatIsExact) {
  constexpr Index kRows = 300, kColumns = 40;
  Rng rng(5);
  Eigen::MatrixXd X(kRows, kColumns);
  for (Index i = 0; i < kRows; ++i) {
    const double common = rng.normal();
    for (Index j = 0; j < kColumns; ++j) X(i, j) = rng.normal() + 0.3 * common;
  }
  VectorXd truth = VectorXd::Zero(kColumns);
  truth(3) = 1.5;
  truth(17) = -1.0;
  truth(31) = 0.7;
  VectorXd y = X * truth;
  for (Index i = 0; i < kRows; ++i) y(i) += 1e-3 * rng.normal();
  const VectorXd theta =
      matching_pursuit({X.transpose() * X, X.transpose() * y, y.squaredNorm(), double(kRows)});
  for (Index j = 0; j < kColumns; ++j) {
    EXPECT_NEAR(theta(j), truth(j), 1e-3) << j;
    EXPECT_EQ(theta(j) != 0.0, truth(j) != 0.0) << j;
  }
}

std::vector<Block> problem(double first, double second) {
  Rng rng(3);
  std::vector<Block> blocks;
  for (int k = 0; k < 12; ++k) {
    Eigen::MatrixXd X(250, 20);
    VectorXd y(250);
    for (Index i = 0; i < X.rows(); ++i) {
      for (Index j = 0; j < X.cols(); ++j) X(i, j) = rng.normal();
      y(i) = first * X(i, 4) + second * X(i, 11) + 0.1 * rng.normal();
    }
    blocks.push_back({X.transpose() * X, X.transpose() * y, y.squaredNorm(), 250.0});
  }
  return blocks;
}

std::vector<Group> singles() {
  std::vector<Group> groups;
  for (Index c = 0; c < 20; ++c) groups.push_back({c, c + 1});
  return groups;
}

/// The least error of cross-validation is known to keep too many.
Index most_false(const Method& method) { return method.name == "lasso-min" ? 18 : 0; }

TEST(Selectors, FindTheTwoColumns) {
  for (const Method& method : methods()) {
    const VectorXd theta = method.select(problem(0.8, -0.4), singles());
    EXPECT_NEAR(theta(4), 0.8, 0.02) << method.name;
    EXPECT_NEAR(theta(11), -0.4, 0.02) << method.name;
    EXPECT_LE((theta.array() != 0.0).count(), 2 + most_false(method)) << method.name;
  }
}

TEST(Selectors, FindNothingInNoise) {
  for (const Method& method : methods()) {
    const VectorXd theta = method.select(problem(0.0, 0.0), singles());
    EXPECT_LE((theta.array() != 0.0).count(), 1 + most_false(method)) << method.name;
  }
}

}  // namespace
}  // namespace dcnn::rivals
