// SPDX-License-Identifier: Apache-2.0
// Motions that a drive makes: closed forms, another integrator, and numbers refined on them.
#include "dcnn/physics/forward.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/identification/forward_fit.h"

namespace dcnn {
namespace {

constexpr double kDt = 0.002;

/// One axis of this inertia, damping and stiffness, with effects.
AxisMachine machine(double m, double c, double k, const std::vector<EffectSpec>& effects = {}) {
  const Json system = {{"kind", "axes"},
                       {"axes",
                        {{{"name", "mass"},
                          {"measured", "u"},
                          {"unit", "N"},
                          {"position", "y"},
                          {"base", {"acceleration", "velocity", "position"}}}}}};
  AxisMachine machine;
  machine.system = parse_system(system, "test");
  CorrectedAxis axis;
  axis.columns = {0, 1, 2};
  axis.coefficients = Eigen::Vector3d(m, c, k);
  axis.effects = effects;
  axis.derivative.kind = DerivativeSpec::Kind::kSpectral;
  axis.derivative.cutoff_hz = 100.0;
  machine.axes = {axis};
  return machine;
}

EffectSpec effect(const char* name, const char* axis, const Json& parameters) {
  return {name, axis, std::nullopt, parameters, ""};
}

Eigen::VectorXd sampled(Index samples, const std::function<double(double)>& f) {
  Eigen::VectorXd x(samples);
  for (Index i = 0; i < samples; ++i) x(i) = f(kDt * double(i));
  return x;
}

ForwardAxis forward(const AxisMachine& machine) { return {machine, 0, kDt, "test", Exit::kData}; }

TEST(Forward, FollowsALinearOscillator) {
  const double m = 2.0, c = 3.0, k = 800.0, w = 2.0 * std::numbers::pi * 3.7;
  const std::complex<double> gain =
      1.0 / std::complex<double>(k - m * w * w, c * w);  // of exp(i w t)
  const auto drive = sampled(3000, [&](double t) { return 5.0 * std::cos(w * t); });
  const auto q =
      sampled(3000, [&](double t) { return (5.0 * gain * std::polar(1.0, w * t)).real(); });
  const double v0 = (5.0 * gain * std::complex<double>(0.0, w)).real();
  const Eigen::MatrixXd motion = forward(machine(m, c, k)).run(drive, q(0), v0);
  EXPECT_LT((motion.col(0) - q).cwiseAbs().maxCoeff(), 2e-4 * q.cwiseAbs().maxCoeff());
}

// A body that slides to rest under dry friction stays there: v0^2/(2 fc/m) from where it began.
TEST(Forward, DryFrictionStopsABody) {
  const AxisMachine sliding = machine(
      1.5, 0.0, 0.0, {effect("coulomb_friction", "base_x", {{"fc_n", 3.0}, {"v0_mps", 1e-4}})});
  const Eigen::MatrixXd motion = forward(sliding).run(Eigen::VectorXd::Zero(2000), 0.2, 1.0);
  const double end = 0.2 + 1.0 / (2.0 * 3.0 / 1.5);
  EXPECT_NEAR(motion(1999, 0), end, 2e-4);
  EXPECT_NEAR(motion(1999, 1), 0.0, 1e-6);
  EXPECT_NEAR(motion(100, 1), 1.0 - 2.0 * 0.2, 1e-4);
}

/// Bouc and Wen's oscillator by Runge and Kutta in steps of dt/200.
Eigen::VectorXd bouc_wen(const Eigen::VectorXd& drive_at_rest, double m, double c, double k,
                         double force, double width, double gamma,
                         const std::function<double(double)>& drive) {
  Eigen::VectorXd q(drive_at_rest.size());
  Eigen::Vector3d s = Eigen::Vector3d::Zero();  // q, v, z
  const auto rate = [&](double t, const Eigen::Vector3d& x) {
    const double z = x(2), v = x(1);
    const double dz = (v - std::abs(v) * z - gamma * v * std::abs(z)) / width;
    return Eigen::Vector3d(v, (drive(t) - c * v - k * x(0) - force * z) / m, dz);
  };
  constexpr int kSteps = 200;
  const double h = kDt / kSteps;
  for (Index i = 0; i < q.size(); ++i) {
    q(i) = s(0);
    for (int j = 0; j < kSteps; ++j) {
      const double t = kDt * double(i) + h * j;
      const Eigen::Vector3d a = rate(t, s), b = rate(t + h / 2, s + h / 2 * a),
                            d = rate(t + h / 2, s + h / 2 * b), e = rate(t + h, s + h * d);
      s += h / 6.0 * (a + 2.0 * b + 2.0 * d + e);
    }
  }
  return q;
}

double pushes(double t) {
  return 8.0 * std::sin(2.0 * std::numbers::pi * 2.3 * t) * std::sin(0.9 * t) +
         4.0 * std::sin(2.0 * std::numbers::pi * 7.1 * t) * std::sin(1.7 * t);
}

AxisMachine hysteretic(double m, double force, double width) {
  return machine(
      m, 4.0, 900.0,
      {effect(
          "hysteresis", "alpha:base_x",
          {{"force_n", force}, {"width_rad", width}, {"beta", 1.0}, {"gamma", -0.4}, {"m", 1.0}})});
}

TEST(Forward, HysteresisAsByAnotherIntegrator) {
  const Eigen::VectorXd drive = sampled(2500, pushes);
  const Eigen::VectorXd truth = bouc_wen(drive, 2.0, 4.0, 900.0, 3.0, 0.004, -0.4, pushes);
  const Eigen::MatrixXd motion = forward(hysteretic(2.0, 3.0, 0.004)).run(drive, 0.0, 0.0, 1e-6);
  EXPECT_LT((motion.col(0) - truth).cwiseAbs().maxCoeff(), 2e-4 * truth.cwiseAbs().maxCoeff());
}

TEST(Forward, RefinesTheNumbersOfAStructure) {
  const Eigen::VectorXd drive = sampled(2500, pushes);
  Recording recording;
  recording.name = "log.csv";
  recording.table.columns = {"t", "u", "y"};
  recording.table.values.resize(drive.size(), 3);
  recording.table.values << sampled(drive.size(), [](double t) { return t; }), drive,
      bouc_wen(drive, 2.0, 4.0, 900.0, 3.0, 0.004, -0.4, pushes);
  recording.dt = kDt;
  recording.segments = {{0, drive.size()}};
  const ForwardFit fit =
      refine_forward(hysteretic(2.1, 2.8, 0.0044), 0, {recording}, [](const std::string&) {});
  EXPECT_EQ(fit.names, (std::vector<std::string>{"acceleration", "velocity", "position",
                                                 "hysteresis force [N]", "hysteresis width [m]",
                                                 "hysteresis gamma"}));
  EXPECT_GT(fit.rmse_before, 30.0 * fit.rmse_after);
  EXPECT_NEAR(fit.after(0), 2.0, 0.002);
  EXPECT_NEAR(fit.after(3), 3.0, 0.03);
  EXPECT_NEAR(fit.after(5), -0.4, 0.02);
  EXPECT_NEAR(fit.after(4), 0.004, 4e-5);
}

TEST(Forward, RefusesWhatNoDriveMoves) {
  EXPECT_THROW(forward(machine(0.0, 1.0, 1.0)), Error);
  EXPECT_THROW(forward(machine(1.0, 1.0, 1.0, {effect("lowpass", "", {{"tau_s", 0.01}})})), Error);
  // A spring that pushes outwards: the motion has no bound.
  EXPECT_THROW(forward(machine(1.0, 0.0, -1e6)).run(Eigen::VectorXd::Ones(200000), 0.0, 0.0),
               Error);
}

}  // namespace
}  // namespace dcnn
