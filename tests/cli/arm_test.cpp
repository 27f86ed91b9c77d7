// SPDX-License-Identifier: Apache-2.0
// Arms as a user has them: a URDF, torques simulated and diagnosed by it.
#include <gtest/gtest.h>

#include <cmath>

#include "data/testing.h"
#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/data/csv.h"
#include "dcnn/physics/axis_machine.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;
using testing::contains;

constexpr const char* kUrdf = R"(<robot name="two"><link name="base"/>
<joint name="a" type="revolute"><parent link="base"/><child link="one"/>
 <origin xyz="0 0 0.3" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/><limit effort="1" velocity="1"/></joint>
<link name="one"><inertial><origin xyz="0.2 0 0.1" rpy="0 0 0"/><mass value="3"/>
 <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.05"/></inertial></link>
<joint name="b" type="revolute"><parent link="one"/><child link="two"/><origin xyz="0.4 0 0"/>
 <axis xyz="0 0 1"/><limit effort="1" velocity="1"/></joint>
<link name="two"><inertial><origin xyz="0.15 0.02 0" rpy="0 0 0"/><mass value="2"/>
 <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.03"/></inertial></link></robot>)";

Json two_axes() {
  Json axes = Json::array();
  for (const char* k : {"1", "2"}) {
    axes.push_back({{"name", std::string("joint") + k},
                    {"measured", std::string("tau_") + k},
                    {"unit", "N*m"},
                    {"position", std::string("q_") + k}});
  }
  return {{"kind", "axes"}, {"axes", axes}};
}

/// 30 s at 200 Hz.
Table motion() {
  Table table;
  table.columns = {"t", "q_1", "q_2"};
  table.values.resize(6000, 3);
  for (Eigen::Index i = 0; i < 6000; ++i) {
    const double t = 0.005 * static_cast<double>(i);
    table.values.row(i) << t, 0.7 * std::sin(1.9 * t) + 0.3 * std::sin(0.6 * t),
        0.8 * std::sin(1.3 * t + 1.0) + 0.3 * std::sin(2.7 * t);
  }
  return table;
}

class ArmPrograms : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(folder_ / "robot.urdf", kUrdf);
    Json joints = two_axes();  // as dcnn-import describes them
    for (Json& axis : joints["axes"]) axis["base"] = Json::array();
    write_file(folder_ / "joints.json", joints.dump(1));
    write_csv(folder_ / "motion.csv", motion());
  }
  std::string at(const std::string& name) { return (folder_ / name).string(); }
  test::TemporaryFolder folder_;
};

TEST_F(ArmPrograms, TorquesOfAUrdfAreSimulatedAndThenNothingIsMissing) {
  // Logs of the arm at rest, to let dcnn-diagnose describe it by its URDF.
  Table log = motion();
  log.columns.insert(log.columns.end(), {"tau_1", "tau_2"});
  log.values.conservativeResize(Eigen::NoChange, 5);
  Rng rng({1u});
  for (Eigen::Index i = 0; i < log.values.rows(); ++i) {
    // Closed form of gravity alone at both joints (the motion's inertia is what is missing in it).
    const double q1 = log.values(i, 1), q12 = q1 + log.values(i, 2), g = 9.81;
    const double second = 2.0 * g * (0.15 * std::cos(q12) - 0.02 * std::sin(q12));
    log.values(i, 3) = g * (3.0 * 0.2 + 2.0 * 0.4) * std::cos(q1) + second + 0.05 * rng.normal();
    log.values(i, 4) = second + 0.05 * rng.normal();
  }
  write_csv(folder_ / "gravity.csv", log);
  const auto first = run("diagnose", {"--system", at("joints.json"), "--urdf", at("robot.urdf"),
                                      "--fit", at("gravity.csv"), "--out", at("first"), "-q"});
  if (contains(first.err, "reads no URDF")) GTEST_SKIP() << first.err;
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const Json model = read_json(folder_ / "first" / "model.json", Exit::kData);
  ASSERT_TRUE(model["system"]["arm"]["joints"][0].contains("body")) << model["system"].dump(1);

  // The description that model.json holds is a simulator of its own.
  write_file(folder_ / "arm.json", model["system"].dump(1));
  const auto simulated = run(
      "sim", {"--sim", at("arm.json"), "--motion", at("motion.csv"), "--out", at("torques.csv")});
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  Table torques = read_csv(folder_ / "torques.csv");
  const auto column = [&](const std::string& name) {
    const auto found = std::find(torques.columns.begin(), torques.columns.end(), name);
    return static_cast<Eigen::Index>(found - torques.columns.begin());
  };
  for (const char* name : {"tau_1", "tau_2"}) {
    ASSERT_LT(column(name), torques.values.cols());
    for (double& value : torques.values.col(column(name))) value += 0.05 * rng.normal();
  }
  write_csv(folder_ / "log.csv", torques);
  const auto right = run("diagnose", {"--system", at("joints.json"), "--urdf", at("robot.urdf"),
                                      "--fit", at("log.csv"), "--out", at("right"), "-q"});
  ASSERT_EQ(right.exit_code, 0) << right.err;
  const Json report = read_json(folder_ / "right" / "report.json", Exit::kData);
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"].dump(1);
  EXPECT_EQ(report["arm"]["words"], "nothing is missing");
}

