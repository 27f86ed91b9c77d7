// SPDX-License-Identifier: Apache-2.0
// Whole arms from simulated joint torques.
#include "dcnn/identification/arm.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "dcnn/data/csv.h"
#include "dcnn/physics/axis_machine.h"
#include "identification/arm_log.h"
#include "support/process.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

const Json kDh{{0.0, 1.5707963267948966, 0.18, 0.0},
               {-0.6, 0.0, 0.0, 0.0},
               {0.0, 1.5707963267948966, 0.15, 0.0}};

Json system_json() {
  Json axes = Json::array();
  for (const char* k : {"1", "2", "3"}) {
    axes.push_back(Json{{"name", std::string("joint") + k},
                        {"measured", std::string("tau_") + k},
                        {"unit", "N*m"},
                        {"position", std::string("q_") + k}});
  }
  return {{"kind", "axes"},
          {"lowpass_hz", 8},
          {"axes", axes},
          {"arm", {{"convention", "standard"}, {"dh", kDh}}}};
}

JointChain arm_chain() { return parse_chain(system_json()["arm"], "test", Exit::kData); }

/// A body of mass m at c, like a ball of radius of gyration 5 cm.
BodyVector ball(double m, const Eigen::Vector3d& c) {
  BodyVector at_com;
  at_com << m, 0, 0, 0, 0.0025 * m, 0, 0, 0.0025 * m, 0, 0.0025 * m;
  return body_in_frame(at_com, Eigen::Matrix3d::Identity(), -c);
}

struct Truth {
  double fc = 4.0, c = 6.0, path = 1e-3, payload = 0.0, mu = 0.0;
  Eigen::Vector3d centre{0.02, 0.0, 0.03};
  double shakes = 0.0;  ///< rad/s^2 of joints 1 and 2, whose drives give way
  double slow = 0.0;    ///< N·m on joint 3 of no law that is looked for
  double noise = 0.2;   ///< N·m
  Index rows = 4000;
};

/// 40 s at 100 Hz of sums of sines, with stops; torque noise 0.2 N·m.
void write_log(const std::filesystem::path& file, const Truth& truth, std::uint64_t seed) {
  const Index n = truth.rows;
  const double dt = 0.01;
  Rng rng({seed, 77});
  const JointChain chain = arm_chain();
  MatrixXd q(n, 3), v(n, 3), a(n, 3);
  for (Index j = 0; j < 3; ++j) {
    q.col(j).setZero(), v.col(j).setZero(), a.col(j).setZero();
    for (int tone = 1; tone <= 5; ++tone) {
      const double w = 2.0 * M_PI * 0.05 * (tone + 0.2 * rng.uniform()) * (1.0 + 0.3 * double(j));
      const double amplitude = 0.5 / tone, phase = rng.uniform(0.0, 6.28);
      for (Index k = 0; k < n; ++k) {
        const double angle = w * dt * static_cast<double>(k) + phase;
        q(k, j) += amplitude * std::sin(angle);
        v(k, j) += amplitude * w * std::cos(angle);
        a(k, j) -= amplitude * w * w * std::sin(angle);
      }
    }
  }
  VectorXd shaking = VectorXd::Zero(n);
  for (const double hz : {4.3, 5.6, 6.7}) {
    const double phase = rng.uniform(0.0, 6.28);
    for (Index k = 0; k < n; ++k) {
      shaking(k) += truth.shakes * std::sin(2.0 * M_PI * hz * dt * static_cast<double>(k) + phase);
    }
  }
  for (Index j = 0; j < 2; ++j) {
    q.col(j) += shaking / 1194.0;  // (2 pi 5.5 Hz)^2
    a.col(j) -= shaking;
  }
  VectorXd bodies(30);
  bodies << ball(8.0, {0.0, -0.1, 0.0}), ball(6.0, {-0.3, 0.0, 0.05}), ball(2.0, {0.0, 0.02, 0.1});
  const Eigen::Matrix3d back = chain.flange_R.transpose();
  bodies.tail(10) +=
      body_in_frame(ball(truth.payload, truth.centre), back, -(back * chain.flange_p));
  Table table;
  table.columns = {"t"};
  table.values.resize(n, 7);
  for (Index k = 0; k < n; ++k) table.values(k, 0) = dt * static_cast<double>(k);
  for (std::size_t j = 0; j < 3; ++j) {
    const auto joint = static_cast<Index>(j);
    const VectorXd z = identification::dahl_state(q.col(joint), {{0, n}}, truth.path);
    const VectorXd rigid = chain_regressor(chain, q, v, a, j) * bodies;
    VectorXd torque = rigid + truth.fc * z + truth.mu * z.cwiseProduct(rigid.cwiseAbs()) +
                      truth.c * v.col(joint) + 0.5 * a.col(joint);
    for (Index k = 0; k < n; ++k) {
      const double t = dt * static_cast<double>(k);
      if (j < 2) torque(k) += 6.0 * shaking(k);
      if (j == 2) torque(k) += truth.slow * std::sin(5.0 * q(k, 2)) * std::sin(0.7 * t);
      torque(k) += truth.noise * rng.normal();
    }
    table.columns.push_back("q_" + std::to_string(j + 1));
    table.values.col(1 + joint) = q.col(joint);
    table.values.col(4 + joint) = torque;
  }
  for (int j = 1; j <= 3; ++j) table.columns.push_back("tau_" + std::to_string(j));
  write_csv(file, table);
}

