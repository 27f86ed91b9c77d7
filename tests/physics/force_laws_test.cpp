// SPDX-License-Identifier: Apache-2.0
// Forces on the tool against their closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/support.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

TEST(Hysteresis, AgreesWithAFineIntegrationOfItsEquation) {
  for (const double asym : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    const double width = 0.2;
    Motion motion = still_motion(300);
    motion.euler.col(2) = (0.05 * Eigen::ArrayXd::LinSpaced(300, 0.0, 299.0)).sin() * 0.5;
    const auto effect = make_effect("hysteresis", "gamma:sensor_y",
                                    {{"force_n", 0.3}, {"width_rad", width}, {"asym", asym}});
    const Wrench wrench = applied(effect, motion, no_wrench(300));
    double z = 0.0, worst = 0.0;
    for (Index k = 1; k < 300; ++k) {
      const double dq = (motion.euler(k, 2) - motion.euler(k - 1, 2)) / 2000.0;
      const double sign = dq > 0.0 ? 1.0 : -1.0;
      for (int i = 0; i < 2000; ++i) {
        z += dq / width * (1.0 - (1.0 - asym) * sign * z - asym * std::abs(z));
      }
      worst = std::max(worst, std::abs(wrench.force(k, 1) + 0.3 * z));
    }
    EXPECT_LT(worst, 1e-4) << asym;
    EXPECT_LE(wrench.force.cwiseAbs().maxCoeff(), 0.3 * 1.000001) << asym;
  }
}

TEST(CableSpring, PullsTowardsItsRest) {
  Motion motion = still_motion(2);
  motion.euler.col(0) << 0.5, -0.3;
  const auto effect =
      make_effect("cable_spring", "alpha:base_x", {{"k_nprad", 2.0}, {"rest_rad", 0.1}});
  const VectorXd force = applied(effect, motion, no_wrench(2)).force.col(0);
  EXPECT_NEAR(force(0), -0.8, 1e-12);
  EXPECT_NEAR(force(1), 0.8, 1e-12);
}

TEST(Cogging, HasItsOrderInTheAngle) {
  Motion motion = still_motion(2);
  motion.euler.col(1) << 0.0, std::numbers::pi / 24.0;
  const auto effect = make_effect("cogging", "beta:sensor_z",
                                  {{"amp_n", 0.1}, {"order", 12.0}, {"phase_rad", 0.5}});
  const VectorXd force = applied(effect, motion, no_wrench(2)).force.col(2);
  EXPECT_NEAR(force(0), 0.1 * std::sin(0.5), 1e-12);
  EXPECT_NEAR(force(1), 0.1 * std::cos(0.5), 1e-12);
}

// The tool turns over: the slug falls through the gap in sqrt(2 gap/g) and hands its momentum to
// the stop.
TEST(LooseLoad, KnocksOnceWhenGravityTurns) {
  const double slug = 0.05, gap = 0.004;
  Motion motion = still_motion(200);
  for (std::size_t k = 100; k < 200; ++k) motion.R_BS[k] = Vector3d(1, -1, -1).asDiagonal();
  const auto effect = make_effect("loose_load", "sensor_z", {{"slug_kg", slug}, {"gap_m", gap}});
  const VectorXd force = applied(effect, motion, no_wrench(200)).force.col(2);
  EXPECT_EQ(force.head(95).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_NEAR(force(105), -slug * 9.81, 1e-6);  // weightless in its fall towards +z
  Index knock = 0;
  EXPECT_GT(force.maxCoeff(&knock), 1.0);
  EXPECT_NEAR(static_cast<double>(knock - 100) * 0.002, std::sqrt(2.0 * gap / 9.81), 0.003);
  EXPECT_NEAR(force.sum() * 0.002, 0.0, 1e-9);  // at rest before and after
  EXPECT_EQ(force.tail(50).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Contact, IsConstantInBaseAndOnlyInItsInterval) {
  const Motion motion = example_motion(1000);
  const Vector3d pushed(1.0, -2.0, 0.5);
  const auto effect = make_effect(
      "contact", "", {{"force_x_n", 1.0}, {"force_y_n", -2.0}, {"force_z_n", 0.5}}, {0.5, 1.0});
  const Wrench wrench = applied(effect, motion, no_wrench(1000));
  for (Index k = 0; k < 1000; ++k) {
    const Vector3d f_B = motion.R_BS[static_cast<std::size_t>(k)] * wrench.force.row(k).transpose();
    const bool inside = motion.t(k) >= 0.5 && motion.t(k) <= 1.0;
    EXPECT_LT((f_B - (inside ? pushed : Vector3d::Zero())).norm(), 1e-12) << k;
  }
  EXPECT_EQ(wrench.torque.cwiseAbs().maxCoeff(), 0.0);
}

TEST(CableField, IsTheCableOfTheEmbeddedData) {
  Motion motion = still_motion(1);
  motion.euler.row(0) = Vector3d(0.3, -0.2, 2.5);
  const Vector3d force =
      applied(make_effect("cable_field", "", {{"amp_n", 0.2}}), motion, no_wrench(1)).force.row(0);
  const Vector3d wanted =
      0.2 * Vector3d(std::sin(0.7), std::cos(0.4), std::sin(2.5) * std::cos(0.3));
  EXPECT_LT((force - wanted).norm(), 1e-12);
}

}  // namespace
}  // namespace dcnn
