// SPDX-License-Identifier: Apache-2.0
// The pose of a link by a URDF against the product of its turns.
#include <gtest/gtest.h>

#include "dcnn/data/rotation.h"
#include "import/logs.h"

namespace dcnn {
namespace {

using test::cell;
using test::data_error;

constexpr const char* kRobot = R"(<robot name="two">
  <link name="base"/><link name="upper"/><link name="lower"/><link name="tool"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.5" rpy="0 0 1.0"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.4 0 0" rpy="0.2 0 0"/><axis xyz="1 0 0"/></joint>
  <joint name="flange" type="fixed"><parent link="lower"/><child link="tool"/>
    <origin xyz="0 0 0.1" rpy="0 0.3 0"/></joint>
</robot>)";

Imported import_arm(const std::string& names, const std::string& link) {
  const test::TemporaryFolder folder;
  test::spill(folder / "robot.urdf", kRobot);
  test::spill(folder / "log.txt", "t " + names + " fx fy fz\n0 0 0 1 2 3\n0.01 0.7 -0.4 1 2 3\n");
  ImportWishes wishes;
  wishes.arm = {(folder / "robot.urdf").string(), "", link};
  return test::import_log({folder / "log.txt"}, wishes);
}

TEST(ArmPose, IsTheProductOfOriginsAndTurns) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const auto turn = [&](double angle, const Eigen::Vector3d& axis) {
    T.rotate(Eigen::AngleAxisd(angle, axis));
  };
  T.translate(Eigen::Vector3d(0, 0, 0.5));
  turn(1.0, Eigen::Vector3d::UnitZ());
  turn(0.7, Eigen::Vector3d::UnitY());
  T.translate(Eigen::Vector3d(0.4, 0, 0));
  turn(0.2 - 0.4, Eigen::Vector3d::UnitX());
  T.translate(Eigen::Vector3d(0, 0, 0.1));
  turn(0.3, Eigen::Vector3d::UnitY());
  Imported imported;
  try {
    imported = import_arm("q1 q2", "tool");
  } catch (const Error& error) {
    if (std::string(error.what()).find("liburdfdom-dev") == std::string::npos) throw;
    GTEST_SKIP() << error.what();
  }
  const Eigen::Matrix3d R =
      rotation_from_quaternion({cell(imported, "qw", 1), cell(imported, "qx", 1),
                                cell(imported, "qy", 1), cell(imported, "qz", 1)});
  EXPECT_LT((R - T.rotation()).norm(), 1e-9);
  EXPECT_NEAR(cell(imported, "x", 1), T.translation().x(), 1e-9);
  EXPECT_NEAR(cell(imported, "z", 1), T.translation().z(), 1e-9);
  EXPECT_FALSE(test::has_column(imported, "q_1"));
  EXPECT_NE(data_error([] { import_arm("q1 q2", "hand"); }).find("one of: "), std::string::npos);
  EXPECT_NE(data_error([] { import_arm("q7 q8", "tool"); }).find("'shoulder'"), std::string::npos);
}

}  // namespace
}  // namespace dcnn
