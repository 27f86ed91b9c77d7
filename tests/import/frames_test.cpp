// SPDX-License-Identifier: Apache-2.0
// Orientations of every kind, wrenches in other frames, streams of other clocks.
#include <gtest/gtest.h>

#include <numbers>

#include "dcnn/data/rotation.h"
#include "import/logs.h"

namespace dcnn {
namespace {

using test::cell;
using test::data_error;
using test::import_text;

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

Matrix3 about(char axis, double angle) {
  return Eigen::AngleAxisd(angle, Vector3::Unit(axis - 'x')).toRotationMatrix();
}

/// A log of two rows; the second has the given pose columns.
std::string log_of(const std::string& names, const std::string& first, const std::string& second) {
  return "t " + names + " fx fy fz tx ty tz\n0 " + first + " 1 2 3 0.1 0.2 0.3\n0.01 " + second +
         " 1 2 3 0.1 0.2 0.3\n";
}

Matrix3 rotation_of(const Imported& imported, Index row) {
  if (test::has_column(imported, "alpha")) {
    return rotation_from_euler(
        {cell(imported, "alpha", row), cell(imported, "beta", row), cell(imported, "gamma", row)});
  }
  return rotation_from_quaternion({cell(imported, "qw", row), cell(imported, "qx", row),
                                   cell(imported, "qy", row), cell(imported, "qz", row)});
}

const Matrix3 kTurn = about('z', 0.3) * about('y', -0.2) * about('x', 0.7);

TEST(Frames, RollPitchYawOfEveryOrder) {
  const std::string angles = "0.7 -0.2 0.3";
  const std::string text = log_of("roll pitch yaw", "0 0 0", angles);
  EXPECT_LT((rotation_of(import_text(text), 1) - kTurn).norm(), 1e-12);
  ImportWishes wishes;
  wishes.euler_order = "xyz";
  EXPECT_LT((rotation_of(import_text(text, wishes), 1) - kTurn).norm(), 1e-12);
  wishes.euler_order = "XYZ";
  const Matrix3 other = about('x', 0.7) * about('y', -0.2) * about('z', 0.3);
  EXPECT_LT((rotation_of(import_text(text, wishes), 1) - other).norm(), 1e-12);
  wishes.euler_order = "ZYZ";
  wishes.map = {{"rot1", "a1"}, {"rot2", "a2"}, {"rot3", "a3"}};
  const Matrix3 proper = about('z', 0.7) * about('y', -0.2) * about('z', 0.3);
  const std::string named = log_of("a1 a2 a3", "0 0 0", angles);
  EXPECT_LT((rotation_of(import_text(named, wishes), 1) - proper).norm(), 1e-12);
  wishes.euler_order = "ZZY";
  EXPECT_NE(data_error([&] { import_text(named, wishes); }).find("no order"), std::string::npos);
}

TEST(Frames, MatricesAndRotationVectors) {
  std::ostringstream matrix;
  matrix.precision(17);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix << kTurn(i, j) << " ";
  }
  const std::string names = "r11 r12 r13 r21 r22 r23 r31 r32 r33";
  EXPECT_LT((rotation_of(import_text(log_of(names, "1 0 0 0 1 0 0 0 1", matrix.str())), 1) - kTurn)
                .norm(),
            1e-12);
  const std::string mirrored = "-1 0 0 0 1 0 0 0 1";
  EXPECT_NE(data_error([&] { import_text(log_of(names, mirrored, mirrored)); }).find("left-handed"),
            std::string::npos);
  const Eigen::AngleAxisd turn(kTurn);
  std::ostringstream vector;
  vector.precision(17);
  vector << "0.4 0.5 0.6 " << (turn.angle() * turn.axis()).transpose();
  const Imported imported =
      import_text(log_of("actual_TCP_pose_0 actual_TCP_pose_1 actual_TCP_pose_2 actual_TCP_pose_3 "
                         "actual_TCP_pose_4 actual_TCP_pose_5",
                         "0 0 0 0 0 0", vector.str()));
  EXPECT_LT((rotation_of(imported, 1) - kTurn).norm(), 1e-12);
  EXPECT_EQ(cell(imported, "z", 1), 0.6);
}

TEST(Frames, QuaternionsOfEitherOrder) {
  const std::string names =
      "pose.orientation[0] pose.orientation[1] pose.orientation[2] "
      "pose.orientation[3]";
  const std::string text = log_of(names, "0.8 0.6 0 0", "-0.8 -0.6 0 0");
  EXPECT_NE(data_error([&] { import_text(text); }).find("--quaternion-order"), std::string::npos);
  ImportWishes wishes;
  wishes.quaternion_order = "wxyz";
  const Imported imported = import_text(text, wishes);
  EXPECT_EQ(cell(imported, "qx", 1), 0.6);  // of the same sign as in the row before
  wishes.quaternion_order = "xyzw";
  EXPECT_EQ(cell(import_text(text, wishes), "qx", 0), 0.8);
  EXPECT_NE(
      data_error([&] { import_text(log_of("qw qx qy qz", "1 1 0 0", "1 0 0 0")); }).find("length"),
      std::string::npos);
}

TEST(Frames, OfAURsForceIsTheBase) {
  const Eigen::AngleAxisd turn(kTurn);
  std::ostringstream text;
  text.precision(17);
  text << "t,actual_TCP_pose_0,actual_TCP_pose_1,actual_TCP_pose_2,actual_TCP_pose_3,"
          "actual_TCP_pose_4,actual_TCP_pose_5,actual_TCP_force_0,actual_TCP_force_1,"
          "actual_TCP_force_2\n0,0,0,0,0,0,0,1,2,3\n0.002,0,0,0";
  for (int k = 0; k < 3; ++k) text << "," << (turn.angle() * turn.axis())[k];
  text << ",1,2,3\n";
  ImportWishes wishes;
  wishes.wrench.frame = "auto";
  const Vector3 f = kTurn.transpose() * Vector3(1, 2, 3);
  EXPECT_NEAR(cell(import_text(text.str(), wishes), "fx", 1), f.x(), 1e-12);
  wishes.wrench.frame = "sensor";
  EXPECT_EQ(cell(import_text(text.str(), wishes), "fx", 1), 1.0);
}

// libfranka's state: a matrix by columns, and the wrench in the base frame (O) or in the hand's
// (K).
TEST(Frames, OfAFrankasWrenchIsInItsName) {
  for (const char* frame : {"O", "K"}) {
    std::ostringstream text;
    text.precision(17);
    text << "time";
    for (int k = 0; k < 16; ++k) text << ",O_T_EE[" << k << "]";
    for (int k = 0; k < 6; ++k) text << "," << frame << "_F_ext_hat_K[" << k << "]";
    for (int row = 0; row < 2; ++row) {
      text << "\n" << 0.002 * row;
      for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 3; ++r) text << "," << (c < 3 ? kTurn(r, c) : 0.1 * r);
        text << "," << (c == 3);
      }
      text << ",1,2,3,0.1,0.2,0.3";
    }
    ImportWishes wishes;
    wishes.wrench.frame = "auto";
    const Imported imported = import_text(text.str() + "\n", wishes);
    const bool in_base = std::string(frame) == "O";
    const Vector3 f = in_base ? Vector3(kTurn.transpose() * Vector3(1, 2, 3)) : Vector3(1, 2, 3);
    EXPECT_NEAR(cell(imported, "fx", 1), f.x(), 1e-12);
    EXPECT_NEAR(cell(imported, "fz", 1), f.z(), 1e-12);
    EXPECT_NEAR(cell(imported, "z", 1), 0.2, 1e-12);
  }
}

