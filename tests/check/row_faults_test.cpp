// SPDX-License-Identifier: Apache-2.0
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
  return moving_tool::report_of(std::move(table));
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

void hold(Eigen::MatrixXd& values, Eigen::Index column, Eigen::Index length) {
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    values(i, column) = values(i - i % length, column);
  }
}

void keep(Eigen::MatrixXd& values, Eigen::Index begin, Eigen::Index rows, Eigen::Index column,
          Eigen::Index columns) {
  for (Eigen::Index i = begin + 1; i < begin + rows; ++i) {
    values.row(i).segment(column, columns) = values.row(begin).segment(column, columns);
  }
}

void round_columns(Eigen::MatrixXd& values, Eigen::Index column, double step) {
  for (Eigen::Index j = column; j < column + 3; ++j) {
    // As a text file has it, with four decimals.
    for (double& value : values.col(j)) {
      value = std::round(std::round(value / step) * step * 1e4) / 1e4;
    }
  }
}

/// The log without these columns.
check::Report report_without(const std::vector<std::string>& names) {
  Table table = moving_tool::log(), rest;
  std::vector<Eigen::Index> kept;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (std::find(names.begin(), names.end(), table.columns[k]) != names.end()) continue;
    kept.push_back(static_cast<Eigen::Index>(k));
    rest.columns.push_back(table.columns[k]);
  }
  rest.values = table.values(Eigen::all, kept);
  return moving_tool::report_of(std::move(rest));
}

TEST(RowFaults, WhatIsMissingOfAWristIsSaid) {
  expect_first(report_without({"fz"}), "missing", "fz");
  expect_first(report_without({"fx", "fy", "fz"}), "missing", "fx");
  expect_first(report_without({"beta"}), "missing", "beta");
  expect_first(report_without({"alpha", "beta", "gamma"}), "missing", "alpha");
  // A slide is no wrist.
  Table slide;
  slide.columns = {"t", "x", "force"};
  slide.values = moving_tool::log().values.leftCols(3);
  expect_none(moving_tool::report_of(std::move(slide)), "missing");
}

TEST(RowFaults, NothingIsWrongWithTheLogItself) {
  const check::Report report = moving_tool::report_of(moving_tool::log());
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

// Lengths are not: 6.3 mm is no turn in rad.
TEST(RowFaults, PositionsThatJumpBySixMillimetresHaveSpikes) {
  Table table = moving_tool::log();
  table.values.middleCols(kX, 3) *= 1e3;
  for (const Eigen::Index row : {700, 1900, 3100}) table.values(row, kX) += 6.3;
  check::Declared declared;
  declared.read.position_unit = 1e-3;
  const check::Report report = check::check(check::make_log("mm.csv", table, declared));
  expect_first(report, "spikes", "x");
}

TEST(RowFaults, OneChannelAloneIsHeld) {
  expect_first(report_after([](Eigen::MatrixXd& values) { hold(values, kFz, 3); }), "held", "fz");
  expect_first(report_after([](Eigen::MatrixXd& values) { hold(values, kGamma, 4); }), "held",
               "gamma");
}

TEST(RowFaults, APoseThatStandsStillAndThenJumpsIsFrozen) {
  const check::Report report =
      report_after([](Eigen::MatrixXd& values) { keep(values, 1500, 150, kX, 6); });
  expect_first(report, "frozen", "x");
  expect_none(report, "contact");
}

// The pose of a robot that rests is the same for long, too; it starts gently.
TEST(RowFaults, APoseAtRestIsNotFrozen) {
  const check::Report report = report_after([](Eigen::MatrixXd& values) {
    const Eigen::MatrixXd rest = values.row(2000).segment(kX, 6);
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const double way = std::clamp(std::abs(static_cast<double>(i) - 2000.0) - 200.0, 0.0, 1e9);
      const double share = std::min(1.0, way * way / 4e4);  // from rest at one acceleration
      values.row(i).segment(kX, 6) =
          (1.0 - share) * rest + share * values.row(i).segment(kX, 6).eval();
      for (Eigen::Index j = kX; j <= kGamma; ++j) {
        values(i, j) = std::round(values(i, j) / 1e-4) * 1e-4;
      }
    }
  });
  expect_none(report, "frozen");
}

TEST(RowFaults, ForcesThatKeepTheLastValueSeveralTimesAreFrozen) {
  const check::Report report = report_after([](Eigen::MatrixXd& values) {
    for (const Eigen::Index row : {300, 900, 1500, 2200, 3000}) keep(values, row, 15, kFx, 3);
  });
  expect_first(report, "frozen", "fx");
}

