// SPDX-License-Identifier: Apache-2.0
// The evidence against direct computation with whole covariances, and its noise against simulation.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/random.h"
#include "diagnosis/evidence/few_rows.h"
#include "diagnosis/evidence/marginal.h"
#include "diagnosis/evidence/posterior.h"
#include "diagnosis/evidence/slow_noise.h"

namespace dcnn::evidence {
namespace {

Eigen::MatrixXd normal_matrix(Index rows, Index columns, Rng& rng) {
  Eigen::MatrixXd X(rows, columns);
  for (double& x : X.reshaped()) x = rng.normal();
  return X;
}

/// ln N(y; 0, S) - ln N(y; 0, I).
double log_ratio(const Eigen::VectorXd& y, const Eigen::MatrixXd& S) {
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  const double determinant = 2.0 * llt.matrixL().toDenseMatrix().diagonal().array().log().sum();
  return 0.5 * (y.squaredNorm() - y.dot(llt.solve(y)) - determinant);
}

TEST(Evidence, OfProperPriorsIsThatOfTheWholeCovariance) {
  Rng rng({5});
  const Eigen::MatrixXd X = normal_matrix(40, 3, rng);
  const Eigen::VectorXd y = normal_matrix(40, 1, rng) + 0.7 * X.col(1);
  const Eigen::Vector3d precision(4.0, 0.25, 1.0);
  const Eigen::MatrixXd S =
      Eigen::MatrixXd::Identity(40, 40) + X * precision.cwiseInverse().asDiagonal() * X.transpose();
  EXPECT_NEAR(log_evidence(linear_model(X, y, precision)), log_ratio(y, S), 1e-6);
}

// A flat prior is a wide one whose density at its centre is taken as one.
// With 0.4 the law is another, which holds the name as often as not.
TEST(Evidence, OfANameBesideALawIsNoCertainty) {
  EXPECT_DOUBLE_EQ(with_elsewhere(0.98, 0.4), 0.6 * 0.98 + 0.4 * 0.5);
  EXPECT_DOUBLE_EQ(with_elsewhere(0.5, 0.4), 0.5);  // decides nothing
}

TEST(Evidence, OfAFlatPriorIsTheLimitOfWideOnes) {
  Rng rng({6});
  const Eigen::MatrixXd X = normal_matrix(30, 2, rng);
  const Eigen::VectorXd y = normal_matrix(30, 1, rng);
  const double narrow = 1e-8;
  const double wide = log_evidence(linear_model(X, y, Eigen::Vector2d(narrow, 2.0))) -
                      0.5 * std::log(narrow / (2.0 * std::numbers::pi));
  EXPECT_NEAR(log_evidence(linear_model(X, y, Eigen::Vector2d(0.0, 2.0))), wide, 1e-5);
}

// The integral over the noise's variance v, of density exp(-1/(2 v)) v^(-3/2)/sqrt(2 pi).
TEST(Evidence, OfFewRowsIsTheMeanOverTheirNoise) {
  constexpr double kStep = 1e-3;  // of ln v
  for (const double freedom : {0.0, 3.0, 20.0}) {
    for (const double square : {0.5, 9.0, 300.0}) {
      double sum = 0.0;
      for (double log = -20.0; log < 80.0; log += kStep) {
        sum +=
            kStep * std::exp(-0.5 * (square + 1.0) * std::exp(-log) - 0.5 * (freedom + 1.0) * log);
      }
      EXPECT_NEAR(log_student(square, freedom), std::log(sum), 1e-6);
    }
  }
}

// Of many rows the noise is known: then two models are as far apart as for noise of that size.
TEST(Evidence, OfManyRowsIsThatOfKnownNoise) {
  Rng rng({8});
  const Eigen::MatrixXd X = normal_matrix(4000, 2, rng);
  const Eigen::VectorXd y = normal_matrix(4000, 1, rng) + 0.1 * X.col(1);
  const Eigen::VectorXd flat = Eigen::VectorXd::Zero(2);
  const Linear both = linear_model(X, y, flat), one = linear_model(X.leftCols(1), y, flat.head(1));
  const double known = log_evidence(both) - log_evidence(one);
  EXPECT_NEAR(log_student_evidence(both, 4000.0) - log_student_evidence(one, 4000.0), known,
              0.05 * known);
}

TEST(Evidence, OfAFieldIsTheMeanOverItsSizes) {
  Rng rng({7});
  const Eigen::MatrixXd Phi = normal_matrix(25, 4, rng);
  const Eigen::VectorXd y = normal_matrix(25, 1, rng) + 0.4 * Phi.rowwise().sum();
  double tau = 0.0;
  const double got = log_field(Phi.transpose() * Phi, Phi.transpose() * y, 0.01, 10.0, &tau);
  std::vector<double> all;
  for (int k = 0; k < 28; ++k) {
    const double at = 0.01 * std::pow(1000.0, k / 27.0);
    all.push_back(
        log_ratio(y, Eigen::MatrixXd::Identity(25, 25) + at * at * Phi * Phi.transpose()) -
        std::log(28.0));
  }
  EXPECT_NEAR(got, log_sum(all), 1e-8);
  EXPECT_GT(tau, 0.1);
  EXPECT_LT(tau, 2.0);
}

// P(factor > 1/a) <= a where the noise is white (a Bayes factor under the null, Ville 1939).
TEST(Evidence, OfAFieldInNoiseSeldomSpeaksForIt) {
  Rng rng({8});
  int loud = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::MatrixXd Phi = normal_matrix(60, 5, rng);
    const Eigen::VectorXd y = normal_matrix(60, 1, rng);
    const double factor = log_field(Phi.transpose() * Phi, Phi.transpose() * y, 0.003, 300.0);
    loud += factor > std::log(20.0) ? 1 : 0;
  }
  EXPECT_LE(loud, kTrials / 20);
}

TEST(Evidence, LogarithmsOfSumsDoNotOverflow) {
  EXPECT_NEAR(log_sum({1000.0, 1000.0}), 1000.0 + std::log(2.0), 1e-9);
  EXPECT_NEAR(log_sum({-2000.0, 0.0}), 0.0, 1e-12);
}

}  // namespace
}  // namespace dcnn::evidence
