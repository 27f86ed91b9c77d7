// SPDX-License-Identifier: Apache-2.0
// Comments above a table: remarks with as many cells as the table, names, units.
#include <gtest/gtest.h>

#include <numbers>

#include "import/logs.h"

namespace dcnn {
namespace {

using test::expect_three_rows;
using test::import_text;

constexpr const char* kRows = "0,1.5,-0.25,1000\n0.01,2.5,-0.25,1000\n0.02,3.5,-0.25,1000\n";

struct CommentedText {
  const char* name;
  const char* above;
};

class CommentedTable : public ::testing::TestWithParam<CommentedText> {};

TEST_P(CommentedTable, IsReadByItsNames) {
  expect_three_rows(import_text(std::string(GetParam().above) + kRows));
}

INSTANTIATE_TEST_SUITE_P(
    Text, CommentedTable,
    ::testing::Values(
        CommentedText{"remarks_above_names", "# robot, tool, 3\n# date, 4, 5, 6\nt,fx,fy,fz\n"},
        CommentedText{"remark_of_as_many_cells", "# robot, tool, left, right\nt,fx,fy,fz\n"},
        CommentedText{"remark_with_a_bracket", "# see [1, 2\nt,fx,fy,fz\n"},
        CommentedText{"names_in_a_comment", "# t, fx, fy, fz\n"},
        CommentedText{"names_behind_slashes", "// t, fx, fy, fz\n"},
        CommentedText{"names_in_the_last_comment", "# robot, tool, left, right\n# t, fx, fy, fz\n"},
        CommentedText{"names_above_a_remark", "# t, fx, fy, fz\n# robot, tool, left, right\n"},
        CommentedText{"units_in_a_comment", "# t, fx, fy, fz\n# [s], [N], [N], [N]\n"},
        CommentedText{"units_in_brackets", "t,fx,fy,fz\n[s],[N],[N],[N]\n"}),
    [](const auto& text) { return text.param.name; });

TEST(CommentLines, MayBeMoreThanASampleOfTheFile) {
  std::string text;
  for (int k = 0; k < 1000; ++k) text += "# setting, of, the, recorder\n";
  expect_three_rows(import_text(text + "t,fx,fy,fz\n" + kRows));
}

TEST(CommentLines, UnitsInThemAreTaken) {
  const Imported imported = import_text("# t, fx, fy, fz\n# ms, mN, mN, mN\n0,1,2,3\n10,1,2,3\n");
  EXPECT_DOUBLE_EQ(test::cell(imported, "t", 1), 0.01);
  EXPECT_DOUBLE_EQ(test::cell(imported, "fz", 1), 0.003);
}

TEST(CommentLines, UnitsOfNothingAndOfTurnsAreUnits) {
  const std::string rows = "0,1,0.5,2,1\n1,1,0.5,2,2\n2,1,0.5,2,3\n";
  ImportWishes wishes;
  wishes.rate_hz = 100.0;
  wishes.map = {{"q:1", "position"}, {"tau:1", "effort"}};
  const Imported imported = import_text(
      "% step,voltage,position,velocity,effort\n% [#],[V],[turns],[turns/s],[Nm]\n" + rows, wishes);
  EXPECT_NEAR(test::cell(imported, "q_1", 1), std::numbers::pi, 1e-12);
}

TEST(CommentLines, AMarkThatEndsEachRowIsNoCell) {
  const Imported imported =
      import_text("% settings\n% t,fx,fy,fz\n0,1,2,3;\n0.01,1,2,4;\n0.02,1,2,5; \n");
  EXPECT_DOUBLE_EQ(test::cell(imported, "fz", 1), 4.0);
}

// Whole numbers in two columns are no decimal commas where the names are two.
TEST(CommentLines, SayNothingOfTheSeparator) {
  const std::string rows = "0,1\n1,3\n2,4\n";
  ImportWishes wishes;
  wishes.map = {{"q:1", "a"}, {"tau:1", "b"}};
  wishes.rate_hz = 100.0;
  const Imported imported = import_text("# robot, tool, 3\na,b\n" + rows, wishes);
  EXPECT_EQ(test::cell(imported, "tau_1", 1), 3.0);
  const std::string words = test::data_error([&] { import_text("# force\n" + rows, wishes); });
  EXPECT_NE(words.find("--decimal ,"), std::string::npos) << words;
}

}  // namespace
}  // namespace dcnn