// A sensor that repeats its values at rest tells nothing of one that keeps them on the move.
TEST(RowFaults, ForcesThatAreKeptAtRestHideNoneThatAreKeptOnTheMove) {
  const check::Report report = report_after([](Eigen::MatrixXd& values) {
    for (const Eigen::Index row : {600, 1800, 2600}) {
      for (Eigen::Index i = row; i < row + 100; ++i) {
        values.row(i).segment(kX, 6) = values.row(row).segment(kX, 6);
      }
      keep(values, row + 20, 60, kFx, 3);
    }
    for (const Eigen::Index row : {300, 1200, 2200, 3100}) keep(values, row, 20, kFx, 3);
  });
  expect_first(report, "frozen", "fx");
}

TEST(RowFaults, CoarseForcesAreQuantisedThoughTheirDigitsAreRounded) {
  for (const double step : {3.7713 * kForceNoise, 11.037 * kForceNoise}) {
    expect_first(report_after([&](Eigen::MatrixXd& values) { round_columns(values, kFx, step); }),
                 "quantisation", "fx");
  }
}

TEST(RowFaults, AnglesAndPositionsAreQuantisedWhereTheForceShowsIt) {
  const double degree = std::acos(-1.0) / 180.0;
  expect_first(
      report_after([&](Eigen::MatrixXd& values) { round_columns(values, kAlpha, degree); }),
      "quantisation", "alpha");
  expect_first(report_after([](Eigen::MatrixXd& values) { round_columns(values, kX, 0.005); }),
               "quantisation", "x");
  expect_none(report_after([](Eigen::MatrixXd& values) { round_columns(values, kX, 1e-4); }),
              "quantisation");
}

TEST(RowFaults, WholeNumbersAreCountsBeforeTheyAreAnotherUnit) {
  for (const double per_newton : {25.0, 37.5, 64.0}) {
    const check::Report report = report_after([&](Eigen::MatrixXd& values) {
      values.rightCols(3) = (per_newton * values.rightCols(3).array()).round();
    });
    expect_first(report, "counts", "fx");
    expect_none(report, "force_unit");
  }
}

// A tool fitted to what begins anew at either end has neither a delay nor an offset.
TEST(RowFaults, AChannelThatWrapsShowsNoDelayAndNoZero) {
  const check::Report report = report_after([](Eigen::MatrixXd& values) {
    for (Eigen::Index j = kFx; j <= kFz; ++j) {
      const Eigen::VectorXd x = values.col(j);
      const double gain = 65536.0 / (0.7 * (x.maxCoeff() - x.minCoeff()));
      for (double& value : values.col(j)) {
        const double counts = std::floor(gain * (value - x.mean()));
        value = counts - 65536.0 * std::floor((counts + 32768.0) / 65536.0);
      }
    }
  });
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "wrap") << check::to_text(report);
  expect_none(report, "delay");
  expect_none(report, "zeroed");
}

TEST(RowFaults, ChannelsLostToZeroAreNotLimitedThere) {
  const check::Report report = report_after([](Eigen::MatrixXd& values) {
    for (const Eigen::Index row : {300, 900, 1500, 2200, 3000}) {
      values.col(kFz).segment(row, 6).setZero();
    }
  });
  expect_first(report, "dropouts", "fz");
  expect_none(report, "saturation");
}

TEST(RowFaults, RowsThatAreStampedInBurstsAreOfOneRate) {
  const check::Report report = report_after([](Eigen::MatrixXd& values) {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      values(i, kT) =
          kToolStep * static_cast<double>(i - i % 16) + 1e-5 * static_cast<double>(i % 16);
    }
  });
  expect_first(report, "jitter", "t");
  EXPECT_EQ(report.faults.size(), 1U) << check::to_text(report);
}

// Half of the rows at rest: from one pose to the next the motion goes on for several rows.
TEST(RowFaults, AMotionWithPausesWithoutAClockIsNoListOfPoses) {
  Table table = moving_tool::log();
  constexpr Eigen::Index kPiece = 20, kRest = 60;
  Eigen::MatrixXd paused(kToolRows, table.values.cols() - 1);
  std::mt19937 random(2);
  std::normal_distribution<double> noise;
  for (Eigen::Index i = 0; i < kToolRows; ++i) {
    const Eigen::Index cycle = i / (kPiece + kRest), in = std::min(i % (kPiece + kRest), kPiece);
    paused.row(i) = table.values.row(cycle * kPiece + in).rightCols(paused.cols());
    for (Eigen::Index j = 0; j < 6; ++j) paused(i, j) += (j < 3 ? 1e-5 : 6e-5) * noise(random);
  }
  table.columns.erase(table.columns.begin());
  table.values = paused;
  expect_first(moving_tool::report_of(std::move(table)), "moving_rows", "t");
}

}  // namespace
}  // namespace dcnn
