// SPDX-License-Identifier: Apache-2.0
// Faults of joints' channels in logs that end with the drives off, and drives that turn many times.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/check/check.h"
#include "dcnn/core/random.h"
#include "dcnn/data/system.h"

namespace dcnn {
namespace {

constexpr Eigen::Index kRows = 1000, kOn = 920;

/// Two joints at 100 Hz, whose drives are off, and read zero, in the last rows.
Table two_joints() {
  Table table{{"t", "q_1", "q_2", "tau_1", "tau_2"}, Eigen::MatrixXd(kRows, 5)};
  Rng rng({21});
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    const double q1 = std::sin(1.3 * t) + 0.4 * std::sin(4.1 * t),
                 q2 = 0.8 * std::cos(1.7 * t) + 0.3 * std::sin(3.7 * t + 1.0);
    const double on = i < kOn ? 1.0 : 0.0;
    table.values.row(i) << t, q1, q2, on * (8.0 * std::sin(q1) + 0.1 * rng.normal()),
        on * (6.0 * std::sin(q1 + q2) + 2.0 * std::cos(5.0 * t) + 0.3 * rng.normal());
  }
  return table;
}

double probability_of(const check::Report& report, const std::string& fault,
                      const std::string& channel) {
  for (const check::Fault& one : report.faults) {
    if (one.id == fault && one.channel == channel) return one.probability;
  }
  return 0.0;
}

check::Report report_of(const Table& table) {
  return check::check(check::make_log("joints.csv", table, {}));
}

TEST(JointLogs, ADriveThatIsOffIsNoFault) {
  const check::Report report = report_of(two_joints());
  for (const check::Fault& fault : report.faults) {
    EXPECT_LT(fault.probability, check::kLikely) << fault.words;
  }
}

// The rows at zero are more than the frozen ones, and of another kind.
TEST(JointLogs, FrozenRowsAreFoundBesideADriveThatIsOff) {
  Table table = two_joints();
  table.values.col(4).segment(312, 46).setConstant(double(table.values(312, 4)));
  const check::Report report = report_of(table);
  EXPECT_GE(probability_of(report, "frozen", "tau_2"), check::kCertain);
  EXPECT_EQ(report.stopping({}), nullptr);  // the other rows are readings
}

// A step of the voltage that a drive was told to hold, for the whole of a recording.
TEST(JointLogs, ARoundCommandThatIsHeldIsNotFrozen) {
  Table table = two_joints();
  table.values.col(4).setConstant(-7.0);
  EXPECT_LT(probability_of(report_of(table), "frozen", "tau_2"), check::kLikely);
  table.values.col(4).setConstant(-7.0413);
  EXPECT_GE(probability_of(report_of(table), "frozen", "tau_2"), check::kCertain);
}

TEST(JointLogs, ALimitIsFoundBesideADriveThatIsOff) {
  Table table = two_joints();
  auto tau = table.values.col(4);
  std::vector<double> sizes(tau.begin(), tau.end());
  std::sort(sizes.begin(), sizes.end());
  tau = tau.cwiseMin(sizes[static_cast<std::size_t>(0.95 * kRows)]);
  EXPECT_GE(probability_of(report_of(table), "saturation", "tau_2"), check::kLikely);
}

// At a low rate the torque moves as far from row to row as a few of them are from zero.
TEST(JointLogs, SingleRowsAtZeroAreDropouts) {
  Table table = two_joints();
  for (Eigen::Index i = 40; i < kOn; i += 60) table.values(i, 4) = 0.0;
  EXPECT_GE(probability_of(report_of(table), "dropouts", "tau_2"), check::kCertain);
}

// Of a torque that turns over within two rows, the one between may be exactly zero.
// The position of a joint that turns on comes back 0.2 rad away.
TEST(JointLogs, APositionThatStandsStillAndJumpsIsFrozen) {
  Table table = two_joints();
  table.values.col(2).segment(300, 40).setConstant(double(table.values(300, 2)));
  EXPECT_GE(probability_of(report_of(table), "frozen", "q_2"), check::kLikely);
}

TEST(JointLogs, PositionsAtZeroAreDropouts) {
  Table table = two_joints();
  for (const Eigen::Index row : {260, 261, 505, 790}) table.values(row, 2) = 0.0;
  EXPECT_GE(probability_of(report_of(table), "dropouts", "q_2"), check::kCertain);
}

/// The same with rates, of the positions as they were.
Table with_rates(double factor) {
  const Table without = two_joints();
  Table table{{"t", "q_1", "q_2", "tau_1", "tau_2", "qd_1", "qd_2"},
              Eigen::MatrixXd::Zero(kRows, 7)};
  table.values.leftCols(5) = without.values;
  for (Eigen::Index i = 1; i + 1 < kRows; ++i) {
    for (const Eigen::Index j : {1, 2}) {
      table.values(i, j + 4) =
          factor * (without.values(i + 1, j) - without.values(i - 1, j)) / 0.02;
    }
  }
  return table;
}

TEST(JointLogs, RatesOfExchangedJointsAreNamed) {
  Table table = with_rates(1.0);
  EXPECT_LT(probability_of(report_of(table), "rates", "qd_1"), check::kLikely);
  const Eigen::VectorXd first = table.values.col(5);
  table.values.col(5) = table.values.col(6);
  table.values.col(6) = first;
  const check::Report report = report_of(table);
  EXPECT_GE(probability_of(report, "rates", "qd_1"), check::kCertain);
  EXPECT_GE(probability_of(report, "rates", "qd_2"), check::kCertain);
}

// Another shaft's, perhaps: told, but nothing stops for it.
TEST(JointLogs, RatesByAnotherFactorAreLikelyAFault) {
  EXPECT_LT(probability_of(report_of(with_rates(0.95)), "rates", "qd_1"), check::kLikely);
  const double found = probability_of(report_of(with_rates(0.65)), "rates", "qd_1");
  EXPECT_GE(found, check::kLikely);
  EXPECT_LT(found, check::kCertain);
}

TEST(JointLogs, ATorqueThatPassesThroughZeroDidNotDropOut) {
  Table table = two_joints();
  Rng rng({23});
  auto tau = table.values.col(4);
  const auto sign_at = [](Eigen::Index i) { return i / 40 % 2 == 0 ? 6.0 : -6.0; };
  for (Eigen::Index i = 0; i < kRows; ++i) tau[i] = sign_at(i) + 0.1 * rng.normal();
  for (Eigen::Index i = 40; i < kRows; i += 40) tau[i] = 0.0;
  EXPECT_LT(probability_of(report_of(table), "dropouts", "tau_2"), check::kLikely);
  for (Eigen::Index i = 60; i < kRows; i += 120) tau[i] = 0.0;
  EXPECT_GE(probability_of(report_of(table), "dropouts", "tau_2"), check::kCertain);
}

TEST(JointLogs, OneFullTurnIsAWrap) {
  Table table = two_joints();
  table.values.col(1).tail(400).array() -= 2.0 * std::numbers::pi;
  EXPECT_GE(probability_of(report_of(table), "wrap", "q_1"), check::kCertain);
}

// A motor turns as often as it likes, to and fro; its rate agrees with its position.
TEST(JointLogs, AMotorThatTurnsToAndFroIsNotInDegrees) {
  Table table{{"t", "q_1", "qd_1", "tau_1"}, Eigen::MatrixXd(4000, 4)};
  Rng rng({22});
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double t = 0.005 * static_cast<double>(i);
    const double q = 40.0 * std::sin(t) + 15.0 * std::sin(2.7 * t),
                 v = 40.0 * std::cos(t) + 40.5 * std::cos(2.7 * t);
    table.values.row(i) << t, q, v, 0.01 * v + 0.3 * std::tanh(v) + 0.02 * rng.normal();
  }
  EXPECT_LT(probability_of(report_of(table), "angle_unit", "q_1"), check::kLikely);
}

