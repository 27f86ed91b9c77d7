// SPDX-License-Identifier: Apache-2.0
// Every fault of the generator is the first that the check names; clean logs stop nothing.
#include <gtest/gtest.h>

#include "dcnn/check/check.h"
#include "dcnn/conceal/faulty.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

check::Log log_of(const std::string& kind, std::uint64_t seed, bool with_simulator = true) {
  const conceal::FaultyLog made = conceal::make_faulty(kind, seed);
  check::Declared declared;
  if (with_simulator && !made.simulator.is_null()) {
    declared.model = parse_tool_model(made.simulator, "sim.json", Exit::kData);
  }
  if (made.system.is_null()) return check::make_log(kind + ".csv", made.table, declared);
  declared.system = parse_system(made.system, "system.json");
  check::Log log = check::make_log(kind + ".csv", made.table, declared);
  check::describe_arm(log, parse_chain(declared.system.arm, "system.json", Exit::kData));
  return log;
}

class FaultyLogs : public ::testing::TestWithParam<std::string> {};

TEST_P(FaultyLogs, AreNamedFirst) {
  const std::string wanted = conceal::make_faulty(GetParam(), 1).fault;
  const check::Report report = check::check(log_of(GetParam(), 1));
  if (wanted.empty()) {
    EXPECT_EQ(report.stopping({}), nullptr) << check::to_text(report);
    for (const check::Fault& fault : report.faults)
      EXPECT_LT(fault.probability, check::kLikely) << fault.words;
    return;
  }
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, wanted) << check::to_text(report);
  EXPECT_GE(report.faults[0].probability, check::kLikely);
  EXPECT_FALSE(report.faults[0].remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(Kinds, FaultyLogs, ::testing::ValuesIn(conceal::faulty_kinds()),
                         [](const auto& kind) { return kind.param; });

// A mounting that nobody can name by exchanging axes is weighed beside those that one can.
TEST(CheckedLogs, ATurnedSensorIsNoFlippedSign) {
  const check::Report report = check::check(log_of("mounting", 99024));
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "mounting") << check::to_text(report);
  EXPECT_EQ(report.stopping({}), nullptr) << check::to_text(report);
}

// A contact in a fifth of the rows moves the first fit's offset by a newton; the reweighted fit is
// carried on until it has left the contact out.
TEST(CheckedLogs, ALongContactIsLeftOutOfTheFitThatFindsIt) {
  const check::Report report = check::check(log_of("contact", 99029));
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "contact") << check::to_text(report);
  EXPECT_GE(report.faults[0].probability, check::kCertain) << check::to_text(report);
}

// The residual of the log as it is, smooth by the delay itself, would count as a few rows.
TEST(CheckedLogs, ADelayIsCertainWhereItsResidualIsSmooth) {
  const check::Report report = check::check(log_of("delay_late", 99025));
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "delay") << check::to_text(report);
  EXPECT_GE(report.faults[0].probability, check::kCertain);
}

// Three rows of 18 to 20 deviations: no one of them is beyond the worst noise alone.
TEST(CheckedLogs, SeveralSpikesTogetherAreNamed) {
  const check::Report report = check::check(log_of("spikes", 55101));
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "spikes") << check::to_text(report);
  EXPECT_GE(report.faults[0].probability, check::kLikely);
}

