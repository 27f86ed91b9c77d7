// SPDX-License-Identifier: Apache-2.0
// Laws that no catalogue has are found in residuals, and none in noise.
#include <gtest/gtest.h>

#include "discovery/support.h"

namespace dcnn::discovery {
namespace {

constexpr double kDeviation = 0.01;  // N, of a block's noise

/// The hold-out error over that of the true law, on another motion.
double held_out_ratio(const std::vector<Discovered>& laws, const Truth& truth) {
  const Scene other = scene(77, 2000);
  const MatrixXd error = prediction(other, laws) - force_of(other, truth);
  return std::sqrt(1.0 + error.squaredNorm() / static_cast<double>(error.size()) /
                             (kDeviation * kDeviation));
}

std::vector<Discovered> discovered(const Truth& truth, std::uint64_t seed) {
  static const Scene at = scene(3, 2000);
  const MatrixXd residual = force_of(at, truth) + white(at.motion.samples(), kDeviation, seed);
  return discover(problem_of(at, residual, kDeviation));
}

double along_tool(const Motion& motion, Index k) {
  return motion.R_BS[static_cast<std::size_t>(k)].col(2).dot(motion.v_B.row(k));
}

void expect_found(const Truth& truth, const std::string& coordinate, std::uint64_t seed) {
  const auto laws = discovered(truth, seed);
  ASSERT_FALSE(laws.empty());
  EXPECT_NE(law::expression(laws[0].law).find(coordinate), std::string::npos);
  EXPECT_TRUE(laws[0].established);
  EXPECT_LE(held_out_ratio(laws, truth), 1.05) << law::expression(laws[0].law);
}

TEST(Discover, PowerOfTheSpeedAlongTheTool) {
  expect_found(
      [](const Motion& m, const MatrixXd&, Index k) {
        const double v = along_tool(m, k);
        return Eigen::Vector3d(Eigen::Vector3d::UnitZ() *
                               (-0.05 * std::copysign(std::pow(std::abs(v) / 0.1, 1.5), v)));
      },
      "v_tool_z", 11);
}

TEST(Discover, EddyBrakeAlongTheBase) {
  expect_found(
      [](const Motion& m, const MatrixXd&, Index k) {
        const double u = m.v_B(k, 1) / 0.08;
        const Eigen::Vector3d n = m.R_BS[static_cast<std::size_t>(k)].row(1);
        return Eigen::Vector3d(n * (-0.12 * u / (1.0 + u * u)));
      },
      "v_base_y", 12);
}

TEST(Discover, FrictionModulatedByAnAngle) {
  expect_found(
      [](const Motion& m, const MatrixXd&, Index k) {
        const double v = m.v_B(k, 0);
        const Eigen::Vector3d n = m.R_BS[static_cast<std::size_t>(k)].row(0);
        return Eigen::Vector3d(
            n * (-0.06 * std::tanh(v / 0.02) * (1.0 + 0.6 * std::sin(2.0 * m.euler(k, 2)))));
      },
      "gamma", 13);
}

TEST(Discover, DryFrictionAlongAnObliqueAxisOfTheSensor) {
  const Eigen::Vector3d e = Eigen::Vector3d(0.5, -0.3, 0.8).normalized();
  expect_found(
      [e](const Motion& m, const MatrixXd&, Index k) {
        const double v = (m.R_BS[static_cast<std::size_t>(k)] * e).dot(m.v_B.row(k));
        return Eigen::Vector3d(e * (-0.06 * std::tanh(v / 0.01)));
      },
      "v_along", 16);
}

TEST(Discover, SpringAlongAnObliqueAxisOfTheBase) {
  const Eigen::Vector3d e = Eigen::Vector3d(0.7, 0.6, -0.4).normalized();
  expect_found(
      [e](const Motion& m, const MatrixXd&, Index k) {
        const Eigen::Vector3d n = m.R_BS[static_cast<std::size_t>(k)].transpose() * e;
        return Eigen::Vector3d(n * (-1.5 * (e.dot(m.p_B.row(k)) - 0.3)));
      },
      "p_along", 17);
}

TEST(Discover, VoiceCoilInAnObliqueField) {
  const Eigen::Vector3d field(0.3, -0.8, 0.4);
  expect_found(
      [field](const Motion& m, const MatrixXd&, Index k) {
        const Eigen::Vector3d v = m.v_B.row(k);
        return Eigen::Vector3d(m.R_BS[static_cast<std::size_t>(k)].transpose() * v.cross(field));
      },
      "velocity_cross_base(", 18);
}

TEST(Discover, MagnetBesideThePath) {
  const Scene at = scene(3, 2000);
  const Eigen::Vector3d magnet =
      at.motion.p_B.colwise().mean().transpose() + Eigen::Vector3d(0.12, -0.07, 0.09);
  expect_found(
      [magnet](const Motion& m, const MatrixXd&, Index k) {
        const Eigen::Vector3d d = magnet - m.p_B.row(k).transpose();
        return Eigen::Vector3d(m.R_BS[static_cast<std::size_t>(k)].transpose() * d.normalized() *
                               (0.03 * std::pow(0.15 / d.norm(), 3)));
      },
      "from_point(", 19);
}

TEST(Discover, NothingInNoiseOfAnyColour) {
  const Scene at = scene(3, 2000);
  for (const double rho : {0.0, 0.95}) {
    MatrixXd noise = white(at.motion.samples(), kDeviation, 21);
    for (Index k = 1; k < noise.rows(); ++k) {
      noise.row(k) = rho * noise.row(k - 1) + std::sqrt(1.0 - rho * rho) * noise.row(k);
    }
    const auto laws = discover(problem_of(at, noise, kDeviation));
    EXPECT_TRUE(laws.empty()) << rho << " " << law::expression(laws[0].law) << " " << laws[0].gain
                              << " " << laws[0].inflation;
  }
}

TEST(Discover, TheSameTwice) {
  const Truth truth = [](const Motion& m, const MatrixXd&, Index k) {
    return Eigen::Vector3d(Eigen::Vector3d::UnitX() * (0.05 * m.w_S(k, 1) * m.v_B(k, 2)));
  };
  const auto once = discovered(truth, 15), again = discovered(truth, 15);
  ASSERT_EQ(once.size(), again.size());
  ASSERT_FALSE(once.empty());
  EXPECT_EQ(once[0].law.numbers, again[0].law.numbers);
  EXPECT_LE(held_out_ratio(once, truth), 1.05) << law::expression(once[0].law);
}

}  // namespace
}  // namespace dcnn::discovery
