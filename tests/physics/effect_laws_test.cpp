// Each law against its closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/support.h"

namespace dcnn {
namespace {

constexpr double kPi = std::numbers::pi;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The force along z that an effect adds when the tool moves along base z with these velocities.
VectorXd friction_force(const EffectSpec& effect, const VectorXd& v) {
  Motion motion = still_motion(v.size());
  motion.v_B.col(2) = v;
  return applied(effect, motion, no_wrench(v.size())).force.col(2);
}

/// Velocity of a position amplitude·sin(2 pi hz t).
VectorXd swing(double amplitude, double hz, Index samples) {
  const VectorXd t = still_motion(samples).t;
  return amplitude * 2.0 * kPi * hz * (2.0 * kPi * hz * t.array()).cos();
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
    if (kind->axis != AxisRule::kLine) continue;
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
  motion.euler.col(1) << 0.0, kPi / 24.0;
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

/// Amplitude and phase (rad) of column x of a settled force at hz, by least squares over whole
/// periods.
std::complex<double> phasor(const VectorXd& force, double hz, double dt) {
  const Index n = force.size();
  std::complex<double> sum = 0.0;
  for (Index k = 0; k < n; ++k) {
    sum += force(k) * std::polar(1.0, -2.0 * kPi * hz * dt * static_cast<double>(k));
  }
  return sum * 2.0 / static_cast<double>(n);
}

/// The response of an effect to sin(2 pi hz t) as a complex gain, after 4 of 6 seconds.
std::complex<double> response(const EffectSpec& effect, double hz) {
  const Motion motion = still_motion(3000);
  Wrench wrench = no_wrench(3000);
  wrench.force.col(0) = (2.0 * kPi * hz * motion.t.array()).sin();
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
  EXPECT_NEAR(std::arg(at_peak), -kPi / 2.0, 0.01);
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
  EXPECT_LT(std::abs(response(effect, 3.0) - 1.0 / (1.0 + 2.0 * kPi * 3.0 * 0.02 * i)), 1e-3);
  Wrench wrench = no_wrench(10);
  wrench.torque.col(0).tail(5).setOnes();
  EXPECT_LT(applied(effect, still_motion(10), wrench).torque(6, 0), 0.5);
}

TEST(TimeDelay, ShiftsASineByItsPhase) {
  for (const double delay : {0.0, 0.0013, 0.013, 0.2}) {
    const auto gain = response(make_effect("time_delay", "", {{"delay_s", delay}}), 4.0);
    EXPECT_LT(std::abs(gain - std::polar(1.0, -2.0 * kPi * 4.0 * delay)), 1e-5) << delay;
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
