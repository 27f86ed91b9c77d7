// SPDX-License-Identifier: Apache-2.0
// The generator's physics against closed forms, on motions that can be written down.
#include "conceal/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::Vector3d;
constexpr double kG = 9.81;

/// A recording whose pose is a function of time; only alpha turns.
Path moved(const std::function<Vector3d(double)>& position,
           const std::function<double(double)>& alpha, double seconds = 1.0) {
  const auto n = static_cast<Index>(seconds / kStep);
  MatrixXd q = MatrixXd::Zero(n, 6);
  std::vector<Eigen::Matrix3d> rotation;
  for (Index i = 0; i < n; ++i) {
    const double t = kStep * static_cast<double>(i);
    q.row(i).head(3) = position(t).transpose();
    q(i, 3) = alpha(t);
    rotation.push_back(Eigen::AngleAxisd(q(i, 3), Vector3d::UnitZ()).toRotationMatrix());
  }
  return follow(0.0, q, rotation, Vector3d::Zero());
}

Path along_x(const std::function<double(double)>& x, double seconds = 1.0) {
  return moved([&](double t) { return Vector3d(x(t), 0.0, 0.0); }, [](double) { return 0.0; },
               seconds);
}

Path turning(const std::function<double(double)>& alpha) {
  return moved([](double) { return Vector3d::Zero(); }, alpha);
}

Path resting(const Vector3d& mounting = Vector3d::Zero()) {
  const Eigen::Matrix3d pointing = Eigen::AngleAxisd(0.3, Vector3d::UnitY()).toRotationMatrix();
  MatrixXd q = MatrixXd::Zero(4000, 6);
  q.col(4).setConstant(0.3);
  return follow(0.0, q, std::vector<Eigen::Matrix3d>(4000, pointing), mounting);
}

Hidden effect(const std::string& id, const std::string& axis,
              std::map<std::string, double> parameters) {
  Hidden h;
  h.effect = id;
  h.axis = axis;
  h.parameters = std::move(parameters);
  return h;
}

Tool tool(const std::string& inertial = "full") {
  Tool t;
  t.mass = 0.8;
  t.com = {0.02, 0.0, 0.1};
  t.bias = {0.1, -0.2, 0.3};
  t.inertial = inertial;
  return t;
}

/// What the effect changes at instant t.
RowVector3d change(const Path& path, const Hidden& h, double t = 0.75) {
  const auto i = static_cast<Index>(t / kStep);
  return force(path, tool(), {h}).row(i) - force(path, tool(), {}).row(i);
}

TEST(World, AtRestTheSensorFeelsTheWeightAndItsBias) {
  const Vector3d expected =
      0.8 * Vector3d(kG * std::sin(0.3), 0.0, -kG * std::cos(0.3)) + tool().bias;
  for (const char* inertial : {"full", "linear", "none"}) {
    EXPECT_LT((force(resting(), tool(inertial), {}).row(2000).transpose() - expected).norm(),
              1e-12);
  }
  // Turned by pi/2 about z in the pose frame, the sensor reads x as -y.
  const RowVector3d turned = force(resting({0.0, 0.0, std::numbers::pi / 2}), tool(), {}).row(2000);
  EXPECT_NEAR(turned(0), 0.1, 1e-12);
  EXPECT_NEAR(turned(1), -0.8 * kG * std::sin(0.3) - 0.2, 1e-12);
}

TEST(World, InertialTermsAreThoseThatTheSimulatorHas) {
  const Path pushed = along_x([](double t) { return t * t; });  // 2 m/s^2
  EXPECT_NEAR(force(pushed, tool("full"), {})(2000, 0), -1.6 + 0.1, 1e-6);
  EXPECT_NEAR(force(pushed, tool("linear"), {})(2000, 0), -1.6 + 0.1, 1e-6);
  EXPECT_NEAR(force(pushed, tool("none"), {})(2000, 0), 0.1, 1e-6);
  const Path spun = turning([](double t) { return 3.0 * t; });  // centripetal 9 c, towards the axis
  EXPECT_NEAR(force(spun, tool("full"), {})(2000, 0), 0.8 * 9.0 * 0.02 + 0.1, 1e-5);
  EXPECT_NEAR(force(spun, tool("linear"), {})(2000, 0), 0.1, 1e-5);
  EXPECT_NEAR(force(spun, tool("linear"), {effect("inertial_terms", "", {})})(2000, 0),
              0.8 * 9.0 * 0.02 + 0.1, 1e-5);
}

