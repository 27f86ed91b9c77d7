// SPDX-License-Identifier: Apache-2.0
// What the user says, and what is said to him: --map and what follows, keys of options, streams.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "import/logs.h"
#include "import/roles.h"
#include "import/text_cells.h"

namespace dcnn {
namespace {

using test::cell;
using test::data_error;
using test::has_column;
using test::import_text;

/// The message of the Error(kUsage) that `action` throws.
template <class Action>
std::string usage_error(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

TEST(SaidColumns, AreFollowedByTheNextLetterOrNumber) {
  ImportWishes wishes;
  wishes.map = {{"fx", "fx_raw"}};
  EXPECT_EQ(cell(import_text("t,fx_raw,fy_raw,fz_raw\n0,1,2,3\n0.1,1,2,3\n", wishes), "fz", 1),
            3.0);
  const std::string rows = "\n0,1,0,0,0,5,6,7\n0.1,1,0,0,0,5,6,7\n";
  wishes.map = {{"qw", "Q1"}};
  EXPECT_EQ(cell(import_text("t,Q1,Q2,Q3,Q4,fx,fy,fz" + rows, wishes), "qz", 1), 0.0);
  wishes.map = {{"r11", "M_0"}};
  const Imported matrix = import_text(
      "t,M_0,M_1,M_2,M_3,M_4,M_5,M_6,M_7,M_8\n0,1,0,0,0,1,0,0,0,1\n0.1,0,-1,0,1,0,0,0,0,1\n",
      wishes);
  EXPECT_NEAR(std::abs(cell(matrix, "qz", 1)), std::sqrt(0.5), 1e-12);
  wishes.map = {{"rot1", "rx"}};
  wishes.euler_order = "xyz";
  const Imported angles = import_text("t,rx,ry,rz\n0,0,0,0\n0.1,0,0,1\n", wishes);
  EXPECT_NEAR(cell(angles, "qz", 1), std::sin(0.5), 1e-12);
}

TEST(SaidColumns, OfWhichAPartIsMissingAreTold) {
  const test::TemporaryFolder folder;
  test::spill(folder / "log.csv", "t,push,qw,qx,qy,qz\n0,1,1,0,0,0\n0.1,2,1,0,0,0\n");
  ImportWishes wishes;
  wishes.map = {{"fx", "push"}};
  const Proposal proposal = propose(read_log({folder / "log.csv"}, {}), wishes);
  ASSERT_FALSE(proposal.notes.empty());
  EXPECT_NE(proposal.notes[0].find("--map fy=CHANNEL --map fz=CHANNEL"), std::string::npos);
}

TEST(SaidColumns, ThatDoNotExistAreRefused) {
  const std::string text = "t,enc,qw,qx,qy,qz,fx,fy,fz\n0,1,1,0,0,0,1,2,3\n0.1,2,1,0,0,0,1,2,3\n";
  ImportWishes wishes;
  wishes.wraps = {{"bogus", 65536.0}};
  EXPECT_NE(usage_error([&] { import_text(text, wishes); }).find("--wrap bogus"),
            std::string::npos);
  wishes = {};
  wishes.units = {{"nothere", "mN"}};
  EXPECT_NE(usage_error([&] { import_text(text, wishes); }).find("--unit nothere"),
            std::string::npos);
  wishes = {};
  wishes.units = {{"fx", "Nm"}};
  EXPECT_NE(usage_error([&] { import_text(text, wishes); }).find("kgf"), std::string::npos);
  wishes = {};
  wishes.use = {"/nowhere"};
  EXPECT_NE(usage_error([&] { import_text(text, wishes); }).find("--use"), std::string::npos);
  wishes = {};
  wishes.clock = {"nothing"};
  EXPECT_NE(usage_error([&] { import_text(text, wishes); }).find("--clock"), std::string::npos);
}

TEST(SaidColumns, MayBeCalledByTheirChannel) {
  ImportWishes wishes;
  wishes.map = {{"z", "enc"}};
  wishes.wraps = {{"enc", 65536.0}};
  wishes.gains = {{"z", 1e-6}};
  wishes.units = {{"t", "ms"}};
  const Imported imported = import_text("t,x,y,enc\n0,0,0,65000\n2,0,0,65535\n4,0,0,64\n", wishes);
  EXPECT_NEAR(cell(imported, "z", 2), 0.0656, 1e-12);
  EXPECT_NEAR(cell(imported, "t", 2), 0.004, 1e-12);
}

TEST(Streams, ThatAreNamedRestrictNothingElse) {
  const test::TemporaryFolder folder;
  test::spill(folder / "a.csv", "t,fx,fy,fz\n0,1,2,3\n0.1,1,2,3\n0.2,1,2,3\n");
  test::spill(folder / "b.csv", "t,qw,qx,qy,qz\n0,1,0,0,0\n0.1,1,0,0,0\n0.2,1,0,0,0\n");
  test::spill(folder / "c.csv", "t,qw,qx,qy,qz\n0,0,1,0,0\n0.1,0,1,0,0\n0.2,0,1,0,0\n");
  ImportWishes wishes;
  wishes.use = {"file3"};
  const Imported imported =
      test::import_log({folder / "a.csv", folder / "b.csv", folder / "c.csv"}, wishes);
  EXPECT_EQ(cell(imported, "fx", 1), 1.0);
  EXPECT_EQ(cell(imported, "qx", 1), 1.0);
}

TEST(Streams, WithoutAForceAreTold) {
  const test::TemporaryFolder folder;
  test::spill(folder / "log.csv", "t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.1,0,0,0,1,0,0,0\n");
  const Proposal proposal = propose(read_log({folder / "log.csv"}, {}), {});
  ASSERT_EQ(proposal.notes.size(), 1U);
  EXPECT_NE(proposal.notes[0].find("--map fx=CHANNEL"), std::string::npos) << proposal.notes[0];
}

// As PlotJuggler exports topics of two rates: a row has the cells of one of them.
TEST(Streams, OfOneFileWithRowsOfTheirOwnAreJoined) {
  std::ostringstream text;
  text << "__time,/ft/force/x,/ft/force/y,/ft/force/z,/pose/orientation/w,/pose/orientation/x,"
          "/pose/orientation/y,/pose/orientation/z\n";
  for (int k = 0; k < 40; ++k) {
    text << 0.01 * k << "," << k << ",2,3,,,,\n" << 0.01 * k + 0.0005 << ",,,,1,0,0,0\n";
  }
  const Imported imported = import_text(text.str());
  EXPECT_EQ(imported.table.values.rows(), 39);
  EXPECT_EQ(cell(imported, "fx", 0), 1.0);
  EXPECT_EQ(cell(imported, "qw", 5), 1.0);
}

TEST(Quaternions, OfUnitLengthBesideAWrenchAreNoJoints) {
  const std::string text = "t,q0,q1,q2,q3,fx,fy,fz\n0,0.8,0.6,0,0,1,2,3\n0.1,0.6,0.8,0,0,1,2,3\n";
  EXPECT_NE(data_error([&] { import_text(text); }).find("--quaternion-order"), std::string::npos);
  ImportWishes wishes;
  wishes.quaternion_order = "wxyz";
  EXPECT_NEAR(cell(import_text(text, wishes), "qx", 1), 0.8, 1e-12);
}

TEST(Orientations, ThatMayBeTwoThingsAreAsked) {
  const std::string words = data_error([] {
    import_text("t,x,y,z,rx,ry,rz,fx,fy,fz\n0,0,0,0,0,0,0,1,2,3\n0.1,0,0,0,0,0,1,1,2,3\n");
  });
  EXPECT_NE(words.find("--euler-order xyz"), std::string::npos) << words;
  EXPECT_NE(words.find("--map rvx=rx"), std::string::npos) << words;
}

TEST(Orientations, OfOtherMakersAreKnown) {
  const Imported kuka = import_text(
      "ZEIT,X_IST,Y_IST,Z_IST,A_IST,B_IST,C_IST,Fx,Fy,Fz\n"
      "0,1,2,3,0.5,0.25,0.125,1,2,3\n0.01,1,2,3,0.5,0.25,0.125,1,2,3\n");
  EXPECT_EQ(cell(kuka, "alpha", 1), 0.5);
  EXPECT_EQ(cell(kuka, "z", 1), 3.0);
  const Imported rows = import_text(
      "t,T00,T01,T02,T03,T10,T11,T12,T13,T20,T21,T22,T23,T30,T31,T32,T33,fx,fy,fz\n"
      "0,1,0,0,7,0,1,0,8,0,0,1,9,0,0,0,1,1,2,3\n0.01,0,-1,0,7,1,0,0,8,0,0,1,9,0,0,0,1,1,2,3\n");
  EXPECT_EQ(cell(rows, "y", 1), 8.0);
  EXPECT_NEAR(std::abs(cell(rows, "qz", 1)), std::sqrt(0.5), 1e-12);
  const Imported rot = import_text(
      "t,posX,posY,posZ,rotX,rotY,rotZ,rotW,fx,fy,fz\n0,1,2,3,0,0,0.6,0.8,1,2,3\n"
      "0.01,1,2,3,0,0,0.6,0.8,1,2,3\n");
  EXPECT_EQ(cell(rot, "qz", 1), 0.6);
}

TEST(Clocks, OfTheDayAndOfDatesAreRead) {
  EXPECT_EQ(*clock_seconds("10:00:00.5"), 36000.5);
  EXPECT_EQ(*clock_seconds("02.01.1970 00:00:01"), 86401.0);
  EXPECT_EQ(*clock_seconds("01/02/1970 00:00:00"), 31.0 * 86400.0);
  EXPECT_FALSE(clock_seconds("10:00").has_value());
  EXPECT_FALSE(clock_seconds("40.01.1970 00:00:00").has_value());
  const Imported imported =
      import_text("Time;fx;fy;fz\n10:00:00.000;1;2;3\n10:00:00.002;1;2;3\n10:00:00.004;1;2;3\n");
  EXPECT_NEAR(cell(imported, "t", 2), 36000.004, 1e-9);
}

TEST(Clocks, OfAMotionAreAskedFor) {
  std::ostringstream text;
  text << "index,x,y,z,qw,qx,qy,qz,fx,fy,fz\n";
  for (int k = 0; k < 100; ++k) {
    text << k << "," << std::sin(0.05 * k) << ",0,0,1,0,0,0," << k % 7 << ",2,3\n";
  }
  const std::string words = data_error([&] { import_text(text.str()); });
  EXPECT_NE(words.find("--rate"), std::string::npos) << words;
  ImportWishes wishes;
  wishes.clock = {"note"};
  const std::string texts = "note,fx,fy,fz\nhello,1,2,3\nyou,1,2,3\nall,1,2,4\n";
  EXPECT_NE(data_error([&] { import_text(texts, wishes); }).find("holds text"), std::string::npos);
}

TEST(Clocks, OfMatlabAreFoundInTheirStructures) {
  EXPECT_EQ(clock_rank("out.simout.Time"), 2);
  EXPECT_EQ(clock_rank("out.tout"), 2);
  EXPECT_EQ(clock_rank("timestamps"), 2);
  EXPECT_EQ(clock_rank("out.simout.Data"), 0);
}

TEST(Names, ThatAreUnknownAreAnsweredByACommand) {
  const std::string words =
      data_error([] { import_text("Time,K1,K2,T1,T2\n0,1,2,3,4\n0.1,1,2,3,5\n0.2,2,2,3,5\n"); });
  EXPECT_NE(words.find("--map q:1=K1 --map tau:1=T1 --clock Time --out"), std::string::npos)
      << words;
}

TEST(Units, ThatAreAskedForAreListed) {
  const std::string words =
      data_error([] { import_text("t,Fx (pound),Fy (pound),Fz (pound)\n0,1,2,3\n0.1,1,2,3\n"); });
  EXPECT_NE(words.find("lbf"), std::string::npos) << words;
}

}  // namespace
}  // namespace dcnn