// Positions that are new every ten rows of an uneven clock, beside a drive's own rates: what is
// derived of them says nothing of units.
TEST(JointLogs, PositionsThatAreHeldSayNothingOfTheUnitsOfRates) {
  Table table{{"t", "q_1", "q_2", "qd_1", "qd_2", "tau_1", "tau_2"}, Eigen::MatrixXd(6000, 7)};
  Rng rng({23});
  double t = 0.0, held = 0.0;
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    t += 0.0025 + 0.001 * rng.uniform(-1.0, 1.0);
    const double v = 0.13 * std::cos(0.5 * t);
    if (i % 10 == 0 || rng.uniform() < 0.02) held = 0.26 * std::sin(0.5 * t);
    table.values.row(i) << t, held, 0.3, v + 0.05 * rng.normal(), 0.01 * rng.normal(),
        0.4 * std::tanh(20.0 * v) + 0.1 * rng.normal(), 0.02 * rng.normal();
    if (i == 3000) table.values(i, 2) += 1e-4;  // the encoder's last digit
  }
  const check::Report report = report_of(table);
  for (const char* fault : {"rates", "angle_unit", "clock_unit"}) {
    for (const check::Fault& one : report.faults) {
      if (one.id == fault) {
        EXPECT_LT(one.probability, check::kLikely) << one.words;
      }
    }
  }
}