// A joint that stands still most of the time: its rate's noise at rest says nothing of its unit,
// and how long it stands nothing of a clock.
TEST(CheckedLogs, AJointThatSticksHasTheRateThatItSays) {
  constexpr Eigen::Index kRows = 4000;
  Rng rng({9});
  Table table;
  table.columns = {"t", "q", "qd", "tau"};
  table.values.resize(kRows, 4);
  double q = 0.0;
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const bool moves = (i / 100) % 5 == 0;  // 0.4 s of every 2 s
    const double v = moves ? ((i / 500) % 2 == 0 ? 0.3 : -0.3) : 0.0;
    q += 0.004 * v;
    table.values.row(i) << 0.004 * static_cast<double>(i), std::round(q / 1e-4) * 1e-4,
        v + 0.01 * rng.normal(), (moves ? 0.4 * v / 0.3 : 0.0) + 0.02 * rng.normal();
  }
  check::Declared declared;
  declared.system = parse_system(Json{{"kind", "axes"},
                                      {"axes", Json::array({{{"name", "joint"},
                                                             {"measured", "tau"},
                                                             {"unit", "N*m"},
                                                             {"position", "q"},
                                                             {"velocity", "qd"},
                                                             {"base", Json::array()}}})}},
                                 "system.json");
  const check::Report report = check::check(check::make_log("sticks.csv", table, declared));
  for (const check::Fault& fault : report.faults) {
    EXPECT_NE(fault.id, "rates") << fault.words;
    EXPECT_NE(fault.id, "held") << fault.words;
  }
}

TEST(CheckedLogs, WithoutASimulatorSignsAxesAndFramesAreFoundToo) {
  for (const char* kind : {"reaction", "sign_fx", "swap_xy", "base_frame", "angle_deg",
                           "position_mm", "quaternion_xyzw"}) {
    const check::Report report = check::check(log_of(kind, 2, false));
    ASSERT_FALSE(report.faults.empty()) << kind;
    EXPECT_EQ(report.faults[0].id, conceal::make_faulty(kind, 2).fault) << check::to_text(report);
  }
}

TEST(CheckedLogs, AMountingThatNobodyDeclaredStopsNothing) {
  const check::Report report = check::check(log_of("turned_90", 1, false));
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "force_axes");
  EXPECT_EQ(report.stopping({}), nullptr);
}

TEST(CheckedLogs, ASubtractedWeightIsFoundWithoutASimulatorAndStopsNothing) {
  const check::Report report = check::check(log_of("compensated", 1, false));
  ASSERT_FALSE(report.faults.empty()) << check::to_text(report);
  EXPECT_EQ(report.faults[0].id, "compensated") << check::to_text(report);
  EXPECT_EQ(report.stopping({}), nullptr);
}

TEST(CheckedLogs, TwoFaultsOfUnitsAreFoundTogether) {
  conceal::FaultyLog made = conceal::make_faulty("angle_deg", 3);
  made.table = conceal::with_fault("position_mm", made.table, 3);
  const check::Report report = check::check(check::make_log("both.csv", made.table, {}));
  const auto has = [&](const std::string& id) {
    return std::any_of(report.faults.begin(), report.faults.end(), [&](const check::Fault& fault) {
      return fault.id == id && fault.probability > check::kLikely;
    });
  };
  EXPECT_TRUE(has("angle_unit")) << check::to_text(report);
  EXPECT_TRUE(has("position_unit")) << check::to_text(report);
}

// A force of the other sign under angles in degrees: neither alone makes a tool of it.
TEST(CheckedLogs, UnitsAndASignThatOnlyTogetherMakeAToolAreFoundTogether) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    conceal::FaultyLog made = conceal::make_faulty("angle_deg", seed);
    const auto column = [&](const char* name) {
      const auto at = std::find(made.table.columns.begin(), made.table.columns.end(), name);
      return made.table.values.col(at - made.table.columns.begin());
    };
    for (const char* name : {"fx", "fy", "fz"}) column(name) *= -1.0;
    column("t") *= 1e3;
    check::Declared declared;
    declared.model = parse_tool_model(made.simulator, "sim.json", Exit::kData);
    const check::Report report = check::check(check::make_log("three.csv", made.table, declared));
    for (const char* fault : {"angle_unit", "clock_unit", "reaction"}) {
      EXPECT_TRUE(std::any_of(report.faults.begin(), report.faults.end(), [&](const auto& found) {
        return found.id == fault && found.probability >= check::kCertain;
      })) << check::to_text(report);
    }
    EXPECT_EQ(report.faults.size(), 3U) << check::to_text(report);
    for (const check::Fault& fault : report.faults) {  // an option mends its own fault alone
      EXPECT_EQ(fault.flag == "--angle-unit deg", fault.id == "angle_unit") << fault.id;
    }
  }
}

