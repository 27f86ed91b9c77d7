// SPDX-License-Identifier: Apache-2.0
// Laws that hardware has beside the simplest ones, each against its closed form.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "dcnn/physics/axis_machine.h"
#include "physics/support.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The motion of an axis at these positions, 2 ms apart, with these velocities.
Motion axis_at(const VectorXd& q, const VectorXd& v) {
  Motion motion = still_motion(q.size());
  motion.of_axis = true;
  motion.euler.col(0) = q;
  motion.v_B.col(0) = v;
  return motion;
}

Wrench pressed(const Eigen::MatrixXd& load) {
  Wrench wrench = no_wrench(load.rows());
  wrench.load = load;
  return wrench;
}

TEST(LoadFriction, OfAToolIsMuTimesTheLoadAcrossItsWay) {
  Motion motion = still_motion(2);
  motion.v_B.row(0) = Vector3d(0.5, 0.0, 0.0);
  motion.v_B.row(1) = Vector3d(-0.5, 0.0, 0.0);
  const auto effect = make_effect("load_friction", "base_x", {{"mu", 0.2}, {"v0_mps", 0.001}});
  const Eigen::MatrixXd load = Vector3d(7.0, 3.0, -4.0).transpose().replicate(2, 1);
  const Wrench after = applied(effect, motion, pressed(load));
  EXPECT_NEAR(after.force(0, 0), -0.2 * 5.0, 1e-12);
  EXPECT_NEAR(after.force(1, 0), 0.2 * 5.0, 1e-12);
  EXPECT_LT(after.force.rightCols(2).norm(), 1e-12);
}

TEST(LoadFriction, OfAnAxisIsMuTimesWhatItTransmits) {
  const Motion motion = axis_at(Vector3d::Zero(), Vector3d(0.5, 0.5, -0.5));
  const auto effect = make_effect("load_friction", "base_x", {{"mu", 0.1}, {"v0_mps", 0.001}});
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(3, 3);
  load.col(0) = Vector3d(20.0, -10.0, -30.0);
  const VectorXd force = applied(effect, motion, pressed(load)).force.col(0);
  EXPECT_LT((force - Vector3d(-2.0, -1.0, 3.0)).norm(), 1e-12);
}

// What the drive carries beside what is simulated loads its gears as well: of an axis with nothing
// simulated its weight and its inertia, whatever their order.
TEST(LoadFriction, OfAnAxisIsOfTheForcesThatItsDriveCarries) {
  VectorXd q(3), v(3);
  q << 0.3, 1.2, -0.8;
  v << 0.5, -0.5, 0.5;
  Motion motion = axis_at(q, v);
  motion.a_B = Eigen::MatrixXd::Zero(3, 3);
  motion.a_B.col(0) << 2.0, -1.0, 4.0;
  const std::vector<EffectSpec> effects{
      make_effect("load_friction", "base_x", {{"mu", 0.1}, {"v0_mps", 1e-3}}),
      make_effect("coulomb_friction", "base_x", {{"fc_n", 3.0}, {"v0_mps", 1e-3}}),
      make_effect("gravity_load", "alpha:base_x", {{"amp_n", 8.0}, {"rest_rad", 0.0}}),
      make_effect("inertia", "base_x", {{"delta_inertia_kg", 0.5}})};
  Wrench wrench = no_wrench(3);
  pass_on(effects, Stage::kForce, motion, ToolModel(), wrench);
  for (Index k = 0; k < 3; ++k) {
    const double carried = -8.0 * std::sin(q(k)) - 0.5 * motion.a_B(k, 0);
    const double friction = std::copysign(3.0 + 0.1 * std::abs(carried), -v(k));
    EXPECT_NEAR(wrench.force(k, 0), carried + friction, 1e-12) << k;
    InstantWrench now;  // and sample by sample, in the order of the catalogue
    now.of_axis = true;
    Instant at;
    at.euler[0] = q(k), at.v_B[0] = v(k), at.a_B[0] = motion.a_B(k, 0);
    for (const EffectKind* kind : effect_kinds()) {
      for (const EffectSpec& effect : effects) {
        if (effect.effect == kind->name) stream_of(effect, "test", Exit::kData)(now, at);
      }
    }
    EXPECT_NEAR(now.force[0], wrench.force(k, 0), 1e-12) << k;
  }
}

// At a constant speed the bristles settle at g(v), before that they are a spring of sigma0; a step
// of any length ends there.
TEST(LugreFriction, FallsWithSpeedBeyondItsPresliding) {
  constexpr Index kRowsOfSlide = 400;
  const auto effect = make_effect("lugre_friction", "base_x",
                                  {{"fc_n", 2.0},
                                   {"fs_n", 3.0},
                                   {"vs_mps", 0.1},
                                   {"sigma0_npm", 1000.0},
                                   {"sigma1_nspm", 0.0}});
  for (const double speed : {0.01, 0.1, 0.5, -0.1}) {
    const VectorXd v = VectorXd::Constant(kRowsOfSlide, speed);
    const VectorXd force =
        applied(effect, axis_at(VectorXd::Zero(kRowsOfSlide), v), no_wrench(kRowsOfSlide))
            .force.col(0);
    const double settled = 2.0 + std::exp(-speed * speed / 0.01), way = 0.002 * speed;
    EXPECT_NEAR(
        force(1),
        -std::copysign(settled, speed) * (1.0 - std::exp(-std::abs(way) * 1000.0 / settled)), 1e-9)
        << speed;
    const double left = std::exp(-kRowsOfSlide * std::abs(way) * 1000.0 / settled);
    EXPECT_NEAR(force(kRowsOfSlide - 1), -std::copysign(settled, speed),
                1.1 * settled * left + 1e-9)
        << speed;
  }
}

