// SPDX-License-Identifier: Apache-2.0
#include "models/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

/// e = A·w - b.
class Linear : public NonlinearLeastSquares {
 public:
  Linear(Index rows, Index columns, std::uint64_t seed) : a(rows, columns), b(rows) {
    Rng rng(seed);
    for (double& value : a.reshaped()) value = rng.normal();
    for (double& value : b) value = rng.normal();
  }
  double loss(const Eigen::VectorXd& w) const override {
    return (a * w - b).squaredNorm() / static_cast<double>(b.size());
  }
  NormalEquations linearise(const Eigen::VectorXd& w) const override {
    const auto n = static_cast<double>(b.size());
    return {a.transpose() * a / n, a.transpose() * (a * w - b) / n};
  }
  Eigen::VectorXd optimum() const { return a.colPivHouseholderQr().solve(b); }

  Eigen::MatrixXd a;
  Eigen::VectorXd b;
};

/// Rosenbrock's valley as errors 10(w2 - w1²) and 1 - w1.
class Rosenbrock : public NonlinearLeastSquares {
 public:
  static Eigen::Vector2d errors(const Eigen::VectorXd& w) {
    return {10.0 * (w[1] - w[0] * w[0]), 1.0 - w[0]};
  }
  double loss(const Eigen::VectorXd& w) const override { return errors(w).squaredNorm() / 2.0; }
  NormalEquations linearise(const Eigen::VectorXd& w) const override {
    Eigen::Matrix2d j;
    j << -20.0 * w[0], 10.0, -1.0, 0.0;
    return {j.transpose() * j / 2.0, j.transpose() * errors(w) / 2.0};
  }
};

/// A loss the training does not look at: its least value lies near `w`.
class Distance : public NonlinearLeastSquares {
 public:
  explicit Distance(Eigen::VectorXd w) : goal(std::move(w)) {}
  double loss(const Eigen::VectorXd& w) const override { return (w - goal).squaredNorm(); }
  NormalEquations linearise(const Eigen::VectorXd&) const override { return {}; }
  Eigen::VectorXd goal;
};

LevenbergMarquardt::Settings settings(Index epochs = 1000) {
  LevenbergMarquardt::Settings result;
  result.epochs = epochs;
  return result;
}

TEST(LevenbergMarquardt, ReachesTheLeastSquaresOptimum) {
  const Linear problem(80, 6, 1);
  LevenbergMarquardt optimiser(problem, nullptr, settings(), Eigen::VectorXd::Zero(6));
  while (!optimiser.done()) optimiser.iterate();
  EXPECT_LT(optimiser.epoch(), 20);
  EXPECT_LT((optimiser.best() - problem.optimum()).norm(), 1e-6);
}

TEST(LevenbergMarquardt, FollowsRosenbrocksValley) {
  const Rosenbrock problem;
  LevenbergMarquardt optimiser(problem, nullptr, settings(), Eigen::Vector2d(-1.2, 1.0));
  while (!optimiser.done()) optimiser.iterate();
  EXPECT_LT((optimiser.best() - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-5);
}

/// Spec 2.3: a step that helps divides mu by ten, one that does not multiplies it.
TEST(LevenbergMarquardt, DampingFollowsTheSchedule) {
  const Linear problem(80, 6, 1);
  LevenbergMarquardt optimiser(problem, nullptr, settings(), Eigen::VectorXd::Zero(6));
  ASSERT_TRUE(optimiser.iterate());
  EXPECT_DOUBLE_EQ(optimiser.mu(), 1e-4);
  const Eigen::VectorXd gradient = problem.linearise(Eigen::VectorXd::Zero(6)).gradient;
  Eigen::MatrixXd damped = problem.linearise(Eigen::VectorXd::Zero(6)).hessian;
  damped.diagonal().array() += 1e-3;
  EXPECT_LT((optimiser.weights() + damped.inverse() * gradient).norm(), 1e-12);

  const Rosenbrock valley;
  LevenbergMarquardt winding(valley, nullptr, settings(), Eigen::Vector2d(-1.2, 1.0));
  double before = winding.mu(), loss = winding.loss();
  while (winding.iterate() && !winding.done()) {
    const double tried = std::log10(winding.mu() / before) + 1.0;  // steps that did not help
    EXPECT_NEAR(tried, std::round(tried), 1e-9);
    EXPECT_GE(tried, -1e-9);
    EXPECT_LT(winding.loss(), loss);
    before = winding.mu();
    loss = winding.loss();
  }
}

TEST(LevenbergMarquardt, StopsAfterSixEpochsWithoutBetterValidation) {
  const Rosenbrock problem;
  const Eigen::Vector2d start(-1.2, 1.0);
  LevenbergMarquardt plain(problem, nullptr, settings(3), start);
  while (!plain.done()) plain.iterate();
  const Distance near_third(plain.weights());
  LevenbergMarquardt watched(problem, &near_third, settings(), start);
  Index best = 0;
  while (!watched.done()) {
    watched.iterate();
    if (watched.is_best()) best = watched.epoch();
  }
  EXPECT_EQ(best, 3);
  EXPECT_EQ(watched.epoch(), 9);
  EXPECT_EQ(watched.best(), plain.weights());
  EXPECT_NE(watched.weights(), watched.best());
}

/// Weights that minimise it already: no step, and no crash on a singular system.
TEST(LevenbergMarquardt, EndsWhereNothingHelps) {
  Linear problem(10, 3, 1);
  problem.a.col(2) = problem.a.col(1);
  LevenbergMarquardt first(problem, nullptr, settings(), Eigen::VectorXd::Zero(3));
  while (!first.done()) first.iterate();
  LevenbergMarquardt again(problem, nullptr, settings(), first.best());
  EXPECT_FALSE(again.iterate());
  EXPECT_TRUE(again.done());
  EXPECT_EQ(again.best(), first.best());
}

TEST(LevenbergMarquardt, RefusesAForeignState) {
  const Linear problem(10, 3, 1), other(10, 4, 1);
  const Container file =
      LevenbergMarquardt(other, nullptr, settings(), Eigen::VectorXd::Zero(4)).save();
  LevenbergMarquardt optimiser(problem, nullptr, settings(), Eigen::VectorXd::Zero(3));
  EXPECT_THROW(optimiser.restore(file), Error);
  EXPECT_THROW(optimiser.restore({}), Error);
}

}  // namespace
}  // namespace dcnn