/// A motor's current in steps of 0.05 A, two rows each, that a drive limits to +-`limit`; at rest
/// for `rest` rows at the end of each of the swings.
check::Report check_of_current(double limit, Eigen::Index rest) {
  Table table{{"t", "q_1", "tau_1"}, Eigen::MatrixXd(4000, 3)};
  Rng rng({7});
  Eigen::Index still = 0;
  double phase = 0.0, current = 0.0;
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double before = std::cos(phase);
    if (still-- <= 0) phase += 0.01;
    if (before * std::cos(phase) < 0.0) still = rest;
    const double raw = 8.0 * std::sin(phase) + 1.5 * std::sin(2.7 * phase) + 0.1 * rng.normal();
    if (i % 2 == 0 && still <= 0) {
      current = 0.05 * std::round(std::clamp(raw, -limit, limit) / 0.05);
    }
    table.values.row(i) << 0.01 * static_cast<double>(i), -std::cos(phase), current;
  }
  check::Declared declared;
  declared.system = parse_system(
      Json::parse(R"({"kind": "axes", "axes": [{"name": "1", "measured": "tau_1", "unit": "A",
                      "base": [], "position": "q_1"}]})"),
      "arm.json");
  return check::check(check::make_log("current.csv", table, declared));
}

TEST(CheckedLogs, ALimitedCurrentIsSaturatedAlthoughItsRowsRepeat) {
  const auto saturation = [](const check::Report& report) {
    double most = 0.0;
    for (const check::Fault& fault : report.faults) {
      if (fault.id == std::string("saturation")) most = std::max(most, fault.probability);
    }
    return most;
  };
  EXPECT_GE(saturation(check_of_current(7.0, 0)), check::kCertain);
  EXPECT_LT(saturation(check_of_current(20.0, 0)), check::kLikely);
  EXPECT_LT(saturation(check_of_current(20.0, 200)), check::kLikely);  // holds its load at rest
}

TEST(CheckedLogs, WhatIsDeclaredIsNoFault) {
  check::Declared declared;
  declared.read.position_unit = 1e-3;
  const auto made = conceal::make_faulty("position_mm", 4);
  const check::Report report = check::check(check::make_log("mm.csv", made.table, declared));
  EXPECT_EQ(report.stopping({}), nullptr) << check::to_text(report);
  EXPECT_NE(check::check(check::make_log("mm.csv", made.table, {})).stopping({}), nullptr);
}

TEST(CheckedLogs, AnAcceptedFaultStopsNothing) {
  const check::Report report = check::check(log_of("reaction", 1));
  ASSERT_NE(report.stopping({}), nullptr);
  EXPECT_EQ(report.stopping({"reaction"}), nullptr);
}

TEST(CheckedLogs, TheirReportIsTheDocumentedJson) {
  const Json json = check::to_json(check::check(log_of("dropouts", 1)));
  const Json& fault = json["faults"][0];
  EXPECT_EQ(fault["fault"], "dropouts");
  EXPECT_TRUE(fault["probability"].is_number());
  EXPECT_EQ(fault["interval_s"].size(), 2U);
  EXPECT_TRUE(fault["words"].is_string() && fault["remedy"].is_string());
  EXPECT_TRUE(json["identifiable"]["mass"].is_boolean());
}

TEST(CheckedLogs, TinyOrConstantTablesAreNoTrouble) {
  for (const Eigen::Index rows : {1, 2, 3, 10, 60}) {
    Table table{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"},
                Eigen::MatrixXd::Zero(rows, 10)};
    table.values.col(0) =
        Eigen::VectorXd::LinSpaced(rows, 0.0, 0.004 * static_cast<double>(rows - 1));
    for (const check::Fault& fault : check::check(check::make_log("zeros.csv", table, {})).faults) {
      EXPECT_TRUE(fault.probability >= 0.0 && fault.probability <= 1.0)
          << fault.id << " " << fault.probability;
    }
  }
}

}  // namespace
}  // namespace dcnn