// The load is the body's, whatever other friction acts: two guides do not load each other.
TEST(LoadFriction, DoesNotDependOnOtherFriction) {
  const Motion motion = example_motion(300);
  const auto with = [&](const std::vector<EffectSpec>& effects) -> Eigen::MatrixXd {
    return simulate({example_tool(), effects}, motion).force;
  };
  const auto x = make_effect("load_friction", "base_x", {{"mu", 0.2}, {"v0_mps", 0.01}});
  const auto y = make_effect("load_friction", "base_y", {{"mu", 0.1}, {"v0_mps", 0.01}});
  const auto dry = make_effect("coulomb_friction", "base_z", {{"fc_n", 2.0}, {"v0_mps", 0.01}});
  EXPECT_LT((with({x, y, dry}) + 2.0 * with({}) - with({x}) - with({y}) - with({dry})).norm(),
            1e-9);
}

TEST(GearFriction, VariesWithThePositionAndResists) {
  const VectorXd q = VectorXd::LinSpaced(400, 0.0, 2.0 * std::numbers::pi);
  const auto effect = make_effect(
      "gear_friction", "alpha:base_x",
      {{"fc_n", 2.0}, {"a", 0.5}, {"order", 3.0}, {"phase_rad", 0.7}, {"v0_mps", 1e-4}});
  for (const double v : {0.4, -0.4}) {
    const VectorXd force =
        applied(effect, axis_at(q, VectorXd::Constant(400, v)), no_wrench(400)).force.col(0);
    for (Index k = 0; k < 400; k += 37) {
      const double size = 2.0 * (1.0 + 0.5 * std::sin(3.0 * q(k) + 0.7));
      EXPECT_NEAR(force(k), std::copysign(size, -v), 1e-9) << k;
    }
  }
}

TEST(GearFriction, IsLinearInItsAmplitudes) {
  const EffectFit& form = find_effect("gear_friction")->fits[0];
  const Json numbers = form.parameters(Vector3d(2.0, 0.6, 0.8), Eigen::Vector2d(5.0, 0.01));
  EXPECT_NEAR(numbers["a"], 0.5, 1e-12);
  EXPECT_NEAR(numbers["phase_rad"], std::atan2(0.8, 0.6), 1e-12);
}

TEST(QuadraticSpring, PullsOneWayWithTheSquare) {
  const auto effect =
      make_effect("quadratic_spring", "alpha:base_x", {{"k2_nprad2", 3.0}, {"rest_rad", 0.2}});
  const Vector3d q(0.2, 0.7, -0.3);
  const VectorXd force = applied(effect, axis_at(q, Vector3d::Zero()), no_wrench(3)).force.col(0);
  EXPECT_LT((force - Vector3d(0.0, -0.75, -0.75)).norm(), 1e-12);
}

TEST(GravityLoad, PullsTowardsWhereItHangs) {
  const auto effect =
      make_effect("gravity_load", "alpha:base_x", {{"amp_n", 3.0}, {"rest_rad", 0.2}});
  const Vector3d q(0.2, 0.7, 0.2 - std::numbers::pi / 2.0);
  const VectorXd force = applied(effect, axis_at(q, Vector3d::Zero()), no_wrench(3)).force.col(0);
  EXPECT_LT((force - Vector3d(0.0, -3.0 * std::sin(0.5), 3.0)).norm(), 1e-12);
}

TEST(AsymmetricFriction, HasAnotherCoefficientInEachDirection) {
  // 3 forwards and 2 backwards are 2.5 in the mean and half a difference of 0.5.
  const Motion motion = axis_at(Eigen::Vector2d::Zero(), Eigen::Vector2d(0.4, -0.4));
  Wrench wrench = no_wrench(2);
  wrench = applied(make_effect("viscous_friction", "base_x", {{"c_nspm", 2.5}}), motion, wrench);
  wrench = applied(make_effect("asymmetric_friction", "base_x", {{"delta_c_nspm", 0.5}}), motion,
                   wrench);
  EXPECT_NEAR(wrench.force(0, 0), -3.0 * 0.4, 1e-12);
  EXPECT_NEAR(wrench.force(1, 0), 2.0 * 0.4, 1e-12);
}