/// Gravity at both joints in closed form, noise of 0.05 N·m; the second joint's angle as `sign` has
/// it.
Table resting_log(double sign) {
  Table log = motion();
  log.columns.insert(log.columns.end(), {"tau_1", "tau_2"});
  log.values.conservativeResize(Eigen::NoChange, 5);
  Rng rng({3u});
  for (Eigen::Index i = 0; i < log.values.rows(); ++i) {
    log.values(i, 0) *= 10.0;  // slow: nothing but gravity
    const double q1 = log.values(i, 1), q12 = q1 + log.values(i, 2), g = 9.81;
    const double second = 2.0 * g * (0.15 * std::cos(q12) - 0.02 * std::sin(q12));
    log.values(i, 3) = g * (3.0 * 0.2 + 2.0 * 0.4) * std::cos(q1) + second + 0.05 * rng.normal();
    log.values(i, 4) = second + 0.05 * rng.normal();
    log.values(i, 2) *= sign;
  }
  return log;
}

TEST_F(ArmPrograms, TheCheckComparesJointsWithTheUrdf) {
  write_csv(folder_ / "right.csv", resting_log(1.0));
  write_csv(folder_ / "turned.csv", resting_log(-1.0));
  // Columns q_1 and tau_1 alone: no description of the machine is needed.
  const auto right = run("check", {at("right.csv"), "--urdf", at("robot.urdf"), "--json"});
  if (contains(right.err, "reads no URDF")) GTEST_SKIP() << right.err;
  ASSERT_EQ(right.exit_code, 0) << right.err;
  EXPECT_TRUE(Json::parse(right.out)["faults"].empty()) << right.out;
  const auto turned = run("check", {at("turned.csv"), "--urdf", at("robot.urdf"), "--json"});
  ASSERT_EQ(turned.exit_code, 0) << turned.err;
  const Json fault = Json::parse(turned.out)["faults"][0];
  EXPECT_EQ(fault["fault"], "joint_sign") << turned.out;
  EXPECT_EQ(fault["channel"], "q_2");
  // The tools that learn from the log stop at it.
  const auto diagnosed = run("diagnose", {"--system", at("joints.json"), "--urdf", at("robot.urdf"),
                                          "--fit", at("turned.csv"), "--out", at("report"), "-q"});
  EXPECT_EQ(diagnosed.exit_code, 3);
  EXPECT_TRUE(contains(diagnosed.err, "joint_sign")) << diagnosed.err;

  Table three = resting_log(1.0);
  three.columns.insert(three.columns.end(), {"q_3", "tau_3"});
  three.values.conservativeResize(Eigen::NoChange, 7);
  three.values.rightCols(2) = three.values.middleCols(1, 2);
  write_csv(folder_ / "three.csv", three);
  const auto other = run("check", {at("three.csv"), "--urdf", at("robot.urdf")});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_TRUE(contains(other.err, "columns of 3 joints")) << other.err;
}

TEST_F(ArmPrograms, AnArmWithoutBodiesIsNoSimulator) {
  Json system = two_axes();
  system["arm"] = {{"dh", {{0.0, 1.57, 0.3, 0.0}, {0.4, 0.0, 0.0, 0.0}}}};
  write_file(folder_ / "dh.json", system.dump(1));
  const auto result =
      run("sim", {"--sim", at("dh.json"), "--motion", at("motion.csv"), "--out", at("no.csv")});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "describe the bodies of all links")) << result.err;
  system["arm"] = {{"joints", {{{"axis", {0, 0, 0}}}, Json::object()}}};
  write_file(folder_ / "bad.json", system.dump(1));
  const auto bad =
      run("sim", {"--sim", at("bad.json"), "--motion", at("motion.csv"), "--out", at("no.csv")});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_TRUE(contains(bad.err, "has no direction")) << bad.err;
}

}  // namespace
}  // namespace dcnn