const IdentifiedNumber& of(const std::vector<IdentifiedNumber>& estimates,
                           const std::string& name) {
  for (const IdentifiedNumber& e : estimates) {
    if (e.name == name) return e;
  }
  throw std::runtime_error("no " + name);
}

class ArmIdentify : public ::testing::Test {
 protected:
  ArmRequest request(const Truth& truth, bool with_payload) {
    ArmRequest r;
    r.system = folder_ / "arm.json";
    std::ofstream(r.system) << system_json();
    write_log(folder_ / "a.csv", truth, 1);
    write_log(folder_ / "held.csv", truth, 2);
    r.logs = {folder_ / "a.csv"};
    r.holdout = {folder_ / "held.csv"};
    if (!with_payload) return r;
    Truth loaded = truth;
    loaded.payload = 2.6;
    write_log(folder_ / "loaded.csv", loaded, 3);
    r.loaded = {folder_ / "loaded.csv"};
    return r;
  }
  test::TemporaryFolder folder_;
};

TEST_F(ArmIdentify, FrictionAndLinksPredictHeldOutTorquesToTheNoise) {
  const ArmIdentification id = identify_arm(request({}, false));
  ASSERT_EQ(id.joints.size(), 3U);
  for (const JointEstimate& joint : id.joints) {
    EXPECT_NEAR(of(joint.parameters, "fc").value, 4.0, 0.2) << joint.name;
    EXPECT_NEAR(of(joint.parameters, "c").value, 6.0, 0.4) << joint.name;
    EXPECT_NEAR(joint.presliding, 1e-3, 1e-12) << joint.name;
    // White noise of 0.2 N·m in a band of 8 of 50 Hz is 0.08 N·m.
    EXPECT_LT(*joint.holdout_rms, 0.12) << joint.name;
    EXPECT_EQ(joint.parameters.size(), 4U) << to_text(id);
  }
  EXPECT_GT(id.base_parameters, 8);
  EXPECT_LT(id.base_parameters, 30);
  EXPECT_TRUE(id.payload.empty());
  EXPECT_NE(to_text(id).find("dry friction on joints 1 to 3"), std::string::npos) << to_text(id);
}

/// What a wrong model leaves of a wrist stays long; counted as so few rows, the wrist would be
/// given up for what the base leaves less of, and then leave ever more.
TEST_F(ArmIdentify, NoJointIsGivenUpForAnother) {
  Truth truth;
  truth.fc = 0.5, truth.c = 0.3, truth.noise = 0.02, truth.rows = 1600;
  truth.shakes = 1.0, truth.slow = 0.3;
  const ArmIdentification id = identify_arm(request(truth, false));
  // The rms of a product of two sines is half of its size.
  EXPECT_LT(*id.joints[2].holdout_rms, 1.4 * 0.5 * truth.slow) << to_text(id);
}

/// On the joint that bears the links' weight, the description that was found leaves of a held-out
/// log what drives add: offset, friction, rotor, noise.
TEST_F(ArmIdentify, TheDescriptionFoundIsASimulator) {
  const ArmRequest asked = request({}, false);
  const AxisMachine machine = machine_of(parse_system(identify_arm(asked).system, "found.json"));
  const Recording held = read_recording(asked.holdout[0], ReadOptions(), machine.system);
  const MatrixXd torque = predict_axes(machine, held);
  const Motion motion = axis_motion(held, machine.system.axes[1],
                                    {.kind = DerivativeSpec::Kind::kSpectral, .cutoff_hz = 8.0});
  const VectorXd v = motion.v_B.col(0);
  MatrixXd drive(v.size(), 4);
  drive << VectorXd::Ones(v.size()), (v / 0.02).array().tanh().matrix(), v, motion.a_B.col(0);
  const VectorXd measured = held.column("tau_2"), left = measured - torque.col(1);
  const VectorXd unexplained = left - drive * drive.householderQr().solve(left);
  EXPECT_LT(unexplained.norm(), 0.05 * measured.norm());
}

TEST_F(ArmIdentify, APayloadIsABodyAtTheFlange) {
  const ArmIdentification id = identify_arm(request({}, true));
  const IdentifiedNumber mass = of(id.payload, "mass_kg");
  EXPECT_NEAR(mass.value, 2.6, 0.03 * 2.6);
  EXPECT_NEAR(of(id.payload, "com_x_m").value, 0.02, 0.005);
  EXPECT_NEAR(of(id.payload, "com_z_m").value, 0.03, 0.01);
  EXPECT_NE(to_text(id).find("payload of 2.6 kg"), std::string::npos) << to_text(id);
  for (const JointEstimate& joint : id.joints) {
    EXPECT_NEAR(of(joint.parameters, "fc").value, 4.0, 0.2) << joint.name;
  }
}