TEST(Creep, AfterAStepOfLoadFollowsTheExponential) {
  const auto effect = make_effect("creep", "", {{"a", 0.05}, {"tau_s", 0.3}});
  Wrench wrench = no_wrench(1000);
  wrench.force.col(2).tail(999).setConstant(10.0);
  const VectorXd reading = applied(effect, still_motion(1000), wrench).force.col(2);
  EXPECT_EQ(reading(0), 0.0);
  for (const Index k : {1, 50, 300, 999}) {
    // The load rises within the first step: half a step later in the mean.
    const double t = 0.002 * (static_cast<double>(k) - 0.5);
    EXPECT_NEAR(reading(k), 10.0 * (1.0 + 0.05 * (1.0 - std::exp(-t / 0.3))), 1e-5) << k;
  }
}

TEST(Creep, BeginsInEquilibrium) {
  const auto effect = make_effect("creep", "", {{"a", 0.05}, {"tau_s", 0.3}});
  Wrench wrench = no_wrench(100);
  wrench.force.col(0).setConstant(4.0);
  const VectorXd reading = applied(effect, still_motion(100), wrench).force.col(0);
  EXPECT_LT((reading.array() - 4.2).abs().maxCoeff(), 1e-12);
}

/// The force of a hysteresis while the angle goes to and fro.
VectorXd hysteresis_force(const Json& parameters, const VectorXd& q) {
  const auto effect = make_effect("hysteresis", "alpha:base_x", parameters);
  return applied(effect, axis_at(q, VectorXd::Zero(q.size())), no_wrench(q.size())).force.col(0);
}

VectorXd to_and_fro(Index samples) {
  VectorXd q(samples);
  for (Index k = 0; k < samples; ++k) {
    const double t = 12.0 * static_cast<double>(k) / static_cast<double>(samples - 1);
    q(k) = 0.4 * std::sin(t) + 0.1 * std::sin(3.1 * t);
  }
  return q;
}

TEST(Hysteresis, BetaAndGammaAreAnotherNameForTheAsymmetry) {
  const VectorXd q = to_and_fro(500);
  const VectorXd old = hysteresis_force({{"force_n", 2.0}, {"width_rad", 0.2}, {"asym", 0.3}}, q);
  const VectorXd same = hysteresis_force(
      {{"force_n", 2.0}, {"width_rad", 0.2}, {"beta", 0.7}, {"gamma", 0.3}, {"m", 1.0}}, q);
  EXPECT_LT((old - same).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Hysteresis, OfTheOtherSignSteepensByTheExponential) {
  // From rest dz/du = 1 + 0.5 z, as far as 0.3 rad goes.
  const VectorXd q = VectorXd::LinSpaced(200, 0.0, 0.3);
  const VectorXd force =
      hysteresis_force({{"force_n", 1.0}, {"width_rad", 0.2}, {"beta", 1.0}, {"gamma", -1.5}}, q);
  for (const Index k : {20, 100, 199}) {
    EXPECT_NEAR(-force(k), (std::exp(0.5 * q(k) / 0.2) - 1.0) / 0.5, 1e-9) << k;
  }
}

TEST(Hysteresis, OfAnyExponentFollowsTheDifferentialEquation) {
  for (const auto& [beta, gamma, m] :
       {std::array{0.8, -1.1, 1.0}, {0.6, 0.4, 2.0}, {0.6, -0.9, 1.5}}) {
    const VectorXd q = to_and_fro(2000);
    const VectorXd force = hysteresis_force(
        {{"force_n", 1.0}, {"width_rad", 0.25}, {"beta", beta}, {"gamma", gamma}, {"m", m}}, q);
    double z = 0.0;
    for (Index k = 1; k < q.size(); ++k) {  // Euler, in many small steps
      const double du = (q(k) - q(k - 1)) / 0.25 / 50.0;
      for (int i = 0; i < 50; ++i) {
        z += du - beta * std::abs(du) * std::pow(std::abs(z), m - 1.0) * z -
             gamma * du * std::pow(std::abs(z), m);
      }
      ASSERT_NEAR(-force(k), z, 2e-3) << beta << " " << gamma << " " << m << " at " << k;
    }
  }
}

TEST(Hysteresis, StaysFiniteWhereItGrowsWithoutEnd) {
  const VectorXd q = VectorXd::LinSpaced(100, 0.0, 50.0);
  for (const double m : {1.0, 2.0}) {
    const VectorXd force = hysteresis_force(
        {{"force_n", 1.0}, {"width_rad", 1e-3}, {"beta", 1.0}, {"gamma", -4.0}, {"m", m}}, q);
    EXPECT_TRUE(force.allFinite());
  }
}

TEST(Hysteresis, RefusesTwoNamesForItsShape) {
  EXPECT_THROW(
      make_effect(
          "hysteresis", "alpha:base_x",
          {{"force_n", 1.0}, {"width_rad", 0.2}, {"asym", 0.3}, {"beta", 0.7}, {"gamma", 0.3}}),
      Error);
  EXPECT_THROW(make_effect("hysteresis", "alpha:base_x",
                           {{"force_n", 1.0}, {"width_rad", 0.2}, {"beta", 0.7}}),
               Error);
}

}  // namespace
}  // namespace dcnn
