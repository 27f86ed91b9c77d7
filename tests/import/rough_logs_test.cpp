// SPDX-License-Identifier: Apache-2.0
// Logs of controllers as they are: clocks without a unit, packets read from the wrong byte.
#include <gtest/gtest.h>

#include <iomanip>
#include <numbers>
#include <sstream>

#include "import/broken_rows.h"
#include "import/logs.h"

namespace dcnn {
namespace {

using test::cell;
using test::data_error;
using test::has_column;
using test::import_text;

struct Row {
  double t, q, v;
};

Row row_at(int k, double step) {
  const double t = step * k;
  return {t, std::sin(2.0 * t) + 0.3 * std::sin(5.0 * t),
          2.0 * std::cos(2.0 * t) + 1.5 * std::cos(5.0 * t)};
}

/// A joint at 1000 rows a second; `clock` writes the first column, with its name.
template <class Clock>
std::string joint_log(const std::string& name, int rows, Clock clock, double angle = 1.0) {
  std::ostringstream text;
  text << std::setprecision(12) << name << "Position1,Velocity1,Torque1\n";
  for (int k = 0; k < rows; ++k) {
    const Row row = row_at(k, 1e-3);
    text << clock(k) << angle * row.q << "," << row.v << ",0.5\n";
  }
  return text.str();
}

std::string milliseconds(int k) { return std::to_string(100 + k) + ","; }

TEST(RoughLogs, RatesTellTheUnitOfTheClock) {
  const Imported imported = import_text(joint_log("Time,", 400, milliseconds));
  EXPECT_NEAR(cell(imported, "t", 399) - cell(imported, "t", 0), 0.399, 1e-9);
  EXPECT_NEAR(cell(imported, "q_1", 100), row_at(100, 1e-3).q, 1e-9);
}

// Degrees beside rad/s fit no unit of time: the clock is asked for, as without rates.
TEST(RoughLogs, RatesInAnotherUnitTellNothing) {
  const std::string words = data_error(
      [] { import_text(joint_log("Time,", 400, milliseconds, 180.0 / std::numbers::pi)); });
  EXPECT_NE(words.find("--clock-unit ms"), std::string::npos) << words;
}

TEST(RoughLogs, WithoutAClockTheRateOfRowsIsProposed) {
  const std::string words =
      data_error([] { import_text(joint_log("", 400, [](int) { return std::string(); })); });
  EXPECT_NE(words.find("--rate 1000"), std::string::npos) << words;
}

// LabVIEW's X_Value, a word in another language: a first column that grows evenly is asked about.
TEST(RoughLogs, AFirstColumnThatGrowsEvenlyIsProposedAsTheClock) {
  const auto log = [](double step) {
    std::ostringstream text;
    text << "X_Value,fx,fy,fz\n";
    for (int k = 0; k < 20; ++k) text << step * k << ",1,2," << 3 + k % 3 << "\n";
    return text.str();
  };
  const std::string words = data_error([&] { import_text(log(0.002)); });
  EXPECT_NE(words.find("--clock 'X_Value'"), std::string::npos) << words;
  ImportWishes wishes;
  wishes.clock = {"X_Value"};
  EXPECT_NEAR(cell(import_text(log(0.002), wishes), "t", 19), 0.038, 1e-9);
  EXPECT_FALSE(has_column(import_text(log(1.0)), "t"));  // numbers of poses at rest
}

TEST(RoughLogs, NumberedWordsAreJointsBesideTheirTorque) {
  EXPECT_TRUE(
      has_column(import_text("t,Position3,Velocity3,Torque3\n0,1,2,3\n0.1,1,2,3\n"), "qd_3"));
  const Imported drive = import_text("t,fx,fy,fz,Position3\n0,1,2,3,4\n0.1,1,2,3,4\n");
  EXPECT_FALSE(has_column(drive, "q_3"));
}

std::string with_line(const std::string& text, int at, const std::string& line) {
  std::size_t place = 0;
  for (int k = 0; k < at; ++k) place = text.find('\n', place) + 1;
  return text.substr(0, place) + line + "\n" + text.substr(place);
}

TEST(RoughLogs, BrokenRowsAreLeftOutAndSaid) {
  std::ostringstream text;
  text << std::setprecision(9) << "t,Position1,Velocity1,Torque1\n";
  for (int k = 0; k < 500; ++k) {
    const Row row = row_at(k, 1e-2);
    text << 3047.5 + row.t << "," << row.q << "," << row.v << ",1\n";
  }
  std::string log = text.str();
  log = with_line(log, 400, "0.79,-1.1e282,253,7");  // out of order
  log = with_line(log, 300, "1e150,0.1,0.1,1");
  log = with_line(log, 200, "3049.4851,-1.1e282,0.1,1");  // in order, its angle out of proportion
  log = with_line(log, 1, "-0.12,253,253,1");             // in order, but an hour before
  const Imported imported = import_text(log);
  EXPECT_EQ(imported.table.values.rows(), 500);
  EXPECT_NEAR(cell(imported, "q_1", 150), row_at(150, 1e-2).q, 1e-8);
  ASSERT_FALSE(imported.notes.empty());
  EXPECT_NE(imported.notes.front().find("4 broken rows"), std::string::npos)
      << imported.notes.front();
}

// More than one in a hundred; a row with the same time and another value would be refused.
TEST(RoughLogs, RowsThatAreThereTwiceAreLeftOut) {
  std::ostringstream text;
  text << std::setprecision(12) << "t [s],Position1,Velocity1,Torque1\n";
  for (int k = 0; k < 200; ++k) {
    const Row row = row_at(k, 1e-2);
    for (int times = k % 20 == 7 ? 2 : 1; times > 0; --times) {
      text << row.t << "," << row.q << "," << row.v << ",1\n";
    }
  }
  const Imported imported = import_text(text.str());
  EXPECT_EQ(imported.table.values.rows(), 200);
  ASSERT_FALSE(imported.notes.empty());
  EXPECT_NE(imported.notes.front().find("10 rows repeat"), std::string::npos)
      << imported.notes.front();
}

TEST(RoughLogs, AClockThatWasSetAnewIsNoBrokenRow) {
  std::vector<std::size_t> rows(1000);
  std::vector<double> times(1000);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k] = k;
    times[k] = 0.01 * static_cast<double>(k < 700 ? k : k - 700);
  }
  EXPECT_EQ(unbroken_rows(rows, times, {}), rows);
}

// A contact after minutes at rest, simulated to the last bit, is no fault.
TEST(RoughLogs, ForcesThatAreRareStay) {
  std::vector<std::size_t> rows(1000);
  std::vector<double> times(1000), force(1000, 1e-15), flag(1000, 0.0);
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = k, times[k] = 0.01 * double(k);
  force[800] = 500.0;
  flag[10] = 1.0;
  EXPECT_EQ(unbroken_rows(rows, times, {force, flag}), rows);
}

}  // namespace
}  // namespace dcnn
