// SPDX-License-Identifier: Apache-2.0
// Each friction law against its closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/support.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The force along z that an effect adds when the tool moves along base z with these velocities,
/// pressed with 2 N across its way.
VectorXd friction_force(const EffectSpec& effect, const VectorXd& v) {
  Motion motion = still_motion(v.size());
  motion.v_B.col(2) = v;
  Wrench wrench = no_wrench(v.size());
  wrench.load = wrench.force;
  wrench.load.col(0).setConstant(2.0);
  return applied(effect, motion, wrench).force.col(2);
}

/// Velocity of a position amplitude·sin(2 pi hz t).
VectorXd swing(double amplitude, double hz, Index samples) {
  const VectorXd t = still_motion(samples).t;
  return amplitude * 2.0 * std::numbers::pi * hz * (2.0 * std::numbers::pi * hz * t.array()).cos();
}

TEST(Coulomb, AtHighSpeedIsFcAgainstTheVelocity) {
  const auto effect = make_effect("coulomb_friction", "tool_z", {{"fc_n", 0.4}, {"v0_mps", 0.01}});
  const VectorXd force = friction_force(effect, Vector3d(1.0, -1.0, 0.01));
  EXPECT_NEAR(force(0), -0.4, 1e-9);
  EXPECT_NEAR(force(1), 0.4, 1e-9);
  EXPECT_NEAR(force(2), -0.4 * std::tanh(1.0), 1e-12);
}

TEST(Viscous, IsLinearAndQuadraticDragIsSquare) {
  const Vector3d v(0.1, -0.2, 0.4);
  const VectorXd linear =
      friction_force(make_effect("viscous_friction", "base_z", {{"c_nspm", 2.0}}), v);
  const VectorXd square =
      friction_force(make_effect("quadratic_drag", "tool_z", {{"c2_ns2pm2", 5.0}}), v);
  EXPECT_LT((linear + 2.0 * v).norm(), 1e-12);
  EXPECT_LT((square + 5.0 * v.cwiseProduct(v.cwiseAbs())).norm(), 1e-12);
}

TEST(Viscous, GrowsSlowerAtSpeedWhereItBends) {
  const Vector3d v(0.5, -1.5, 1e-9);
  const VectorXd force = friction_force(
      make_effect("viscous_friction", "base_z", {{"c_nspm", 2.0}, {"v1_mps", 1.5}}), v);
  EXPECT_NEAR(force(0), -2.0 * 0.5 / (1.0 + 0.5 / 1.5), 1e-12);
  EXPECT_NEAR(force(1), 0.5 * 2.0 * 1.5, 1e-12) << "half of the coefficient is lost there";
  EXPECT_NEAR(force(2) / v(2), -2.0, 1e-6);
}

TEST(Stribeck, FallsFromFsToFc) {
  const auto effect =
      make_effect("stribeck_friction", "tool_z",
                  {{"fc_n", 0.3}, {"fs_n", 0.6}, {"vs_mps", 0.03}, {"v0_mps", 1e-4}});
  const VectorXd force = friction_force(effect, Vector3d(1e-3, 0.03, 1.0));
  EXPECT_NEAR(force(0), -0.6, 1e-3);
  EXPECT_NEAR(force(1), -(0.3 + 0.3 * std::exp(-1.0)), 1e-9);
  EXPECT_NEAR(force(2), -0.3, 1e-9);
}

TEST(Friction, OnlyTakesEnergyOut) {
  const VectorXd v = swing(0.02, 1.0, 500);
  for (const auto* kind : effect_kinds()) {
    const std::string name = kind->name;
    if (kind->axis != AxisRule::kLine || kind->subject >= EffectKind::Subject::kMachines) continue;
    EXPECT_LT(friction_force(example_effect(*kind), v).dot(v), 0.0) << name;
    if (name == "lugre_friction") continue;  // gives back what its bristles hold
    EXPECT_LE(friction_force(example_effect(*kind), v).cwiseProduct(v).maxCoeff(), 0.0) << name;
  }
}

TEST(Friction, ActsAlongTheAxisItNames) {
  Motion motion = still_motion(1);
  motion.R_BS[0] = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  motion.v_B.row(0) = Vector3d(0.3, -0.2, 0.5);
  motion.w_S.row(0) = Vector3d(1.0, 2.0, 3.0);
  const auto force = [&](const std::string& axis) -> Vector3d {
    const auto effect = make_effect("viscous_friction", axis, {{"c_nspm", 2.0}});
    return applied(effect, motion, no_wrench(1)).force.row(0);
  };
  const Eigen::Matrix3d R = motion.R_BS[0];
  const Vector3d v_B = motion.v_B.row(0), v_S = R.transpose() * v_B;
  EXPECT_LT((force("tool_z") + 2.0 * v_S.z() * Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((force("base_y") + 2.0 * v_B.y() * R.transpose() * Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((force("w_sensor_x") + 2.0 * 1.0 * Vector3d::UnitX()).norm(), 1e-12);
  const Vector3d drag = force("base_x") + force("base_y") + force("base_z");
  EXPECT_LT((drag + 2.0 * v_S).norm(), 1e-12);
}

TEST(Friction, WithoutAVelocityIsAnErrorThatNamesTheColumns) {
  Motion motion = still_motion(3);
  motion.v_B = Eigen::MatrixXd(0, 3);
  const auto effect = make_effect("viscous_friction", "tool_z", {{"c_nspm", 2.0}});
  EXPECT_THROW(applied(effect, motion, no_wrench(3)), Error);
}

TEST(Lugre, IsASpringInPreslidingAndFcInSliding) {
  const auto effect = make_effect("lugre_friction", "tool_z",
                                  {{"fc_n", 0.5}, {"sigma0_npm", 1000.0}, {"sigma1_nspm", 0.0}});
  const VectorXd creep = VectorXd::Constant(11, 1e-5);  // 0.2 um in all, of a reach of 500 um
  EXPECT_NEAR(friction_force(effect, creep)(10), -1000.0 * 1e-5 * 0.02, 1e-6 * 0.2);
  const VectorXd slide = VectorXd::Constant(500, -0.1);
  EXPECT_NEAR(friction_force(effect, slide)(499), 0.5, 1e-9);
}

TEST(Lugre, AtConstantSpeedFollowsTheExponential) {
  const auto effect = make_effect("lugre_friction", "tool_z",
                                  {{"fc_n", 0.5}, {"sigma0_npm", 1000.0}, {"sigma1_nspm", 3.0}});
  const VectorXd force = friction_force(effect, VectorXd::Constant(200, 0.01));
  for (const Index k : {1, 10, 50, 199}) {
    const double left = std::exp(-0.01 * 0.002 * static_cast<double>(k) / 5e-4);
    EXPECT_NEAR(force(k), -(0.5 * (1.0 - left) + 3.0 * 0.01 * left), 1e-9) << k;
  }
}

TEST(Lugre, DoesNotDependOnTheSampleRateMuch) {
  const auto effect = make_effect("lugre_friction", "tool_z",
                                  {{"fc_n", 0.4}, {"sigma0_npm", 4000.0}, {"sigma1_nspm", 1.0}});
  const VectorXd fine = swing(0.01, 1.0, 1001);
  Motion motion = still_motion(101, 0.02);
  motion.v_B.col(2) = fine(Eigen::seq(0, 1000, 10));
  const VectorXd coarse = applied(effect, motion, no_wrench(101)).force.col(2);
  const VectorXd wanted = friction_force(effect, fine)(Eigen::seq(0, 1000, 10));
  EXPECT_LT((coarse - wanted).cwiseAbs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace dcnn