// A cylinder that is pushed to and fro against a regulated pressure, which the stroke moves: by
// more than friction, and against it. Beside that pressure the log does not tell the sign.
TEST(JointLogs, APressureBesideTheForceDoesNotTurnItsSign) {
  Table table{{"t", "x", "pressure", "f"}, Eigen::MatrixXd(6000, 4)};
  Rng rng({25});
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double t = 0.01 * static_cast<double>(i), w = 0.7;
    const double x = 0.02 * std::sin(w * t + 0.5 * std::sin(w * t)),
                 v = 0.02 * w * (1.0 + 0.5 * std::cos(w * t)) *
                     std::cos(w * t + 0.5 * std::sin(w * t));
    const double pressure = 3.0 - 0.1 * std::tanh(500.0 * v) + 0.002 * rng.normal();
    table.values.row(i) << t, x, pressure,
        49.0 * pressure + 3.0 * std::tanh(1000.0 * v) + 0.05 * rng.normal();
  }
  const Json axis{{"name", "piston"}, {"measured", "f"}, {"unit", "N"}, {"position", "x"}};
  const auto probability = [&](const Json& base) {
    Json described = axis;
    described["base"] = base;
    check::Declared declared;
    declared.system = parse_system({{"kind", "axes"}, {"axes", {described}}}, "test");
    return probability_of(check::check(check::make_log("c.csv", table, declared)), "power_sign",
                          "f");
  };
  EXPECT_GE(probability(Json::array()), check::kLikely);  // of the force as it is alone
  EXPECT_LT(probability({"pressure"}), check::kLikely);
}

// At rest a limit cycle of a controller makes runs of one length, among more that are shorter.
TEST(JointLogs, ALimitCycleAtRestIsNotHeld) {
  Table table{{"t", "q_1", "tau_1"}, Eigen::MatrixXd(1000, 3)};
  Rng rng({26});
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double t = 0.005 * static_cast<double>(i);
    const double cycle = i / 19 % 2 ? 0.02 : -0.02;
    const double moving = std::sin(3.0 * t) + 0.02 * rng.normal();
    table.values.row(i) << t, std::min(t, 2.0) + 0.001 * rng.normal(), i < 400 ? moving : cycle;
  }
  EXPECT_LT(probability_of(report_of(table), "held", "tau_1"), check::kLikely);
}

}  // namespace
}  // namespace dcnn
