// SPDX-License-Identifier: Apache-2.0
// Texts of every dialect of the table in docs/use/import.md become the same recording.
#include <gtest/gtest.h>

#include <numbers>

#include "import/logs.h"
#include "import/text_cells.h"
#include "import/units.h"

namespace dcnn {
namespace {

using test::cell;
using test::data_error;
using test::import_text;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Dialect {
  const char* name;
  const char* text;
};

class EveryDialect : public ::testing::TestWithParam<Dialect> {};

TEST_P(EveryDialect, GivesTheSameRecording) {
  test::expect_three_rows(import_text(GetParam().text));
}

INSTANTIATE_TEST_SUITE_P(
    Text, EveryDialect,
    ::testing::Values(
        Dialect{"plain", "t,fx,fy,fz\n0,1.5,-0.25,1e3\n0.01,2.5,-0.25,1e3\n0.02,3.5,-.25,+1000\n"},
        Dialect{"bom_crlf",
                "\xEF\xBB\xBFt,fx,fy,fz\r\n0,1.5,-0.25,1e3\r\n0.01,2.5,-0.25,1e3\r\n"
                "0.02,3.5,-0.25,1000\r\n"},
        Dialect{"semicolons_and_commas",
                "Time [s];Fx [N];Fy [N];Fz [N]\n0,00;1,5;-0,25;1000\n0,01;2,5;-0,25;1000\n"
                "0,02;3,5;-0,25;1000\n"},
        Dialect{"tabs_and_commas",
                "Time\tForceX\tForceY\tForceZ\n0,00\t1,5\t-0,25\t1000\n0,01\t2,5\t-0,25\t1000\n"
                "0,02\t3,5\t-0,25\t1000\n"},
        Dialect{"spaces",
                "  t   fx  fy   fz\n 0.00  1.5 -0.25 1000 \n 0.01  2.5  -0.25 1000\n"
                " 0.02  3.5 -0.25 1000\n"},
        Dialect{"percent_header",
                "% made by a robot\n% t fx fy fz\n0 1.5 -0.25 1000\n"
                "0.01 2.5 -0.25 1000\n0.02 3.5 -0.25 1000\n"},
        Dialect{"hash_between",
                "# robot 7\nt,fx,fy,fz\n# start\n0,1.5,-0.25,1000\n"
                "0.01,2.5,-0.25,1000\n# a remark\n0.02,3.5,-0.25,1000\n\n"},
        Dialect{"quotes",
                "\"t\",\"fx\",\"fy\",\"fz\"\n\"0\",\"1.5\",\"-0.25\",\"1000\"\n"
                "\"0.01\",\"2.5\",\"-0.25\",\"1000\"\n\"0.02\",\"3.5\",\"-0.25\",\"1000\"\n"},
        Dialect{"trailing_commas",
                "t,fx,fy,fz,\n0,1.5,-0.25,1000,\n0.01,2.5,-0.25,1000,\n"
                "0.02,3.5,-0.25,1000,\n"},
        Dialect{"trailing_commas_of_rows_alone",
                "t,fx,fy,fz\n0,1.5,-0.25,1000,\n0.01,2.5,-0.25,1000,\n0.02,3.5,-0.25,1000,\n"},
        Dialect{"line_of_units",
                "Zeit;t;Fx;Fy;Fz\n;ms;mN;mN;kN\na;0;1500;-250;1\nb;10;2500;-250;1\n"
                "c;20;3500;-250;1\n"},
        Dialect{"units_in_names",
                "time_ms,fx (mN),fy/mN,fz [kN]\n0,1500,-250,1\n10,2500,-250,1\n"
                "20,3500,-250,1\n"},
        Dialect{"settings_above",
                "Oscilloscope 7\nNumber of rows,3\nt,fx,fy,fz\ns,N,N,N\n0,1.5,-0.25,1000\n"
                "0.01,2.5,-0.25,1000\n0.02,3.5,-0.25,1000\n"},
        Dialect{"settings_in_every_column",
                "Interval,0.01,Interval,0.01\nt,fx,fy,fz\n0,1.5,-0.25,1000\n"
                "0.01,2.5,-0.25,1000\n0.02,3.5,-0.25,1000\n"},
        Dialect{"settings_of_other_widths",
                "Channel name,Force\nGain,2.5,3.1,4,1\nName,A,B,C\nSamples,3,3\n\nt,fx,fy,fz\n"
                "s,N,N,N\n0,1.5,-0.25,1000\n0.01,2.5,-0.25,1000\n0.02,3.5,-0.25,1000\n"},
        Dialect{"rostopic",
                "%time,field.header.seq,field.header.stamp,field.wrench.force.x,"
                "field.wrench.force.y,field.wrench.force.z\n"
                "1600000000500000000,1,1600000000000000000,1.5,-0.25,1000\n"
                "1600000000510000000,2,1600000000010000000,2.5,-0.25,1000\n"
                "1600000000520000000,3,1600000000020000000,3.5,-0.25,1000\n"},
        Dialect{
            "secs_and_nsecs",
            "header.stamp.secs,header.stamp.nsecs,wrench.force.x,wrench.force.y,wrench.force.z\n"
            "1600000000,990000000,1.5,-0.25,1000\n1600000001,0,2.5,-0.25,1000\n"
            "1600000001,10000000,3.5,-0.25,1000\n"},
        Dialect{"epoch_ms",
                "timestamp,/ft/force/x,/ft/force/y,/ft/force/z\n"
                "1600000000000,1.5,-0.25,1000\n1600000000010,2.5,-0.25,1000\n"
                "1600000000020,3.5,-0.25,1000\n"},
        Dialect{"iso_dates",
                "time;fx;fy;fz\n2024-02-29T23:59:59.990Z;1.5;-0.25;1000\n"
                "2024-03-01T00:00:00.000Z;2.5;-0.25;1000\n"
                "2024-03-01 00:00:00.010;3.5;-0.25;1000\n"},
        Dialect{"nan_in_a_column_that_nobody_uses",
                "t,fx,fy,fz,spare\n0,1.5,-0.25,1000,nan\n0.01,2.5,-0.25,1000,\n"
                "0.02,3.5,-0.25,1000,#N/A\n"},
        Dialect{"lists_over_several_lines",
                "stamp,force\n0,\"[ 1.5\n -0.25 1.e+03]\"\n0.01,\"[ 2.5 -0.25 1000.]\"\n"
                "0.02,\"[ 3.5 -0.25\n 1000.]\"\n"},
        Dialect{"lists_with_commas",
                ",time,force\n0,0,[1.5, -0.25, 1000]\n1,0.01,[2.5, -0.25, 1000]\n"
                "2,0.02,[3.5, -0.25, 1000]\n"},
        Dialect{"cut_off",
                "t,fx,fy,fz\n0,1.5,-0.25,1000\n0.01,2.5,-0.25,1000\n"
                "0.02,3.5,-0.25,1000\n0.03,4."}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(TextImport, WithoutAHeaderColumnsAreNamedByTheUser) {
  ReadLogOptions read;
  read.text.columns = {"t", "fx", "fy", "fz"};
  const Imported imported = import_text("0 1 2 3\n0.01 4 5 6\n", {}, read);
  EXPECT_EQ(cell(imported, "fz", 1), 6.0);
  const std::string words = data_error([] { import_text("0 1 2 3\n0.01 4 5 6\n"); });
  EXPECT_NE(words.find("--map"), std::string::npos) << words;
}

TEST(TextImport, CommasThatMayBeDecimalsAreAsked) {
  const std::string words = data_error([] { import_text("fx\n20,66\n20,67\n20,68\n"); });
  EXPECT_NE(words.find("--decimal"), std::string::npos) << words;
}

TEST(TextImport, FaultsNameTheirPlace) {
  EXPECT_NE(data_error([] {
              import_text("t,fx,fy,fz\n0,1,2,3\n1,1,2,3\n2,abc,2,3\n3,1,1,1\n4,1,1,1\n");
            }).find("log.txt:4: column 'fx' is not a number: 'abc'"),
            std::string::npos);
  EXPECT_NE(data_error([] {
              import_text("t,fx,fy,fz\n0,1,2,3\n1,1,2\n2,1,2,3\n3,1,2,3\n");
            }).find("log.txt:3: 3 cells"),
            std::string::npos);
  EXPECT_NE(data_error([] { import_text(std::string("\0\1\2\3", 4)); }).find("NUL"),
            std::string::npos);
  EXPECT_NE(data_error([] {
              import_text("t,fx,fy,fz\n0,1,2,3\n0.02,1,2,3\n0.01,1,2,3\n");
            }).find("goes from 0.02 to 0.01"),
            std::string::npos);
  data_error([] { import_text(""); });
  data_error([] { import_text("\n\n\n"); });
  data_error([] { import_text("only words\nand more\n"); });
}

TEST(TextImport, FaultsOfListsNameTheLineOnWhichTheRowBegins) {
  const std::string rows = "t,force\n0,\"[1 2\n 3]\"\n0.01,\"[1 2 3]\"\n";
  EXPECT_NE(data_error([&] {
              import_text(rows + "0.02,\"[1\n 2]\"\n0.03,\"[1 2 3]\"\n");
            }).find("log.txt:5: 3 cells where there are 4"),
            std::string::npos);
  EXPECT_NE(data_error([&] {
              import_text(rows + "0.02,\"[1 2\n");
            }).find("log.txt:5: a list that begins here has no end"),
            std::string::npos);
  EXPECT_NE(data_error([&] {
              import_text(rows + "0.02,\"[1 2\n4]\"\n0.03,\"[1 x 3]\"\n0.04,\"[1 2 3]\"\n");
            }).find("log.txt:7"),
            std::string::npos);
}

// Each line that is added is looked at once, and no list is longer than 16 KiB: no file takes long.
TEST(TextImport, ListsWithoutAnEndAreRefusedAtOnce) {
  std::string open = "t,force\n0,\"[1 2 3]\"\n0.01,\"[";
  for (int k = 0; k < 100000; ++k) open += "1\n";
  data_error([&] { import_text(open); });
  std::string nested = "t,force\n0,\"[1 2 3]\"\n0.01,x";
  for (int k = 0; k < 50000; ++k) nested += ",[1";
  data_error([&] { import_text(nested + ",x\n0.02,\"[1 2 3]\"\n"); });
}

TEST(TextImport, ARobotsShortNamesArePoseAndWrench) {
  std::string text =
      "time,tcp_0,tcp_1,tcp_2,tcp_3,tcp_4,tcp_5,tcpf_0,tcpf_1,tcpf_2,tcpf_3,tcpf_4,"
      "tcpf_5\n";
  for (const char* row : {"0", "0.008", "0.016"}) {
    text += row + std::string(",0.1,0.2,0.3,0,0,1.5707963267948966,1,2,3,0.4,0.5,0.6\n");
  }
  ImportWishes wishes;
  wishes.wrench.frame = "auto";
  const Imported imported = import_text(text, wishes);
  EXPECT_EQ(cell(imported, "z", 1), 0.3);
  EXPECT_NEAR(cell(imported, "qz", 1), std::sqrt(0.5), 1e-12);
  // A UR's are in the base frame: turned into the sensor's.
  EXPECT_NEAR(cell(imported, "fx", 1), 2.0, 1e-12);
  EXPECT_NEAR(cell(imported, "fy", 1), -1.0, 1e-12);
  EXPECT_NEAR(cell(imported, "tz", 1), 0.6, 1e-12);
}

TEST(TextImport, WhatOnlySizeTellsIsAsked) {
  const std::string rows = "0,1,2,3,181\n2,1,2,3,182\n4,1,2,3,183\n";
  std::string words = data_error([&] { import_text("t,fx,fy,fz,yaw\n" + rows); });
  EXPECT_NE(words.find("--clock-unit ms"), std::string::npos) << words;
  const std::string angles = "t,fx,fy,fz,yaw,pitch,roll\n0,1,2,3,181,0,0\n0.1,1,2,3,182,0,90\n";
  words = data_error([&] { import_text(angles); });
  EXPECT_NE(words.find("deg by their size"), std::string::npos) << words;
  ImportWishes wishes;
  wishes.units = {{"alpha", "deg"}, {"beta", "deg"}, {"gamma", "deg"}};
  const Imported imported = import_text(angles, wishes);
  EXPECT_NEAR(cell(imported, "gamma", 1), 90.0 * kDegree, 1e-12);
  words = data_error([] { import_text("t,fx,fy,fz\n0,30000,4,5\n0.1,-29000,4,5\n"); });
  EXPECT_NE(words.find("counts"), std::string::npos) << words;
}

TEST(TextImport, RegistersThatWrapGainsAndOffsets) {
  ImportWishes wishes;
  wishes.map = {{"fx", "ch0"}};
  wishes.wraps = {{"fx", 65536.0}};
  wishes.offsets = {{"fx", 65000.0}};
  wishes.gains = {{"fx", -0.5}};
  wishes.units = {{"fx", "mN"}};
  const Imported imported =
      import_text("t,ch0\n0,65000\n0.01,65535\n0.02,64\n0.03,65530\n", wishes);
  EXPECT_DOUBLE_EQ(cell(imported, "fx", 1), -535.0 * 0.5e-3);
  EXPECT_DOUBLE_EQ(cell(imported, "fx", 2), -600.0 * 0.5e-3);
  EXPECT_DOUBLE_EQ(cell(imported, "fx", 3), -530.0 * 0.5e-3);
}

TEST(TextImport, TwoColumnsOfOneNameAreAsked) {
  const std::string words =
      data_error([] { import_text("t,Fx,Fx,fy,fz\n0,1,2,3,4\n0.1,1,2,3,4\n"); });
  EXPECT_NE(words.find("--map fx"), std::string::npos) << words;
}

TEST(TextImport, RowsWithoutANumberAreLeftOutAndSaid) {
  const Imported imported = import_text("t,fx,fy,fz\n0,1,2,3\n0.1,,2,3\n0.2,nan,2,3\n0.3,1,2,3\n");
  EXPECT_EQ(imported.table.values.rows(), 2);
  EXPECT_NE(imported.notes.at(0).find("2 of 4 rows"), std::string::npos);
}

TEST(TextImport, PosesWithoutAClockStayAList) {
  const Imported imported = import_text("fx fy fz qx qy qz qw\n1 2 3 0 0 0 1\n4 5 6 0.6 0 0 0.8\n");
  EXPECT_FALSE(test::has_column(imported, "t"));
  EXPECT_EQ(cell(imported, "qw", 1), 0.8);
}

TEST(TextImport, ATrajectoryOfTumIsAPose) {
  const Imported imported = import_text(
      "# timestamp tx ty tz qx qy qz qw\n1600000000.5 1 2 3 0 0 0 1\n"
      "1600000000.6 1 2 3 0 0 0 1\n");
  EXPECT_EQ(cell(imported, "z", 0), 3.0);
  EXPECT_FALSE(test::has_column(imported, "tz"));
}

TEST(TextImport, CellsAreReadExactly) {
  double value = 0.0;
  EXPECT_EQ(read_cell(" \"1,25\" ", ',', &value), CellKind::kNumber);
  EXPECT_EQ(value, 1.25);
  EXPECT_EQ(read_cell("1.234,5", ',', &value), CellKind::kText);  // thousands are not guessed
  EXPECT_EQ(read_cell("1,2,3", ',', &value), CellKind::kText);
  EXPECT_EQ(read_cell("0x10", '.', &value), CellKind::kText);
  EXPECT_EQ(read_cell("-inf", '.', &value), CellKind::kMissing);
  EXPECT_EQ(*clock_seconds("1970-01-02T00:00:00.5+01:00"), 86400.5 - 3600.0);
  EXPECT_FALSE(clock_seconds("2024-13-01T00:00:00").has_value());
  EXPECT_EQ(unit_of_name("position[3]"), "");
  EXPECT_EQ(unit_of_name("tau [N\xC2\xB7m]"), "N\xC2\xB7m");
  EXPECT_EQ(find_unit("N.m")->quantity, "torque");
}

TEST(TextImport, WhatAControllerWantsIsNoMeasurement) {
  const Imported imported = import_text(
      "t,goal_pos_x,goal_pos_y,goal_pos_z,current_pos_x,current_pos_y,current_pos_z,fx,fy,fz\n"
      "0,9,9,9,1,2,3,4,5,6\n0.1,9,9,9,1,2,3,4,5,6\n0.2,9,9,9,1,2,3,4,5,6\n");
  EXPECT_EQ(cell(imported, "x", 1), 1.0);
  EXPECT_EQ(cell(imported, "z", 2), 3.0);
}

// One answer for all columns of one sensor and one body.
TEST(TextImport, ColumnsThatBeginLikeTheOneThatWasSaidFollowIt) {
  const std::string text =
      "t,LeftX(m),LeftY(m),LeftZ(m),RightX(m),RightY(m),RightZ(m),LeftFx,LeftFy,LeftFz,RightFx,"
      "RightFy,RightFz\n0,1,2,3,4,5,6,7,8,9,10,11,12\n0.1,1,2,3,4,5,6,7,8,9,10,11,12\n";
  const std::string words = data_error([&] { import_text(text); });
  EXPECT_NE(words.find("--map fx="), std::string::npos) << words;
  EXPECT_EQ(words.find("--map fy="), std::string::npos) << words;
  ImportWishes wishes;
  wishes.map = {{"fx", "RightFx"}};
  const Imported imported = import_text(text, wishes);
  EXPECT_EQ(cell(imported, "fx", 0), 10.0);
  EXPECT_EQ(cell(imported, "fz", 0), 12.0);
  EXPECT_EQ(cell(imported, "y", 0), 5.0);
}

// A name of its own elsewhere is not of the array that was said.
TEST(TextImport, ElementsOfTheArrayThatWasSaidFollowIt) {
  const std::string text =
      "t,force[0],force[1],force[2],FT[0],FT[1],FT[2],FT[3]\n0,1,2,3,4,5,6,7\n0.1,1,2,3,4,5,6,7\n";
  ImportWishes wishes;
  wishes.map = {{"fx", "FT[0]"}};
  const Imported imported = import_text(text, wishes);
  EXPECT_EQ(cell(imported, "fy", 0), 5.0);
  EXPECT_EQ(cell(imported, "fz", 0), 6.0);
  wishes.map = {{"fx", "FT[0]"}, {"fz", "FT[1]"}};
  EXPECT_EQ(cell(import_text(text, wishes), "fy", 0), 2.0);
}

TEST(TextImport, AUnitSaysWhatAnAxisIsOf) {
  const Imported imported = import_text(
      "t,HandleX(m),HandleY(m),HandleZ(m),Cell X (N),Cell Y (N),Cell Z (N)\n"
      "0,1,2,3,4,5,6\n0.1,1,2,3,4,5,6\n0.2,1,2,3,4,5,6\n");
  EXPECT_EQ(cell(imported, "y", 1), 2.0);
  EXPECT_EQ(cell(imported, "fz", 2), 6.0);
}

TEST(TextImport, AUnitThatIsNotKnownIsAsked) {
  const std::string rows = "\n0,1,2,3\n0.1,1,2,3\n0.2,1,2,3\n";
  const std::string words =
      data_error([&] { import_text("t,Fx (pound),Fy (pound),Fz (pound)" + rows); });
  EXPECT_NE(words.find("--unit fx="), std::string::npos) << words;
  ImportWishes wishes;
  wishes.units = {{"fx", "lbf"}, {"fy", "lbf"}, {"fz", "lbf"}};
  EXPECT_NEAR(cell(import_text("t,Fx (pound),Fy (pound),Fz (pound)" + rows, wishes), "fx", 0),
              4.4482, 1e-4);
  EXPECT_EQ(unknown_unit_of_name("position[elbow]"), "");
  EXPECT_EQ(unknown_unit_of_name("fx (N)"), "");
  EXPECT_EQ(find_unit("Radians")->quantity, "angle");
  EXPECT_EQ(find_unit("Newton")->factor, 1.0);
}

// KUKA's frames: A, B and C are no names elsewhere.
TEST(TextImport, AFrameOfKukaHasItsAngles) {
  const Imported imported = import_text(
      "t;X [mm];Y [mm];Z [mm];A [deg];B [deg];C [deg];fx;fy;fz\n"
      "0,00;100;0;0;90;45;-30;1;2;3\n0,01;100;0;0;90;45;-30;1;2;3\n0,02;100;0;0;90;45;-30;1;2;3\n");
  EXPECT_NEAR(cell(imported, "x", 1), 0.1, 1e-12);
  EXPECT_NEAR(cell(imported, "alpha", 1), 90.0 * kDegree, 1e-12);
  EXPECT_NEAR(cell(imported, "beta", 1), 45.0 * kDegree, 1e-12);
  EXPECT_NEAR(cell(imported, "gamma", 1), -30.0 * kDegree, 1e-12);
}

}  // namespace
}  // namespace dcnn
