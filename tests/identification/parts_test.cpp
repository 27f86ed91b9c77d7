// SPDX-License-Identifier: Apache-2.0
// The parts of the identification against finite differences, closed forms and a known body.
#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "identification/physical.h"

namespace dcnn::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

WristColumns random_columns(Index n, Rng& rng) {
  WristColumns c;
  const auto fill = [&](Index width) {
    MatrixXd m(n, width);
    for (double& v : m.reshaped()) v = rng.normal();
    return m;
  };
  c.y = fill(6);
  c.field = fill(3);
  c.swing = fill(9);
  c.spin = fill(18);
  c.laws = fill(12);
  return c;
}

WristState some_state(Rng& rng) {
  WristState s;
  s.mass = 1.3;
  s.h = {0.1, -0.2, 0.3};
  s.inertia = Vector3d(0.3, 0.4, 0.5).asDiagonal();
  s.R_SE = rotation_of({rng.normal(), rng.normal(), rng.normal()});
  s.amplitudes = Eigen::Vector2d(0.5, -0.25);
  return s;
}

TEST(WristModel, ItsJacobianIsThatOfFiniteDifferences) {
  Rng rng(4);
  const WristColumns c = random_columns(5, rng);
  const WristState state = some_state(rng);
  Layout layout;
  layout.torque = true;
  layout.amplitudes = 2;
  const MatrixXd J = jacobian(c, state, layout);
  for (Index k = 0; k < layout.size(); ++k) {
    const VectorXd step = 1e-6 * VectorXd::Unit(layout.size(), k);
    const MatrixXd up = predicted(c, moved(state, layout, step));
    const MatrixXd down = predicted(c, moved(state, layout, -step));
    const MatrixXd slope = (up - down) / 2e-6;
    EXPECT_LT((J.col(k) - slope.reshaped()).cwiseAbs().maxCoeff(), 1e-7) << k;
  }
}

TEST(Whitener, MakesAnAutoregressionWhiteAndKnowsItsSize) {
  Rng rng(9);
  const Index n = 20000;
  VectorXd x(n);
  double state = 0.0;
  for (Index k = 0; k < n; ++k) x[k] = state = 0.9 * state + 0.5 * rng.normal();
  const std::vector<Segment> segments{{0, n / 2}, {n / 2, n}};
  const ChannelNoise noise(x, segments, 0.0);
  MatrixXd white = x;
  noise.whiten(white, segments);
  const VectorXd w = white.col(0);
  EXPECT_NEAR(w.squaredNorm() / static_cast<double>(n), 1.0, 0.01);
  EXPECT_NEAR(w.head(n - 1).dot(w.tail(n - 1)) / static_cast<double>(n), 0.0, 0.03);
  EXPECT_NEAR(noise.deviation(), 0.5 / std::sqrt(1.0 - 0.81), 0.05);
}

WristFit fit_about(const Vector3d& moments, double sd) {
  WristFit fit;
  fit.layout.torque = true;
  fit.state.mass = 1.0;
  fit.state.inertia = moments.asDiagonal();
  fit.state.amplitudes = VectorXd(0);
  fit.covariance = 1e-6 * MatrixXd::Identity(fit.layout.size(), fit.layout.size());
  for (Index k = 4; k < 10; ++k) fit.covariance(k, k) = sd * sd;
  fit.freedom = 1e6;
  return fit;
}

TEST(Draws, OfABodyFarFromTheBoundaryAreThoseOfTheNormalDistribution) {
  Rng rng(2);
  const WristFit fit = fit_about({0.02, 0.02, 0.02}, 1e-4);
  const Draws draws = draw_states(fit, 4000, rng);
  EXPECT_FALSE(draws.constrained);
  EXPECT_EQ(draws.inside, 1.0);
  double sum = 0.0, square = 0.0;
  for (const WristState& s : draws.states) {
    sum += s.inertia(0, 0);
    square += std::pow(s.inertia(0, 0) - 0.02, 2);
  }
  EXPECT_NEAR(sum / 4000, 0.02, 1e-5);
  EXPECT_NEAR(std::sqrt(square / 4000), 1e-4, 5e-6);
}

TEST(Draws, OfWhatIsNoBodyAreBodies) {
  Rng rng(3);
  // Ixx = -0.01: no body, some ten deviations off.
  const WristFit fit = fit_about({-0.01, 0.02, 0.02}, 1e-3);
  const Draws draws = draw_states(fit, 500, rng);
  EXPECT_TRUE(draws.constrained);
  ASSERT_EQ(draws.states.size(), 500U);
  for (const WristState& s : draws.states) {
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(pseudo_inertia_of(s))
                  .eigenvalues().minCoeff(), 0.0);
  }
  const WristState mean = mean_state(fit, draws);
  EXPECT_GT(mean.inertia(0, 0), 0.0);
}

}  // namespace
}  // namespace dcnn::identification
