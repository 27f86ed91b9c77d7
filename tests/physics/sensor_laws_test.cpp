// SPDX-License-Identifier: Apache-2.0
// Resonance, sensor and tool effects against their closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "physics/support.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Amplitude and phase (rad) of column x of a settled force at hz, by least squares over whole
/// periods.
std::complex<double> phasor(const VectorXd& force, double hz, double dt) {
  const Index n = force.size();
  std::complex<double> sum = 0.0;
  for (Index k = 0; k < n; ++k) {
    sum += force(k) * std::polar(1.0, -2.0 * std::numbers::pi * hz * dt * static_cast<double>(k));
  }
  return sum * 2.0 / static_cast<double>(n);
}

/// The response of an effect to sin(2 pi hz t) as a complex gain, after 4 of 6 seconds.
std::complex<double> response(const EffectSpec& effect, double hz) {
  const Motion motion = still_motion(3000);
  Wrench wrench = no_wrench(3000);
  wrench.force.col(0) = (2.0 * std::numbers::pi * hz * motion.t.array()).sin();
  const VectorXd in = wrench.force.col(0).tail(1000);
  const VectorXd out = applied(effect, motion, wrench).force.col(0).tail(1000);
  return phasor(out, hz, 0.002) / phasor(in, hz, 0.002);
}

TEST(Resonance, HasTheGainAndPhaseOfItsTransferFunction) {
  const double f0 = 12.0, zeta = 0.05;
  const auto effect = make_effect("flexible_resonance", "sensor_x",
                                  {{"freq_hz", f0}, {"zeta", zeta}, {"fraction", 1.0}});
  const std::complex<double> at_peak = response(effect, f0);
  EXPECT_NEAR(std::abs(at_peak), 1.0 / (2.0 * zeta), 0.05);
  EXPECT_NEAR(std::arg(at_peak), -std::numbers::pi / 2.0, 0.01);
  const std::complex<double> i(0.0, 1.0);
  const double r = 5.0 / f0;
  EXPECT_LT(std::abs(response(effect, 5.0) - 1.0 / (1.0 - r * r + 2.0 * zeta * r * i)), 2e-3);
}

TEST(Resonance, LeavesAConstantForceAlone) {
  const Motion motion = still_motion(100);
  Wrench wrench = no_wrench(100);
  wrench.force.setConstant(7.0);
  const auto effect = make_effect("flexible_resonance", "sensor_y",
                                  {{"freq_hz", 12.0}, {"zeta", 0.05}, {"fraction", 0.5}});
  EXPECT_LT((applied(effect, motion, wrench).force.array() - 7.0).abs().maxCoeff(), 1e-12);
}

TEST(Lowpass, AnswersAStepWithOneMinusExp) {
  const Motion motion = still_motion(200);
  Wrench wrench = no_wrench(200);
  wrench.force.col(1).tail(199).setOnes();  // a ramp over the first step of 2 ms, then constant
  const VectorXd out =
      applied(make_effect("lowpass", "", {{"tau_s", 0.05}}), motion, wrench).force.col(1);
  const double after_ramp = 1.0 - 0.05 / 0.002 * (1.0 - std::exp(-0.002 / 0.05));
  for (const Index k : {1, 20, 100}) {
    const double left = std::exp(-0.002 * static_cast<double>(k - 1) / 0.05);
    EXPECT_NEAR(out(k), 1.0 - (1.0 - after_ramp) * left, 1e-9) << k;
  }
}

TEST(Lowpass, LagsBothForceAndTorque) {
  const auto effect = make_effect("lowpass", "", {{"tau_s", 0.02}});
  const std::complex<double> i(0.0, 1.0);
  EXPECT_LT(std::abs(response(effect, 3.0) - 1.0 / (1.0 + 2.0 * std::numbers::pi * 3.0 * 0.02 * i)),
            1e-3);
  Wrench wrench = no_wrench(10);
  wrench.torque.col(0).tail(5).setOnes();
  EXPECT_LT(applied(effect, still_motion(10), wrench).torque(6, 0), 0.5);
}

TEST(TimeDelay, ShiftsASineByItsPhase) {
  for (const double delay : {0.0, 0.0013, 0.013, 0.2}) {
    const auto gain = response(make_effect("time_delay", "", {{"delay_s", delay}}), 4.0);
    EXPECT_LT(std::abs(gain - std::polar(1.0, -2.0 * std::numbers::pi * 4.0 * delay)), 1e-5)
        << delay;
  }
}