TEST(World, FrictionOpposesTheMotion) {
  for (const double v : {0.2, -0.2}) {
    const Path path = along_x([v](double t) { return v * t; });
    const double sign = v > 0.0 ? 1.0 : -1.0;
    Hidden coulomb = effect("coulomb_friction", "base_x", {{"fc_n", 0.4}, {"v0_mps", 0.002}});
    EXPECT_NEAR(change(path, coulomb)(0), -0.4 * sign, 1e-9);
    coulomb.foreign = true;
    EXPECT_NEAR(change(path, coulomb)(0), -0.4 * sign, 1e-4);
    EXPECT_NEAR(change(path, effect("viscous_friction", "base_x", {{"c_nspm", 3.0}}))(0), -3.0 * v,
                1e-9);
    EXPECT_NEAR(change(path, effect("quadratic_drag", "base_x", {{"c2_ns2pm2", 5.0}}))(0),
                -5.0 * v * std::abs(v), 1e-9);
    const Hidden stribeck =
        effect("stribeck_friction", "base_x",
               {{"fc_n", 0.2}, {"fs_n", 0.5}, {"vs_mps", 0.2}, {"v0_mps", 0.001}});
    EXPECT_NEAR(change(path, stribeck)(0), -sign * (0.2 + 0.3 * std::exp(-1.0)), 1e-6);
    Hidden lugre = effect("lugre_friction", "base_x",
                          {{"fc_n", 0.3}, {"sigma0_npm", 300.0}, {"sigma1_nspm", 0.5}});
    EXPECT_NEAR(change(path, lugre)(0), -0.3 * sign, 1e-6);
    lugre.foreign = true;
    EXPECT_NEAR(change(path, lugre)(0), -0.3 * sign, 1e-9);
  }
}

TEST(World, FrictionAgainstARotation) {
  const Path path = turning([](double t) { return 2.0 * t; });
  const RowVector3d d = change(path, effect("viscous_friction", "w_sensor_z", {{"c_nspm", 0.3}}));
  EXPECT_NEAR(d(2), -0.6, 1e-5);
  EXPECT_NEAR(d.head(2).norm(), 0.0, 1e-12);
}

TEST(World, ForcesOfAnAngle) {
  const Path path = turning([](double t) { return 0.8 * t; });  // 0.6 rad at 0.75 s
  EXPECT_NEAR(change(path, effect("cable_spring", "alpha:sensor_y",
                                  {{"k_nprad", 2.0}, {"rest_rad", 0.1}}))(1),
              -1.0, 1e-9);
  EXPECT_NEAR(change(path, effect("cogging", "alpha:sensor_z",
                                  {{"amp_n", 0.5}, {"order", 7.0}, {"phase_rad", 0.2}}))(2),
              0.5 * std::sin(7.0 * 0.6 + 0.2), 1e-9);
  const std::map<std::string, double> loop{{"force_n", 0.4}, {"width_rad", 0.02}, {"asym", 0.6}};
  Hidden hysteresis = effect("hysteresis", "alpha:sensor_x", loop);
  EXPECT_NEAR(change(path, hysteresis)(0), -0.4, 1e-6);
  hysteresis.foreign = true;
  EXPECT_NEAR(change(path, hysteresis)(0), -0.4, 1e-9);
}

TEST(World, AContactIsConstantInTheBaseWhileItLasts) {
  Hidden h = effect("contact", "", {{"force_x_n", 1.0}, {"force_y_n", 0.0}, {"force_z_n", -2.0}});
  h.interval_s = {0.5, 0.9};
  const Path path = turning([](double t) { return t; });
  EXPECT_EQ(change(path, h, 0.4).norm(), 0.0);
  EXPECT_LT((change(path, h, 0.75) - RowVector3d(std::cos(0.75), -std::sin(0.75), -2.0)).norm(),
            1e-12);
  h.foreign = true;
  EXPECT_LT(change(path, h, 0.55).norm(), std::sqrt(5.0) / 2.0);
}