TEST_F(ArmIdentify, FrictionThatGrowsWithTheLoadIsNamed) {
  Truth truth;
  truth.mu = 0.1;
  const ArmIdentification id = identify_arm(request(truth, false));
  EXPECT_NEAR(of(id.joints[1].parameters, "mu").value, 0.1, 0.02) << to_text(id);
}

/// A term that is added later moves no other number's place.
TEST_F(ArmIdentify, APayloadIsFoundBesideFrictionThatGrowsWithTheLoad) {
  Truth truth;
  truth.mu = 0.1;
  const ArmIdentification id = identify_arm(request(truth, true));
  EXPECT_NEAR(of(id.payload, "mass_kg").value, 2.6, 0.05 * 2.6) << to_text(id);
  EXPECT_NEAR(of(id.joints[1].parameters, "mu").value, 0.1, 0.02) << to_text(id);
}

TEST_F(ArmIdentify, FrictionThatDrivesIsAWrongSign) {
  ArmRequest r = request({}, false);
  Json json = system_json();
  json["axes"][1]["scale"] = -1.0;
  std::ofstream(r.system) << json;
  const std::string text = to_text(identify_arm(r));
  EXPECT_NE(text.find("dry friction on joints 1, 3;"), std::string::npos) << text;
  EXPECT_NE(text.find("would drive joint 2"), std::string::npos) << text;
}

/// A list of `poses` at rest, without times, of the same arm; noise 0.2 N·m.
void write_poses(const std::filesystem::path& file, Index poses, double payload,
                 std::uint64_t seed) {
  Rng rng({seed, 78});
  const JointChain chain = arm_chain();
  MatrixXd q(poses, 3);
  for (double& angle : q.reshaped()) angle = rng.uniform(-1.5, 1.5);
  VectorXd bodies(30);
  bodies << ball(8.0, {0.0, -0.1, 0.0}), ball(6.0, {-0.3, 0.0, 0.05}), ball(2.0, {0.0, 0.02, 0.1});
  const Eigen::Matrix3d back = chain.flange_R.transpose();
  bodies.tail(10) += body_in_frame(ball(payload, Truth().centre), back, -(back * chain.flange_p));
  Table table{{"q_1", "q_2", "q_3", "tau_1", "tau_2", "tau_3"}, MatrixXd(poses, 6)};
  table.values.leftCols(3) = q;
  const MatrixXd still = MatrixXd::Zero(poses, 3);
  for (std::size_t j = 0; j < 3; ++j) {
    VectorXd torque = chain_regressor(chain, q, still, still, j) * bodies;
    for (double& value : torque) value += 0.7 + 0.2 * rng.normal();
    table.values.col(3 + static_cast<Index>(j)) = torque;
  }
  write_csv(file, table);
}

TEST_F(ArmIdentify, PosesAtRestTellWeightsAndAPayload) {
  ArmRequest r = request({}, false);
  write_poses(folder_ / "poses.csv", 40, 0.0, 1);
  write_poses(folder_ / "loaded.csv", 40, 2.6, 2);
  write_poses(folder_ / "held.csv", 200, 0.0, 3);
  r.logs = {folder_ / "poses.csv"};
  r.loaded = {folder_ / "loaded.csv"};
  r.holdout = {folder_ / "held.csv"};
  const ArmIdentification id = identify_arm(r);
  const IdentifiedNumber mass = of(id.payload, "mass_kg");
  EXPECT_NEAR(mass.value, 2.6, 0.03 * 2.6);
  EXPECT_LT(mass.high - mass.low, 0.2);
  EXPECT_EQ(id.lowpass_hz, 0.0);
  for (const JointEstimate& joint : id.joints) {
    EXPECT_NEAR(of(joint.parameters, "offset").value, 0.7, 0.3) << joint.name;
    EXPECT_EQ(joint.parameters.size(), 1U) << joint.name;
    EXPECT_LT(*joint.holdout_rms, 0.25) << joint.name;
    EXPECT_NEAR(joint.residual_rms, 0.2, 0.03) << joint.name;
  }
  EXPECT_EQ(to_text(id).find("friction on"), std::string::npos) << to_text(id);
  try {  // where motion is wanted
    read_recording(folder_ / "poses.csv", ReadOptions(), read_system(r.system));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("dcnn-identify"), std::string::npos) << error.what();
  }
}

TEST_F(ArmIdentify, MistakesAreOneLine) {
  ArmRequest r = request({}, false);
  r.drive_gains = true;
  EXPECT_THROW(identify_arm(r), Error);
  r.drive_gains = false;
  Json json = system_json();
  json.erase("arm");
  std::ofstream(r.system) << json;
  EXPECT_THROW(identify_arm(r), Error);
}

}  // namespace
}  // namespace dcnn
