// Faults of a few rows or of one column: what was misread, held, lost or rounded.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "check/moving_tool.h"

namespace dcnn {
namespace {

using namespace moving_tool;

check::Report report_after(const std::function<void(Eigen::MatrixXd&)>& change) {
  Table table = moving_tool::log();
  change(table.values);
  return report_of(std::move(table));
}

void expect_first(const check::Report& report, const std::string& fault,
                  const std::string& channel) {
  ASSERT_FALSE(report.faults.empty()) << fault;
  EXPECT_EQ(report.faults[0].id, fault) << check::to_text(report);
  EXPECT_EQ(report.faults[0].channel, channel) << check::to_text(report);
  EXPECT_GE(report.faults[0].probability, check::kCertain) << check::to_text(report);
}

void expect_none(const check::Report& report, const std::string& fault) {
  for (const check::Fault& found : report.faults) {
    EXPECT_FALSE(found.id == fault && found.probability >= check::kLikely) << found.words;
  }
}

TEST(RowFaults, NothingIsWrongWithTheLogItself) {
  const check::Report report = report_of(moving_tool::log());
  EXPECT_TRUE(report.faults.empty()) << check::to_text(report);
}

TEST(RowFaults, SpikesOfTwoRowsAreFoundAndAreNoRegisterThatWraps) {
  for (const double height : {2.0, 40.0}) {
    const check::Report report = report_after([&](Eigen::MatrixXd& values) {
      for (const Eigen::Index row : {500, 1300, 2100, 3300}) {
        values(row, kFz) += height;
        values(row + 1, kFz) += height;
      }
    });
    expect_first(report, "spikes", "fz");
    expect_none(report, "wrap");
  }
}

TEST(RowFaults, SpikesOfThePoseAreNoContact) {
  for (const Eigen::Index column : {kX, kAlpha, kGamma}) {
    const check::Report report = report_after([&](Eigen::MatrixXd& values) {
      for (const Eigen::Index row : {700, 1900, 3100}) values(row, column) += 0.15;
    });
    expect_first(report, "spikes", moving_tool::log().columns[static_cast<std::size_t>(column)]);
    expect_none(report, "contact");
  }
}

// Angles are the same after a turn.
TEST(RowFaults, AnglesThatBeginAnewHaveNoSpikes) {
  const check::Report report = report_after([](Eigen::MatrixXd& values) {
    for (const Eigen::Index row : {700, 1900, 3100}) values(row, kGamma) += 2.0 * std::acos(-1.0);
  });
  expect_none(report, "spikes");
}

}  // namespace
}  // namespace dcnn
