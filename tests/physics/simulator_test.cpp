// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/simulator.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "physics/support.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

// Newton and Euler in the inertial frame B: the sensor's push on the tool and gravity change the
// tool's momentum, d(m v_com)/dt = -F + m g; and about the centre of mass d(I_c w)/dt = -(T - c x
// F).
TEST(RigidWrench, EqualsTheNumericDerivativeOfMomentum) {
  ToolModel tool = example_tool();
  tool.bias.setZero();
  const Motion motion = example_motion(400, tool);
  const Wrench wrench = rigid_wrench(tool, motion);
  const Vector3d c = tool.com;
  const Eigen::Matrix3d I_com =
      *tool.inertia -
      tool.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  const auto R = [&](Index k) { return motion.R_BS[static_cast<std::size_t>(k)]; };
  const auto momentum = [&](Index k) -> Vector3d {
    const Vector3d w = motion.w_S.row(k), v = motion.v_B.row(k);
    return tool.mass * (v + R(k) * w.cross(c));
  };
  const auto spin = [&](Index k) -> Vector3d {
    return R(k) * (I_com * motion.w_S.row(k).transpose());
  };
  for (Index k = 10; k < 390; k += 20) {
    const Vector3d F = R(k) * wrench.force.row(k).transpose();
    const Vector3d T = R(k) * wrench.torque.row(k).transpose(), arm = R(k) * c;
    const Vector3d dp = (momentum(k + 1) - momentum(k - 1)) / (2.0 * motion.dt);
    const Vector3d dL = (spin(k + 1) - spin(k - 1)) / (2.0 * motion.dt);
    EXPECT_LT((dp - (-F + tool.mass * tool.gravity)).norm(), 2e-3) << k;
    EXPECT_LT((dL - (-T + arm.cross(F))).norm(), 2e-4) << k;
  }
}

TEST(RigidWrench, AtRestIsTheWeightPlusTheBias) {
  const ToolModel tool = example_tool();
  const Motion motion = still_motion(1);
  const Wrench wrench = rigid_wrench(tool, motion);
  const Vector3d weight(0.0, 0.0, -0.75 * 9.81);
  EXPECT_LT((wrench.force.row(0).transpose() - weight - tool.bias).norm(), 1e-12);
  EXPECT_LT((wrench.torque.row(0).transpose() - tool.com.cross(weight)).norm(), 1e-12);
}

TEST(RigidWrench, LeavesOutTheInertialTermsThatTheModelLeavesOut) {
  ToolModel tool = example_tool();
  const Motion motion = example_motion(50, tool);
  tool.inertial = ToolModel::Inertial::kLinear;
  const Wrench linear = rigid_wrench(tool, motion);
  tool.inertial = ToolModel::Inertial::kNone;
  const Wrench none = rigid_wrench(tool, motion);
  for (Index k = 0; k < 50; ++k) {
    const Vector3d a_S =
        motion.R_BS[static_cast<std::size_t>(k)].transpose() * motion.a_B.row(k).transpose();
    const Vector3d difference = (linear.force - none.force).row(k);
    EXPECT_LT((difference + tool.mass * a_S).norm(), 1e-12);
  }
}

TEST(RigidWrench, NeedsAnAccelerationUnlessInertiaIsLeftOut) {
  ToolModel tool = example_tool();
  Motion motion = still_motion(5);
  motion.a_B = Eigen::MatrixXd(0, 3);
  EXPECT_THROW(rigid_wrench(tool, motion), Error);
  tool.inertial = ToolModel::Inertial::kNone;
  EXPECT_NO_THROW(rigid_wrench(tool, motion));
}

