// SPDX-License-Identifier: Apache-2.0
// Joints that --map names otherwise than the log does.
#include <gtest/gtest.h>

#include "dcnn/import/summary.h"
#include "import/logs.h"

namespace dcnn {
namespace {

using test::cell;
using test::has_column;
using test::import_text;

std::string rows_below(const std::string& names, const std::string& cells) {
  std::string text = names + "\n";
  for (int k = 0; k < 20; ++k) text += std::to_string(0.01 * k) + "," + cells + "\n";
  return text;
}

const std::string kTwoJoints =
    rows_below("time,pos1,pos2,vel1,vel2,torque1,torque2", "0.1,0.2,1,2,3,4");

TEST(SaidJoints, MayHaveANameWithADigit) {
  ImportWishes wishes;
  wishes.map = {{"q:a1", "pos"}, {"qd:a1", "vel"}, {"tau:a1", "torque"}};
  const Imported imported = import_text(rows_below("time,pos,vel,torque", "0.1,1,3"), wishes);
  EXPECT_EQ(cell(imported, "q_a1", 1), 0.1);
  EXPECT_EQ(cell(imported, "qd_a1", 1), 1.0);
  EXPECT_EQ(cell(imported, "tau_a1", 1), 3.0);
}

// What is said of the position alone names the joint: velocity and torque are the same joint's.
TEST(SaidJoints, KeepTheirNameInAllQuantities) {
  for (const auto& [to, channel] : std::map<std::string, std::string>{
           {"q:a1", "pos1"}, {"qd:a1", "vel1"}, {"tau:a1", "torque1"}}) {
    ImportWishes wishes;
    wishes.map = {{to, channel}};
    const Imported imported = import_text(kTwoJoints, wishes);
    EXPECT_EQ(cell(imported, "q_a2", 1), 0.2) << to;
    EXPECT_EQ(cell(imported, "qd_a1", 1), 1.0) << to;
    EXPECT_EQ(cell(imported, "tau_a2", 1), 4.0) << to;
    EXPECT_EQ(imported.table.columns.size(), 7U) << to;
  }
}

// Joints that the log counts from zero.
TEST(SaidJoints, AreCountedAsSaid) {
  ImportWishes wishes;
  wishes.map = {{"q:1", "q[0]"}};
  const Imported imported =
      import_text(rows_below("t,q[0],q[1],I[0],tau[0],tau[1]", "0.1,0.2,9,3,4"), wishes);
  EXPECT_EQ(cell(imported, "tau_1", 1), 3.0);
  EXPECT_EQ(cell(imported, "tau_2", 1), 4.0);
  EXPECT_FALSE(has_column(imported, "tau_0"));
}

TEST(SaidJoints, OfAnothersNameTakeNothingOfIt) {
  ImportWishes wishes;
  wishes.map = {{"q:1", "pos2"}};
  const Imported imported = import_text(kTwoJoints, wishes);
  EXPECT_EQ(cell(imported, "q_1", 1), 0.2);
  EXPECT_EQ(cell(imported, "qd_1", 1), 2.0);
  EXPECT_EQ(cell(imported, "tau_1", 1), 4.0);
  EXPECT_FALSE(has_column(imported, "qd_2"));
}

// A pneumatic actuator's test stand, without a header: the unit is said of the column.
TEST(SaidJoints, SlideWhereTheirPositionIsALength) {
  const std::string text = rows_below("-0.01,4.6,-0.004,267.5", "4.6,37.4,267.6");
  ReadLogOptions read;
  read.text.columns = {"t", "laser_v", "position", "force"};
  ImportWishes wishes;
  wishes.map = {{"q:1", "position"}, {"tau:1", "force"}};
  wishes.units = {{"position", "mm"}};
  const Imported imported = import_text(text, wishes, read);
  EXPECT_DOUBLE_EQ(cell(imported, "q_1", 3), 0.0374);
  const test::TemporaryFolder folder;
  test::spill(folder / "log.txt", text);
  const Recipe recipe = propose(read_log({folder / "log.txt"}, read), wishes).recipe;
  const Json axis = axes_of(imported.table, recipe)["axes"][0];
  EXPECT_EQ(axis["unit"], "N");
  EXPECT_EQ(axis["position"], "q_1");
}

}  // namespace
}  // namespace dcnn