TEST(TimeDelay, HoldsTheFirstValueAndCrossesNoGap) {
  Motion motion = still_motion(20);
  motion.segments = {{0, 10}, {10, 20}};
  Wrench wrench = no_wrench(20);
  wrench.force.col(0).tail(10).setConstant(3.0);
  const auto effect = make_effect("time_delay", "", {{"delay_s", 0.004}});
  EXPECT_LT((applied(effect, motion, wrench).force - wrench.force).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(TimeDelay, CountsRowsThatWereLost) {
  constexpr double kDelay = 0.0131;
  Motion motion = still_motion(600);
  for (Index k = 0; k < 600; ++k) motion.t(k) = 0.002 * static_cast<double>(k + k / 40);
  Wrench wrench = no_wrench(600);
  wrench.force.col(0) = (2.0 * std::numbers::pi * 4.0 * motion.t.array()).sin();
  const auto effect = make_effect("time_delay", "", {{"delay_s", kDelay}});
  const VectorXd out = applied(effect, motion, wrench).force.col(0);
  for (Index k = 10; k < 600; ++k) {
    EXPECT_NEAR(out(k), std::sin(2.0 * std::numbers::pi * 4.0 * (motion.t(k) - kDelay)), 1e-4) << k;
  }
}

TEST(Misalignment, TurnsTheReadingByTheTransposedRotation) {
  Wrench wrench = no_wrench(1);
  wrench.force.row(0) = Vector3d(1.0, 2.0, 3.0);
  const auto effect = make_effect("misalignment", "",
                                  {{"rot_x_rad", 0.3}, {"rot_y_rad", -0.5}, {"rot_z_rad", 0.7}});
  const Eigen::Matrix3d Rm =
      (Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.5, Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.3, Vector3d::UnitX()))
          .toRotationMatrix();
  const Vector3d read = applied(effect, still_motion(1), wrench).force.row(0);
  EXPECT_LT((read - Rm.transpose() * Vector3d(1.0, 2.0, 3.0)).norm(), 1e-12);
}

TEST(GravityTilt, TurnsGravityAboutXThenY) {
  ToolModel model;
  change_model(make_effect("gravity_tilt", "", {{"tilt_x_rad", 0.3}, {"tilt_y_rad", 0.2}}), model);
  const Vector3d wanted = 9.81 * Vector3d(-std::cos(0.3) * std::sin(0.2), std::sin(0.3),
                                          -std::cos(0.3) * std::cos(0.2));
  EXPECT_LT((model.gravity - wanted).norm(), 1e-12);
}

TEST(GravityTilt, TurnsGravityAlongXAboutYThenZ) {
  ToolModel model;
  model.gravity = {9.81, 0.0, 0.0};
  change_model(make_effect("gravity_tilt", "", {{"tilt_y_rad", 0.3}, {"tilt_z_rad", 0.2}}), model);
  const Vector3d wanted =
      9.81 * Vector3d(std::cos(0.3) * std::cos(0.2), std::cos(0.3) * std::sin(0.2), -std::sin(0.3));
  EXPECT_LT((model.gravity - wanted).norm(), 1e-12);
}

TEST(ToolEffects, AddToTheNumbersOfTheTool) {
  ToolModel model = example_tool();
  model.inertial = ToolModel::Inertial::kNone;
  change_model(make_effect("mass", "", {{"delta_mass_kg", -0.05}}), model);
  change_model(
      make_effect("com", "",
                  {{"delta_com_x_m", 0.1}, {"delta_com_y_m", 0.0}, {"delta_com_z_m", 0.0}}),
      model);
  change_model(make_effect("inertial_terms", "", Json::object()), model);
  EXPECT_NEAR(model.mass, 0.7, 1e-15);
  EXPECT_NEAR(model.com(0), 0.11, 1e-15);
  EXPECT_EQ(model.inertial, ToolModel::Inertial::kFull);
}

TEST(InertiaTensor, AddsToThatOfTheToolWhereItHasOne) {
  const EffectSpec effect = make_effect("inertia_tensor", "",
                                        {{"delta_inertia_xx_kgm2", 1.0},
                                         {"delta_inertia_yy_kgm2", 2.0},
                                         {"delta_inertia_zz_kgm2", 3.0},
                                         {"delta_inertia_xy_kgm2", 4.0},
                                         {"delta_inertia_xz_kgm2", 5.0},
                                         {"delta_inertia_yz_kgm2", 6.0}});
  ToolModel model;
  change_model(effect, model);
  EXPECT_FALSE(model.inertia.has_value());  // no torque is simulated
  model.inertia = Eigen::Matrix3d::Identity();
  change_model(effect, model);
  const Eigen::Matrix3d wanted{{2.0, 4.0, 5.0}, {4.0, 3.0, 6.0}, {5.0, 6.0, 4.0}};
  EXPECT_LT((*model.inertia - wanted).norm(), 1e-15);
}

TEST(GainAndCrosstalk, AreTheMatrixTheySay) {
  Wrench wrench = no_wrench(1);
  wrench.force.row(0) = Vector3d(1.0, 2.0, 3.0);
  const auto gain = make_effect("gain", "", {{"gain_x", 0.1}, {"gain_y", -0.1}, {"gain_z", 0.0}});
  EXPECT_LT(
      (applied(gain, still_motion(1), wrench).force - Eigen::RowVector3d(1.1, 1.8, 3.0)).norm(),
      1e-12);
  const auto leak = make_effect(
      "crosstalk", "",
      {{"c_xy", 0.1}, {"c_xz", 0.0}, {"c_yx", 0.0}, {"c_yz", 0.2}, {"c_zx", 0.3}, {"c_zy", 0.0}});
  EXPECT_LT(
      (applied(leak, still_motion(1), wrench).force - Eigen::RowVector3d(1.2, 2.6, 3.3)).norm(),
      1e-12);
}

/// The force along x after an effect on a recording of 10 s that begins at 0 s.
VectorXd offset_of(const EffectSpec& effect) {
  return applied(effect, still_motion(5001), no_wrench(5001)).force.col(0);
}

TEST(Drifts, FollowTheClock) {
  const auto linear = make_effect("linear_drift", "",
                                  {{"rate_x_nps", 0.01}, {"rate_y_nps", 0.0}, {"rate_z_nps", 0.0}});
  EXPECT_NEAR(offset_of(linear)(5000), 0.1, 1e-12);
  const auto thermal = make_effect(
      "thermal_drift", "", {{"a_x_n", 0.5}, {"a_y_n", 0.0}, {"a_z_n", 0.0}, {"tau_s", 5.0}});
  EXPECT_NEAR(offset_of(thermal)(2500), 0.5 * (1.0 - std::exp(-1.0)), 1e-12);
}

TEST(ThermalDrift, FollowsALoggedTemperatureAndNeedsIt) {
  const auto effect =
      make_effect("thermal_drift", "",
                  {{"k_x_npk", 0.02}, {"k_y_npk", 0.0}, {"k_z_npk", 0.0}, {"t_ref_degc", 20.0}});
  Motion motion = still_motion(2);
  EXPECT_THROW(applied(effect, motion, no_wrench(2)), Error);
  motion.temperature = Eigen::Vector2d(20.0, 30.0);
  const VectorXd force = applied(effect, motion, no_wrench(2)).force.col(0);
  EXPECT_NEAR(force(0), 0.0, 1e-12);
  EXPECT_NEAR(force(1), 0.2, 1e-12);
}

TEST(StepBias, StaysAfterItsOnset) {
  const auto effect = make_effect(
      "step_bias", "", {{"step_x_n", 0.4}, {"step_y_n", 0.0}, {"step_z_n", 0.0}}, {4.0, 5.0});
  const VectorXd force = offset_of(effect);
  EXPECT_EQ(force(1999), 0.0);
  EXPECT_EQ(force(2001), 0.4);
  EXPECT_EQ(force(5000), 0.4);
}

TEST(Offsets, TakeTorquesUnderTheirOwnNames) {
  const auto effect = make_effect("bias", "",
                                  {{"delta_bias_x_n", 0.0},
                                   {"delta_bias_y_n", 0.0},
                                   {"delta_bias_z_n", 0.0},
                                   {"delta_bias_ty_nm", 0.2}});
  const Wrench wrench = applied(effect, still_motion(3), no_wrench(3));
  EXPECT_EQ(wrench.torque(2, 1), 0.2);
  EXPECT_EQ(wrench.torque(2, 0), 0.0);
}

TEST(Hum, HasOneFrequencyInTime) {
  const auto effect = make_effect("hum", "",
                                  {{"freq_hz", 50.0},
                                   {"sin_x_n", 0.1},
                                   {"sin_y_n", 0.0},
                                   {"sin_z_n", 0.0},
                                   {"cos_x_n", 0.05},
                                   {"cos_y_n", 0.0},
                                   {"cos_z_n", 0.0}});
  const VectorXd force = offset_of(effect).head(5000);
  const auto line = phasor(force, 50.0, 0.002);
  EXPECT_NEAR(line.real(), 0.05, 1e-9);
  EXPECT_NEAR(line.imag(), -0.1, 1e-9);
  EXPECT_NEAR(std::abs(phasor(force, 60.0, 0.002)), 0.0, 1e-9);
}

TEST(Saturation, ClipsOneAxisOnly) {
  Wrench wrench = no_wrench(2);
  wrench.force << 9.0, -9.0, 9.0, 1.0, 9.0, -9.0;
  const auto effect = make_effect("saturation", "sensor_z", {{"limit_n", 5.0}});
  Eigen::MatrixXd wanted = wrench.force;
  wanted.col(2) << 5.0, -5.0;
  EXPECT_EQ(applied(effect, still_motion(2), wrench).force, wanted);
}

TEST(Quantisation, IsWithinHalfAStep) {
  const Motion motion = example_motion(500);
  const Wrench wrench = rigid_wrench(example_tool(), motion);
  const auto read = applied(make_effect("quantisation", "", {{"step_n", 0.2}}), motion, wrench);
  EXPECT_LE((read.force - wrench.force).cwiseAbs().maxCoeff(), 0.1 + 1e-12);
  const Eigen::ArrayXXd steps = read.force.array() / 0.2;
  EXPECT_LT((steps - steps.round()).abs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace dcnn