Eigen::MatrixXd matrix(const Json& rows) {
  Eigen::MatrixXd out(static_cast<Index>(rows.size()), static_cast<Index>(rows[0].size()));
  for (Index i = 0; i < out.rows(); ++i) {
    for (Index j = 0; j < out.cols(); ++j) {
      out(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>();
    }
  }
  return out;
}

// Another implementation's regressor of (m, m·c, bias) with the opposite sign of the force of the
// tool.
TEST(RigidWrench, AgreesWithAnIndependentRegressor) {
  const std::filesystem::path path = DCNN_SOURCE_DIR "/../shared/reference/physics.json";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "reference physics.json is not here";
  const Json reference = read_json(path, Exit::kData);
  const Eigen::MatrixXd w = matrix(reference["omega_body"]), dw = matrix(reference["alpha_body"]);
  Motion motion = still_motion(w.rows());
  motion.w_S = w;
  motion.dw_S = dw;
  std::vector<Eigen::MatrixXd> regressors;
  for (Index k = 0; k < w.rows(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    motion.R_BS[i] = matrix(reference["R"][i]);
    regressors.push_back(matrix(reference["regressor"][i]));
    motion.a_B.row(k) =
        (motion.R_BS[i] * regressors.back().col(0) + Vector3d(0, 0, -9.81)).transpose();
  }
  const ToolModel tool = example_tool();
  Eigen::VectorXd parameters(7);
  parameters << tool.mass, tool.mass * tool.com, tool.bias;
  const Wrench wrench = rigid_wrench(tool, motion);
  for (Index k = 0; k < w.rows(); ++k) {
    Eigen::MatrixXd Y = regressors[static_cast<std::size_t>(k)];
    Y.leftCols(4) *= -1.0;
    EXPECT_LT((wrench.force.row(k).transpose() - Y * parameters).norm(), 1e-9) << k;
  }
}

TEST(Simulate, IsTheRigidWrenchWithoutEffects) {
  const Motion motion = example_motion(100);
  const Wrench rigid = rigid_wrench(example_tool(), motion);
  const Wrench chain = simulate({example_tool(), {}}, motion);
  EXPECT_LT((chain.force - rigid.force).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(chain.torque, rigid.torque);
}

TEST(Simulate, GainActsBeforeTheBiasInWhateverOrderItIsWritten) {
  const Motion motion = example_motion(100);
  const EffectSpec gain =
      make_effect("gain", "", {{"gain_x", 1.0}, {"gain_y", 0.0}, {"gain_z", 0.0}});
  const EffectSpec bias = make_effect(
      "bias", "", {{"delta_bias_x_n", 5.0}, {"delta_bias_y_n", 0.0}, {"delta_bias_z_n", 0.0}});
  ToolModel tool = example_tool();
  const Eigen::MatrixXd one = simulate({tool, {gain, bias}}, motion).force;
  EXPECT_EQ(one, simulate({tool, {bias, gain}}, motion).force);
  const Eigen::VectorXd rigid = rigid_wrench(tool, motion).force.col(0);
  const Eigen::VectorXd wanted = 2.0 * (rigid.array() - tool.bias(0)) + tool.bias(0) + 5.0;
  EXPECT_LT((one.col(0) - wanted).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Simulate, QuantisesAfterTheNoise) {
  const Motion motion = example_motion(200);
  const SensorNoise noise{0.3, 0.0, 0.0};
  Rng rng(1);
  const Wrench wrench =
      simulate({example_tool(), {make_effect("quantisation", "", {{"step_n", 0.25}})}}, motion,
               &noise, &rng);
  const Eigen::ArrayXXd steps = wrench.force.array() / 0.25;
  EXPECT_EQ(steps.round().matrix(), steps.matrix());
}

TEST(Simulate, SensorNoiseHasTheStatedDeviationAndCorrelation) {
  const Motion motion = still_motion(40000);
  const SensorNoise noise{0.04, 0.002, 0.6};
  Rng rng(3);
  const Simulator simulator{example_tool(), {}};
  const Wrench clean = simulate(simulator, motion),
               noisy = simulate(simulator, motion, &noise, &rng);
  const Eigen::VectorXd n = (noisy.force - clean.force).col(0);
  const double variance = n.squaredNorm() / 40000.0;
  EXPECT_NEAR(std::sqrt(variance), 0.04, 0.002);
  EXPECT_NEAR(n.head(39999).dot(n.tail(39999)) / 40000.0 / variance, 0.6, 0.03);
  EXPECT_NEAR(std::sqrt((noisy.torque - clean.torque).squaredNorm() / 120000.0), 0.002, 1e-4);
}

TEST(Simulate, AnEffectOfAnotherRecordingDoesNothing) {
  Motion motion = example_motion(50);
  motion.recording = "a.csv";
  EffectSpec effect = make_effect("viscous_friction", "tool_z", {{"c_nspm", 3.0}});
  const Eigen::MatrixXd rigid = simulate({example_tool(), {}}, motion).force;
  effect.recording = "b.csv";
  EXPECT_EQ(simulate({example_tool(), {effect}}, motion).force, rigid);
  effect.recording = "a.csv";
  EXPECT_NE(simulate({example_tool(), {effect}}, motion).force, rigid);
}

Json example_sim() {
  return Json::parse(R"({"tool": {"mass_kg": 0.75, "com_m": [0.004, -0.006, 0.16],
    "inertia_kgm2": [0.02, 0.021, 0.003, 0.0001, 0.0002, 0.0003]}, "gravity_mps2": [0, 0, -9.81],
    "sensor": {"bias_n": [1, 2, 3], "rotation_rpy": [0.1, 0.2, 0.3]}, "model": {"inertial": "linear"},
    "sample_rate_hz": 250,
    "effects": [{"effect": "hysteresis", "axis": "gamma:sensor_y", "interval_s": [1.0, 2.0],
                 "recording": "a.csv", "parameters": {"force_n": 0.3, "width_rad": 0.2, "asym": 0.5}}]})");
}

TEST(Simulator, ReadsBackWhatItWrites) {
  const Simulator simulator = parse_simulator(example_sim(), "sim.json", Exit::kData);
  EXPECT_EQ(simulator.model.mass, 0.75);
  EXPECT_EQ((*simulator.model.inertia)(0, 2), 0.0002);
  EXPECT_EQ(simulator.model.inertial, ToolModel::Inertial::kLinear);
  const Json once = to_json(simulator);
  EXPECT_EQ(once, to_json(parse_simulator(once, "again", Exit::kData)));
  EXPECT_EQ(once["effects"], example_sim()["effects"]);
  EXPECT_EQ(once["tool"], example_sim()["tool"]);
}

/// The message of the Error that the changed sim.json is refused with.
std::string refusal_of_simulator(const std::string& pointer, const Json& value) {
  Json json = example_sim();
  at_pointer(json, pointer) = value;
  try {
    parse_simulator(json, "sim.json", Exit::kData);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

TEST(Simulator, RefusesWhatCannotBeInOneLine) {
  EXPECT_NE(refusal_of_simulator("/tool/mass_kg", -0.1).find("tool.mass_kg"), std::string::npos);
  EXPECT_NE(refusal_of_simulator("/tool/com_m", {1, 2}).find("3 numbers"), std::string::npos);
  EXPECT_NE(refusal_of_simulator("/tool/com_m/0", "a").find("com_m"), std::string::npos);
  EXPECT_NE(refusal_of_simulator("/tool/inertia_kgm2/0", -1.0).find("negative"), std::string::npos);
  EXPECT_NE(refusal_of_simulator("/tool/mas_kg", 1.0).find("did you mean"), std::string::npos);
  EXPECT_NE(refusal_of_simulator("/model/inertial", "half").find("full, linear, none"),
            std::string::npos);
  EXPECT_NE(refusal_of_simulator("/sample_rate_hz", 0).find("sample_rate_hz"), std::string::npos);
  EXPECT_NE(refusal_of_simulator("/effects/0/effect", "hysteresys").find("'hysteresis'"),
            std::string::npos);
  EXPECT_NE(refusal_of_simulator("/effects", 3).find("list"), std::string::npos);
  Json empty = Json::object();
  EXPECT_THROW(parse_simulator(empty, "sim.json", Exit::kData), Error);
}

}  // namespace
}  // namespace dcnn