TEST(World, LagAndDelayOfARamp) {
  const Path path = along_x([](double t) { return t * t * t; }, 2.0);  // F_x = -0.8 * 6 t
  const double slope = -4.8;
  EXPECT_NEAR(change(path, effect("time_delay", "", {{"delay_s", 0.0301}}), 1.5)(0),
              -0.0301 * slope, 1e-4);
  EXPECT_NEAR(change(path, effect("lowpass", "", {{"tau_s", 0.05}}), 1.5)(0), -0.05 * slope, 1e-4);
}

TEST(World, AResonanceMultipliesWhatIsInTune) {
  const double w = 2.0 * std::numbers::pi * 10.0, zeta = 0.05;
  const Path path = along_x([w](double t) { return -std::sin(w * t) / (w * w); }, 4.0);
  const Hidden h = effect("flexible_resonance", "sensor_x",
                          {{"freq_hz", 10.0}, {"zeta", zeta}, {"fraction", 1.0}});
  const MatrixXd F = force(path, tool(), {h});
  const double swing = F.col(0).segment(12000, 3500).maxCoeff() - 0.1;
  EXPECT_NEAR(swing, 0.8 / (2.0 * zeta), 0.02);  // |H(w0)| = 1/(2 zeta)
}

TEST(World, WhatTheSensorMakesOfTheForce) {
  const Path path = resting();
  const RowVector3d F = force(path, tool(), {}).row(3000) - tool().bias.transpose();
  const auto d = [&](const Hidden& h) { return change(path, h); };
  EXPECT_LT((d(effect("gain", "", {{"gain_x", 0.1}, {"gain_y", 0.0}, {"gain_z", -0.2}})) -
             RowVector3d(0.1 * F(0), 0.0, -0.2 * F(2)))
                .norm(),
            1e-12);
  EXPECT_NEAR(d(effect("crosstalk", "",
                       {{"c_xy", 0.0},
                        {"c_xz", 0.0},
                        {"c_yx", 0.0},
                        {"c_yz", 0.03},
                        {"c_zx", 0.0},
                        {"c_zy", 0.0}}))(1),
              0.03 * F(2), 1e-12);
  EXPECT_NEAR(d(effect("misalignment", "",
                       {{"rot_x_rad", 0.0}, {"rot_y_rad", 0.0}, {"rot_z_rad", 1e-3}}))(1),
              -1e-3 * F(0), 1e-8);
  EXPECT_NEAR(d(effect("mass", "", {{"delta_mass_kg", 0.05}}))(2), -0.05 * kG * std::cos(0.3),
              1e-12);
  EXPECT_NEAR(d(effect("gravity_tilt", "", {{"tilt_x_rad", 1e-3}, {"tilt_y_rad", 0.0}}))(1),
              0.8 * kG * 1e-3, 1e-6);
}

TEST(World, OffsetsOverTheClock) {
  Path path = resting();
  path.climate = {20.0, 0.0, 60.0, 0.0, 90.0};
  const Hidden thermal =
      effect("thermal_drift", "",
             {{"k_x_npk", 0.1}, {"k_y_npk", 0.2}, {"k_z_npk", 0.0}, {"t_ref_degc", 25.0}});
  EXPECT_LT((change(path, thermal) - RowVector3d(-0.5, -1.0, 0.0)).norm(), 1e-9);
  const Hidden settling = effect("thermal_drift", "",
                                 {{"a_x_n", 1.0}, {"a_y_n", 0.0}, {"a_z_n", 0.0}, {"tau_s", 0.75}});
  EXPECT_NEAR(change(path, settling)(0), 1.0 - std::exp(-1.0), 1e-9);
  Hidden step = effect("step_bias", "", {{"step_x_n", 0.0}, {"step_y_n", 0.5}, {"step_z_n", 0.0}});
  step.interval_s = {0.5, 0.9};
  EXPECT_EQ(change(path, step, 0.4).norm(), 0.0);
  EXPECT_NEAR(change(path, step, 0.95)(1), 0.5, 1e-12);  // it stays
}

