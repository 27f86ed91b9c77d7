// SPDX-License-Identifier: Apache-2.0
// Arms as others log them: names of joints in words of any order, one file per quantity.
#include <gtest/gtest.h>

#include "dcnn/import/summary.h"
#include "import/joint_names.h"
#include "import/log_builder.h"
#include "import/logs.h"
#include "import/number_arrays.h"
#include "import/roles.h"
#include "import/units.h"

namespace dcnn {
namespace {

using test::cell;
using test::data_error;
using test::has_column;
using test::import_log;
using test::import_text;
using test::spill;
using test::TemporaryFolder;

LogStream text_stream(const std::string& source) {
  LogStream stream;
  stream.name = "file1";
  stream.type = "text";
  stream.source = source;
  return stream;
}

TEST(JointColumns, AreKnownByWordsInAnyOrder) {
  const LogStream stream = text_stream("log");
  const std::pair<const char*, const char*> kNames[] = {
      {"pos_panda_joint1", "q:panda_joint1"},
      {"eff_panda_joint7", "tau:panda_joint7"},
      {"- arm_2_joint_velocity", "qd:arm_2_joint"},
      {"tau_measured[3]", "tau:3"},
      {"actual_q_0", "q:0"},
      {"actual_qd_5", "qd:5"},
      {"joint_position_0", "q:0"},
      {"JointTorque4", "tau:4"},
      {"joint3_vel", "qd:3"},
      {"Joint_2", "q:2"},
      {"q1", "q:1"},
      {"target_q_0", ""},
      {"qdd[2]", ""},
      {"tau_friction[0]", ""},
      {"joint_position_error_2", ""},
      {"tcp_position_0", "x"},
      {"position_1", "y"},
      {"position_axis_x", "x"},
      {"axis_2_speed", "qd:2"},
      {"pos_meas1", "q:1"},
      {"field.position0", "q:0"},
      {"AIPos.A1", "q:1"},
      {"ASPos.A1", ""},
      {"AxisTorque_A3", "tau:3"},
      {"J1 Disturb Torque", "tau:1"},
      {"actual_current_2", "current:2"},
      {"/joint_states/panda_joint1/position", "q:panda_joint1"},
      {"/joint_states/elbow_joint/effort", "tau:elbow_joint"},
      {"joint_temperature_1", ""}};
  for (const auto& [name, role] : kNames) EXPECT_EQ(role_of(stream, name), role) << name;
}

TEST(JointColumns, WithoutAQuantityHaveThatOfTheirFile) {
  EXPECT_EQ(role_of(text_stream("curr_data"), "Joint_1"), "tau:1");
  EXPECT_EQ(role_of(text_stream("run_torques"), "joint2"), "tau:2");
  EXPECT_EQ(role_of(text_stream("pos_read_data"), "Joint_1"), "q:1");
  EXPECT_EQ(role_of(text_stream("velocity"), "Joint_1"), "qd:1");
  EXPECT_EQ(role_of(text_stream("torque"), "q1"), "q:1");
}

// An array of more than three torques is an arm's, not the moment of a wrench.
TEST(JointColumns, OfAnArrayAreNoVector) {
  const Imported imported = import_text(
      "time,measuredJointPosition[0],measuredJointPosition[1],measuredJointPosition[2],"
      "measuredJointPosition[3],measuredTorque[0],measuredTorque[1],measuredTorque[2],"
      "measuredTorque[3]\n0,1,2,3,4,5,6,7,8\n0.01,1,2,3,4,5,6,7,8\n");
  EXPECT_EQ(cell(imported, "tau_0", 1), 5.0);
  EXPECT_EQ(cell(imported, "q_3", 1), 4.0);
  EXPECT_FALSE(has_column(imported, "x"));
}

// c11 to c33 are columns that are counted, of which a matrix of a frame has no fifth.
TEST(JointColumns, ThatAreCountedAreNoMatrix) {
  LogStream counted, frame;
  for (int k = 1; k <= 40; ++k) {
    LogChannel channel;
    channel.name = "c" + std::to_string(k);
    counted.channels.push_back(channel);
    channel.name = "T" + std::to_string(k / 10) + std::to_string(k % 10);
    if (k > 10 && k % 10 >= 1 && k % 10 <= 4) frame.channels.push_back(channel);
  }
  EXPECT_EQ(role_of(counted, "c12"), "");
  EXPECT_EQ(role_of(counted, "c14"), "");
  EXPECT_EQ(role_of(frame, "T12"), "r12");
  EXPECT_EQ(role_of(frame, "T14"), "x");
}

TEST(JointColumns, AsTheseToolsWriteThemMayHaveAnyName) {
  std::string text = "t,q_LJ1,q_Fore arm,tau_LJ1,tau_Fore arm,tau_extra\n";
  for (int k = 0; k < 60; ++k) {
    const double t = 0.01 * k;
    for (const double value : {t, std::sin(t), std::cos(t), 2.0 + t, 3.0 - t}) {
      text += std::to_string(value) + ",";
    }
    text += "1.5\n";
  }
  const Imported imported = import_text(text);
  for (const char* name : {"q_LJ1", "q_Fore arm", "tau_LJ1", "tau_Fore arm"}) {
    EXPECT_TRUE(has_column(imported, name)) << name;
  }
  EXPECT_FALSE(has_column(imported, "tau_extra"));
}

TEST(JointColumns, OfAnImuAreNoAccelerationOfTheOrigin) {
  const LogStream stream = text_stream("log");
  EXPECT_EQ(role_of(stream, "imu_ax"), "");
  EXPECT_EQ(role_of(stream, "tool_ax"), "ax");
}

// The order of a quaternion that nothing needs is not asked for.
TEST(JointColumns, WithTorquesNeedNoPose) {
  std::string text = "t,q1,q2,tau1,tau2,x,y,z,quat_0,quat_1,quat_2,quat_3\n";
  for (int k = 0; k < 20; ++k) {
    const std::string s = std::to_string(0.01 * k);
    text += s + ",0." + s.substr(2) + ",0.1,2,3,1,2,3,0.6,0.8,0,0\n";
  }
  const Imported imported = import_text(text);
  EXPECT_TRUE(has_column(imported, "q_2"));
  EXPECT_TRUE(has_column(imported, "tau_1"));
  EXPECT_FALSE(has_column(imported, "x"));
  EXPECT_FALSE(has_column(imported, "qw"));
}

TEST(JointColumns, OfCurrentsStandForTorques) {
  const Imported imported =
      import_text("t,J1 Pos,J2 Pos,J1 Current,J2 Current\n0,1,2,3,4\n0.01,1,2,5,6\n");
  EXPECT_EQ(cell(imported, "tau_2", 1), 6.0);
}

TEST(JointColumns, ThatAreSaidAreTakenInsteadOfAWrenchAndItsPose) {
  const std::string text =
      "t,actual_q_0,actual_q_1,actual_current_0,actual_current_1,actual_TCP_pose_0,"
      "actual_TCP_pose_1,actual_TCP_pose_2,actual_TCP_pose_3,actual_TCP_pose_4,actual_TCP_pose_5,"
      "fx,fy,fz\n0,1,2,3,4,0,0,0,0,0,1,1,2,3\n0.01,1,2,3,4,0,0,0,0,0,1,1,2,3\n";
  EXPECT_TRUE(has_column(import_text(text), "fx"));
  ImportWishes wishes;
  wishes.map = {{"q:0", "actual_q_0"}};
  const Imported arm = import_text(text, wishes);
  EXPECT_EQ(cell(arm, "q_1", 1), 2.0);
  EXPECT_EQ(cell(arm, "tau_1", 1), 4.0);
  EXPECT_FALSE(has_column(arm, "fx"));
}

TEST(JointColumns, OfOneFilePerQuantityAreOneRecording) {
  const TemporaryFolder folder;
  spill(folder / "angles.csv", "t,Joint_1,Joint_2\n0,0.1,0.2\n0.01,0.3,0.4\n0.02,0.5,0.6\n");
  spill(folder / "torques.csv", "t,Joint_1,Joint_2\n0,1,2\n0.01,3,4\n0.02,5,6\n");
  const Imported imported = import_log({folder / "angles.csv", folder / "torques.csv"});
  EXPECT_EQ(cell(imported, "q_2", 1), 0.4);
  EXPECT_EQ(cell(imported, "tau_2", 1), 4.0);
}

TEST(JointColumns, OfTwoStreamsThatHaveOneJointAreAskedAbout) {
  const TemporaryFolder folder;
  spill(folder / "left.csv", "t,q1\n0,0.1\n0.01,0.3\n0.02,0.5\n");
  spill(folder / "right.csv", "t,q1\n0,1\n0.01,3\n0.02,5\n");
  const std::string words = data_error([&] {
    import_log({folder / "left.csv", folder / "right.csv"});
  });
  EXPECT_NE(words.find("--use file1 or file2"), std::string::npos) << words;
}

TEST(JointColumns, ThatAreCountedOnFromASaidOneFollow) {
  const std::string text = "t,q1,q2,drive_a,drive_b,amp1,amp2\n0,1,2,9,9,3,4\n0.01,1,2,9,9,5,6\n";
  ImportWishes wishes;
  wishes.map = {{"tau:1", "amp1"}};
  const Imported imported = import_text(text, wishes);
  EXPECT_EQ(cell(imported, "tau_2", 1), 6.0);
  // What is said of one in the middle says nothing of the others.
  wishes.map = {{"tau:2", "amp2"}};
  EXPECT_FALSE(has_column(import_text(text, wishes), "tau_1"));
}

// A drive's recorder: its other analog channels are no joints. The axis slides, and has no
// position.
TEST(JointColumns, OtherChannelsOfARecorderAreNoJoints) {
  const std::string text = "t,load [V],Analog 1,Analog 2\n0,0.1,2,3\n0.01,0.3,4,5\n";
  ImportWishes wishes;
  wishes.map = {{"tau:1", "load [V]"}, {"qd:1", "Analog 1"}};
  const TemporaryFolder folder;
  spill(folder / "log.csv", text);
  const Proposal asking = propose(read_log({folder / "log.csv"}, {}), wishes);
  ASSERT_EQ(asking.guesses.size(), 1U);
  EXPECT_NE(asking.guesses[0].find("--gain tau:1=NUMBER"), std::string::npos) << asking.guesses[0];
  wishes.gains = {{"tau:1", 200.0}};
  wishes.units = {{"tau:1", "N"}};
  const Imported imported = import_text(text, wishes);
  EXPECT_FALSE(has_column(imported, "qd_2"));
  EXPECT_DOUBLE_EQ(cell(imported, "tau_1", 1), 60.0);
  const Proposal told = propose(read_log({folder / "log.csv"}, {}), wishes);
  const Json axes = axes_of(imported.table, told.recipe);
  ASSERT_EQ(axes["axes"].size(), 1U) << axes.dump(1);
  EXPECT_EQ(axes["axes"][0]["unit"], "N");
  EXPECT_EQ(axes["axes"][0]["velocity"], "qd_1");
  EXPECT_FALSE(axes["axes"][0].contains("position"));
}

// Joints are counted from one here and from zero there: what is known by its name alone would make
// a joint of one channel.
TEST(JointColumns, BesideJointsThatAreSaidOneChannelIsNoJoint) {
  std::string text = "t,q[0],q[1],tau_measured[0],tau_measured[1],tau_feedback[0]\n";
  for (int k = 0; k < 20; ++k) {
    text += std::to_string(0.01 * k) + ",0.5,0.25,1.5,1.6,3\n";
  }
  ImportWishes wishes;
  wishes.map = {{"q:1", "q[0]"}, {"tau:1", "tau_measured[0]"}};
  const Imported imported = import_text(text, wishes);
  EXPECT_EQ(cell(imported, "tau_2", 3), 1.6);
  EXPECT_FALSE(has_column(imported, "tau_0"));
}

// What the position is counted in tells that an axis slides; what drives it has its own unit.
TEST(JointColumns, UnitsSayWhatAnAxisIs) {
  std::string text = "t,q1,tau1\n";
  for (int k = 0; k < 20; ++k) text += std::to_string(0.01 * k) + ",0.5,1.5\n";
  const TemporaryFolder folder;
  spill(folder / "log.csv", text);
  const auto axis = [&](const std::map<std::string, std::string>& units) {
    ImportWishes wishes;
    for (const auto& [column, unit] : units) wishes.units[column] = unit;
    const Imported imported = import_text(text, wishes);
    return Json(axes_of(imported.table,
                        propose(read_log({folder / "log.csv"}, {}), wishes).recipe)["axes"][0]);
  };
  EXPECT_EQ(axis({})["unit"], "N*m");
  EXPECT_EQ(axis({{"q:1", "mm"}})["unit"], "N");
  const Json motor = axis({{"q:1", "rev"}, {"tau:1", "V"}});
  EXPECT_EQ(motor["unit"], "V");
  EXPECT_EQ(motor["position_unit"], "rad");
}

TEST(JointColumns, OfALogOfOneJointNeedNoNumber) {
  std::string text = "t,q,dq,measured torque,desired_torque,current\n";
  for (int k = 0; k < 20; ++k) {
    const std::string t = std::to_string(0.01 * k);
    text += t + ",0.5,0.25,1.5,1.6,3\n";
  }
  const auto recording = import_text(text);
  EXPECT_EQ(cell(recording, "q_1", 3), 0.5);
  EXPECT_EQ(cell(recording, "qd_1", 3), 0.25);
  EXPECT_EQ(cell(recording, "tau_1", 3), 1.5);
}

TEST(JointColumns, OfArraysAreCalledInThePlural) {
  const Imported imported = import_text(
      "time,positions[0],positions[1],positions[2],positions[3],torques[0],torques[1],torques[2],"
      "torques[3],target_positions[0]\n0,1,2,3,4,5,6,7,8,9\n0.01,1,2,3,4,5,6,7,8,9\n");
  EXPECT_EQ(cell(imported, "q_3", 1), 4.0);
  EXPECT_EQ(cell(imported, "tau_0", 1), 5.0);
}

// Two positions may be a motor's and its load's; a position beside a pose is the tool's.
TEST(JointColumns, WhereMoreThanOneMayBeMeantAreAskedFor) {
  EXPECT_EQ(lone_quantity({"measured", "torque"}), "tau:");
  EXPECT_EQ(lone_quantity({"current"}), "current:");
  EXPECT_EQ(lone_quantity({"motor", "position"}), "q:");
  EXPECT_EQ(lone_quantity({"iq"}), "current:");
  EXPECT_EQ(lone_quantity({"dq", "act"}), "qd:");
  EXPECT_EQ(lone_quantity({"current", "position"}), "q:");
  EXPECT_EQ(lone_quantity({"desired", "torque"}), "");
  EXPECT_EQ(lone_quantity({"q", "torque"}), "");
}

TEST(JointColumns, WithoutTorquesSayHowToNameThem) {
  const TemporaryFolder folder;
  spill(folder / "log.csv", "t,q1,amp1\n0,1,2\n0.01,1,3\n");
  const Proposal proposal = propose(read_log({folder / "log.csv"}, {}), {});
  ASSERT_EQ(proposal.notes.size(), 1U);
  EXPECT_NE(proposal.notes[0].find("--map tau:1=CHANNEL"), std::string::npos) << proposal.notes[0];
}

// A command with columns that were wanted in the place of those that were measured misleads.
TEST(JointColumns, ThatWereWantedAreNotProposed) {
  const TemporaryFolder folder;
  spill(folder / "log.csv", "t,a_des,a_seen,b_seen,b_cmd\n0,1,2,3,4\n0.01,2,3,4,5\n");
  const std::string words = how_to_name(read_log({folder / "log.csv"}, {}));
  EXPECT_NE(words.find("--map q:1=a_seen --map tau:1=b_seen"), std::string::npos) << words;
}

TEST(JointColumns, ArraysOfTwoFilesAreNotStrungTogether) {
  ForeignLog log;
  const ReadLogOptions options;
  LogBuilder builder(log, options);
  const std::vector<NumberArray> arrays = {
      {.channels = {"q"}, .columns = {{1.0, 2.0, 3.0}}, .rows = 3}};
  builder.begin_file("a", 1);
  add_number_arrays(arrays, "", builder);
  builder.begin_file("b", 2);
  add_number_arrays(arrays, "", builder);
  ASSERT_EQ(log.streams.size(), 2U);
  EXPECT_EQ(log.streams[0].name, "arrays1");
  EXPECT_EQ(log.streams[1].name, "file2/arrays1");
  EXPECT_EQ(log.streams[1].rows, 3);
}

TEST(JoinedTexts, WithoutHeadersShareTheGivenNames) {
  const TemporaryFolder folder;
  spill(folder / "poses.txt", "0.1,0.2,0.3,0,0,0,1\n0.1,0.2,0.4,0,0,0,1\n0.1,0.2,0.5,0,0,0,1\n");
  spill(folder / "forces.txt", "1,2,3\n4,5,6\n7,8,9\n");
  ReadLogOptions read;
  read.text.columns = {"x", "y", "z", "qx", "qy", "qz", "qw", "fx", "fy", "fz"};
  ImportWishes wishes;
  wishes.rate_hz = 100.0;
  const Imported imported = import_log({folder / "poses.txt", folder / "forces.txt"}, wishes, read);
  EXPECT_EQ(cell(imported, "z", 1), 0.4);
  EXPECT_EQ(cell(imported, "fz", 1), 6.0);
  read.text.columns.emplace_back("more");
  const std::string words = data_error([&] {
    import_log({folder / "poses.txt", folder / "forces.txt"}, wishes, read);
  });
  EXPECT_NE(words.find("11 names are given for the 10 columns"), std::string::npos) << words;
}

TEST(JoinedTexts, OfPosesWithoutAClockAreJoinedRowByRow) {
  const TemporaryFolder folder;
  spill(folder / "poses.txt", "qw,qx,qy,qz\n1,0,0,0\n0,1,0,0\n0,0,1,0\n");
  spill(folder / "forces.txt", "fx,fy,fz\n1,2,3\n4,5,6\n7,8,9\n");
  const Imported imported = import_log({folder / "poses.txt", folder / "forces.txt"});
  EXPECT_EQ(cell(imported, "qx", 1), 1.0);
  EXPECT_EQ(cell(imported, "fz", 1), 6.0);
  spill(folder / "forces.txt", "fx,fy,fz\n1,2,3\n4,5,6\n");
  const std::string words = data_error([&] {
    import_log({folder / "poses.txt", folder / "forces.txt"});
  });
  EXPECT_NE(words.find("3 rows"), std::string::npos) << words;
}

// One file per quantity and one with the times alone.
TEST(JoinedTexts, OfOneLengthShareTheClockOfOne) {
  const TemporaryFolder folder;
  spill(folder / "poses.txt", "qw,qx,qy,qz\n1,0,0,0\n0,1,0,0\n0,0,1,0\n");
  spill(folder / "forces.txt", "fx,fy,fz\n1,2,3\n4,5,6\n7,8,9\n");
  spill(folder / "times.txt", "t\n0\n0.01\n0.025\n");
  const Imported alone =
      import_log({folder / "poses.txt", folder / "forces.txt", folder / "times.txt"});
  EXPECT_EQ(cell(alone, "t", 2), 0.025);
  EXPECT_EQ(cell(alone, "qx", 1), 1.0);
  spill(folder / "forces.txt", "t,fx,fy,fz\n0,1,2,3\n0.01,4,5,6\n0.025,7,8,9\n");
  const Imported one = import_log({folder / "poses.txt", folder / "forces.txt"});
  EXPECT_EQ(cell(one, "t", 2), 0.025);
  EXPECT_EQ(cell(one, "qy", 2), 1.0);
  spill(folder / "poses.txt", "qw,qx,qy,qz\n1,0,0,0\n0,1,0,0\n");
  const std::string words = data_error([&] {
    import_log({folder / "poses.txt", folder / "forces.txt"});
  });
  EXPECT_NE(words.find("one has no clock"), std::string::npos) << words;
}

TEST(Clocks, AreCalledSoWithinTheStructureThatHoldsThem) {
  EXPECT_EQ(clock_rank("run.all.timeStamp"), 2);
  EXPECT_EQ(clock_rank("run.all.force"), 0);
  EXPECT_EQ(clock_rank("pose.header.stamp"), 3);
}

TEST(Clocks, OfALetterAndAWordIncrease) {
  ImportWishes wishes;
  wishes.also = {"F"};
  EXPECT_EQ(cell(import_text("t_ADC,F\n5,1\n5.1,2\n5.2,3\n", wishes), "t", 2), 5.2);
  EXPECT_FALSE(has_column(import_text("t_ambient,F\n20,1\n21,2\n20,3\n", wishes), "t"));
}

TEST(Units, OfMachinesInAnyCase) {
  ASSERT_TRUE(find_unit("RPM").has_value());
  EXPECT_EQ(find_unit("RPM")->quantity, std::string("rate"));
  ASSERT_TRUE(find_unit("bar").has_value());
  EXPECT_EQ(find_unit("bar")->factor, 1e5);
}

}  // namespace
}  // namespace dcnn