TEST(Frames, AWrenchInTheBaseFrameIsTurnedAndShifted) {
  ImportWishes wishes;
  wishes.wrench.frame = "base";
  wishes.wrench.origin = {0.0, 0.0, 0.1};
  const Imported imported = import_text(log_of("roll pitch yaw", "0 0 0", "0.7 -0.2 0.3"), wishes);
  const Vector3 f = kTurn.transpose() * Vector3(1, 2, 3);
  const Vector3 torque = kTurn.transpose() * Vector3(0.1, 0.2, 0.3) + Vector3(0, 0, 0.1).cross(f);
  EXPECT_NEAR(cell(imported, "fx", 1), f.x(), 1e-12);
  EXPECT_NEAR(cell(imported, "fz", 1), f.z(), 1e-12);
  EXPECT_NEAR(cell(imported, "ty", 1), torque.y(), 1e-12);
}

TEST(Frames, StreamsOfOtherClocksAreJoined) {
  const test::TemporaryFolder folder;
  std::ostringstream force, pose;
  force.precision(17);
  pose.precision(17);
  force << "t fx fy fz\n";
  pose << "time_ms;x [mm];y [mm];z [mm];qw;qx;qy;qz\n";
  constexpr double kHz = 0.5 * 2.0 * std::numbers::pi;  // rad/s
  for (int k = 0; k < 1000; ++k) force << 0.002 * k << " " << k << " 0 1\n";
  for (int k = -10; k < 190; ++k) {
    const double t = 0.010 * k;
    const double angle = std::sin(kHz * t);
    pose << 1e3 * (t + 0.25) << ";" << 1e3 * std::sin(kHz * t) << ";0;0;" << std::cos(angle / 2)
         << ";" << std::sin(angle / 2) << ";0;0\n";
  }
  test::spill(folder / "force.txt", force.str());
  test::spill(folder / "pose.csv", pose.str());
  ImportWishes wishes;
  wishes.clock_offsets = {{"file2", -0.25}};
  const Imported imported = test::import_log({folder / "force.txt", folder / "pose.csv"}, wishes);
  EXPECT_EQ(imported.table.values.rows(), 946);  // up to the last pose at 1.89 s
  for (Index row = 0; row < imported.table.values.rows(); row += 7) {
    const double t = cell(imported, "t", row);
    EXPECT_EQ(cell(imported, "fx", row), static_cast<double>(row));
    EXPECT_NEAR(cell(imported, "x", row), std::sin(kHz * t), 1e-5);
    EXPECT_NEAR(cell(imported, "qx", row), std::sin(std::sin(kHz * t) / 2), 1e-5);
  }
  EXPECT_NE(imported.notes.at(0).find("100 Hz"), std::string::npos) << imported.notes.at(0);
}

TEST(Frames, NothingIsInterpolatedAcrossAGap) {
  const test::TemporaryFolder folder;
  std::ostringstream force, pose;
  force << "t fx fy fz\n";
  pose << "t qw qx qy qz\n";
  for (int k = 0; k < 100; ++k) {
    force << 0.01 * k << " 1 2 3\n";
    if (k < 30 || k > 60) pose << 0.01 * k << " 1 0 0 0\n";
  }
  test::spill(folder / "force.txt", force.str());
  test::spill(folder / "pose.txt", pose.str());
  const Imported imported = test::import_log({folder / "force.txt", folder / "pose.txt"});
  EXPECT_EQ(imported.table.values.rows(), 69);
}

}  // namespace
}  // namespace dcnn