/// A tool of four point masses about its centre.
Tool beaded(const std::string& inertial = "full") {
  Tool t = tool(inertial);
  t.beads = {t.com + Vector3d(0.05, 0.0, 0.0), t.com - Vector3d(0.05, 0.0, 0.0),
             t.com + Vector3d(0.0, 0.02, 0.04), t.com - Vector3d(0.0, 0.02, 0.04)};
  t.bias_torque = {0.01, 0.02, -0.03};
  return t;
}

// tau = c x m (g - a) - I dw - w x I w about the sensor's origin.
TEST(World, PointMassesMakeTheTorqueOfTheirTensor) {
  const Path path = moved([](double t) { return Vector3d(0.1 * t * t, 0.0, 0.0); },
                          [](double t) { return std::sin(3.0 * t); });
  const Tool t = beaded();
  const Eigen::Matrix3d I = inertia_of(t);
  const MatrixXd read = force(path, t, {});
  ASSERT_EQ(read.cols(), 6);
  for (Index i = 500; i < 3500; i += 250) {
    const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(i)];
    const Vector3d a(0.2, 0.0, 0.0), w = path.rate.row(i), dw = path.rate_derivative.row(i);
    const Vector3d expected = t.com.cross(t.mass * R.transpose() * (Vector3d(0, 0, -kG) - a)) -
                              I * dw - w.cross(I * w) + t.bias_torque;
    EXPECT_LT((read.row(i).tail<3>().transpose() - expected).norm(), 1e-6) << i;
    EXPECT_LT((read.row(i).head<3>() - force(path, tool(), {}).row(i)).norm(), 1e-12);
  }
}

TEST(World, ForcesActAtTheirLevers) {
  const Path path = along_x([](double t) { return 0.1 * std::sin(5.0 * t); });
  const Hidden drag =
      effect("viscous_friction", "base_x",
             {{"c_nspm", 2.0}, {"lever_x_m", 0.01}, {"lever_y_m", -0.04}, {"lever_z_m", 0.2}});
  Hidden push = effect("contact", "",
                       {{"force_x_n", 1.0},
                        {"force_y_n", -2.0},
                        {"force_z_n", 0.5},
                        {"force_tx_nm", 0.1},
                        {"force_ty_nm", 0.2},
                        {"force_tz_nm", 0.3}});
  push.interval_s = {0.2, 0.4};
  const Tool t = beaded();
  const MatrixXd plain = force(path, t, {}), dragged = force(path, t, {drag}) - plain,
                 pushed = force(path, t, {push}) - plain;
  for (const Index i : {1000, 1300, 2500}) {
    const Vector3d f = dragged.row(i).head<3>();
    EXPECT_GT(f.norm(), 0.01);
    EXPECT_LT((dragged.row(i).tail<3>().transpose() - Vector3d(0.01, -0.04, 0.2).cross(f)).norm(),
              1e-12);
  }
  EXPECT_LT((pushed.row(1300).tail<3>() - RowVector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_EQ(pushed.row(2500).norm(), 0.0);
}

TEST(World, ClippingComesBeforeRounding) {
  MatrixXd F(2, 3);
  F << 1.26, -7.0, 0.04, 0.9, 7.0, -0.06;
  digitise({effect("quantisation", "", {{"step_n", 0.1}}),
            effect("saturation", "sensor_y", {{"limit_n", 5.02}})},
           F);
  MatrixXd expected(2, 3);
  expected << 1.3, -5.0, 0.0, 0.9, 5.0, -0.1;
  EXPECT_LT((F - expected).norm(), 1e-12);
}

TEST(World, ALooseLoadOnlyKnocksWhenGravityTurns) {
  const Path path = moved([](double) { return Vector3d::Zero(); }, [](double) { return 0.0; });
  const Hidden h = effect("loose_load", "sensor_z", {{"slug_kg", 0.05}, {"gap_m", 0.01}});
  EXPECT_NEAR(change(path, h)(2), 0.0, 1e-3);  // it lies on its stop
}

}  // namespace
}  // namespace dcnn::conceal
