// SPDX-License-Identifier: Apache-2.0
// What is a name on a machine: laws that all machines have, that its base has, that nobody
// commands.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "core/elementary.h"
#include "dcnn/core/error.h"
#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/axis_sense.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/name_prior.h"
#include "diagnosis/evidence/priors.h"
#include "support/process.h"

namespace dcnn {
namespace {

constexpr double kNamesRate = 250.0, kNamesNoise = 0.05;
constexpr Index kNamesRows = 5000;

/// A motion of four sines; the drive's torque is 3 a + 1.5 q + 4, or held at a command.
void write_log(const std::filesystem::path& path, double begin, std::optional<double> command) {
  Rng rng({static_cast<std::uint64_t>(begin) + 1});
  Table table{{"t", "pos", "vel", "acc", "torque"}, Eigen::MatrixXd(kNamesRows, 5)};
  for (Index k = 0; k < kNamesRows; ++k) {
    const double t = begin + static_cast<double>(k) / kNamesRate;
    double q = 0.0, v = 0.0, a = 0.0;
    for (const double hz : {0.11, 0.27, 0.53, 0.97}) {
      const double w = 2.0 * std::numbers::pi * hz, size = 0.03 / hz;
      q += size * std::sin(w * t + 9.0 * hz);
      v += size * w * std::cos(w * t + 9.0 * hz);
      a -= size * w * w * std::sin(w * t + 9.0 * hz);
    }
    const double torque = command.value_or(3.0 * a + 1.5 * q + 4.0 + kNamesNoise * rng.normal());
    table.values.row(k) << t, q, v, a, torque;
  }
  write_csv(path, table);
}

Json machine(const Json& base) {
  return {{"kind", "axes"},
          {"axes", Json::array({{{"name", "wheel"},
                                 {"measured", "torque"},
                                 {"unit", "N*m"},
                                 {"position", "pos"},
                                 {"velocity", "vel"},
                                 {"acceleration", "acc"},
                                 {"base", base}}})}};
}

class MachineNames : public testing::Test {
 protected:
  DiagnosisRequest request(const Json& base) const {
    write_file(folder_ / "machine.json", machine(base).dump());
    write_log(folder_ / "fit.csv", 0.0, {});
    write_log(folder_ / "hold.csv", 30.0, {});
    DiagnosisRequest request;
    request.system = folder_ / "machine.json";
    request.fit = {folder_ / "fit.csv"};
    request.holdout = {folder_ / "hold.csv"};
    return request;
  }
  test::TemporaryFolder folder_;
};

// Beside a stiffness that is fitted a spring with another rest is an offset.
TEST_F(MachineNames, ASpringInTheBaseIsNoSecondOne) {
  const Json report = diagnose(request({"acceleration", "position"}), nullptr).report;
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  EXPECT_EQ(report["findings"][0]["effect"], "bias");
  EXPECT_NEAR(report["findings"][0]["parameters"]["delta_bias"]["value"].get<double>(), 4.0, 0.02);
}

TEST_F(MachineNames, ACommandMayBeConstantASensorMayNot) {
  DiagnosisRequest both = request({"acceleration", "velocity"});
  both.fit.push_back(folder_ / "step.csv");
  write_log(both.fit.back(), 60.0, -7.0);
  EXPECT_NO_THROW(diagnose(both, nullptr));
  write_log(both.fit.back(), 60.0, -7.0413);
  EXPECT_THROW(diagnose(both, nullptr), Error);
}

/// Of t, the sense and noise: t, pos, torque.
using SensedRow = std::function<Eigen::RowVector3d(double t, double sense, Rng& rng)>;
/// That both senses are told of the logs that `row` makes.
void expect_senses(const SensedRow& row, double step, std::uint64_t seed = 0,
                   const DerivativeSpec& derivative = {}) {
  const test::TemporaryFolder folder;
  write_file(folder / "machine.json", machine({"acceleration"}).dump());
  System system = read_system(folder / "machine.json");
  system.axes[0].velocity = system.axes[0].acceleration = "";
  for (const double sense : {1.0, -1.0}) {
    Rng rng({seed});
    Table table{{"t", "pos", "torque"}, Eigen::MatrixXd(2000, 3)};
    for (Index k = 0; k < table.values.rows(); ++k) {
      table.values.row(k) = row(step * static_cast<double>(k), sense, rng);
    }
    write_csv(folder / "log.csv", table);
    const std::vector<Recording> logs{read_recording(folder / "log.csv", {}, system)};
    EXPECT_EQ(sense_of(logs, system, system.axes[0], derivative), sense) << seed;
  }
}

// Of a motion to and fro at one frequency half a period later is the opposite: only that long
// delays are rare tells a drive from its reaction.
TEST(AxisSense, OfAMotionToAndFroIsToldAtTheShorterDelay) {
  constexpr double kTurns = 4.0 * std::numbers::pi, kSwing = 8.0;  // rad/s, rad
  const auto row = [](double t, double sense, Rng& rng) {
    const double v = kSwing * kTurns * std::cos(kTurns * t);
    const double q = kSwing * std::sin(kTurns * t), a = -kTurns * kTurns * q;
    const double drive = 1.9e-4 * a + 1.5e-4 * v + 0.075 * std::tanh(v / 10.0);
    const double shown = q + 1e-3 * rng.normal();
    return Eigen::RowVector3d(t, shown, sense * drive + 0.0155 * rng.normal());
  };
  for (std::uint64_t seed = 0; seed < 5; ++seed) expect_senses(row, 0.004, seed);
}

// Steps to and fro, of which the filter of the derivatives passes the first harmonic alone.
TEST(AxisSense, IsToldOfBothSidesBehindOneFilter) {
  DerivativeSpec slow;
  slow.kind = DerivativeSpec::Kind::kSpectral;
  slow.cutoff_hz = 2.0;
  const auto row = [](double t, double sense, Rng& rng) {
    double q = 0.0, v = 0.0, a = 0.0;
    for (const double order : {1.0, 3.0, 5.0}) {
      const double w = 2.0 * std::numbers::pi * order, size = 5e-3 / order;
      q += size * std::sin(w * t);
      v += size * w * std::cos(w * t);
      a -= size * w * w * std::sin(w * t);
    }
    return Eigen::RowVector3d(t, q, sense * (2.1 * a + 14.0 * v) + 0.05 * rng.normal());
  };
  expect_senses(row, 0.01, 11, slow);
}

// A swing-up: the weight is most of the torque, and its sine is no line of the position.
TEST(AxisSense, OfAPendulumIsNotThatOfItsWeight) {
  const auto row = [](double t, double sense, Rng& rng) {
    // Swings that grow, and a turn over the top.
    const double w = 5.0, grow = 0.35 * t;
    const double q = grow * std::sin(w * t),
                 v = 0.35 * std::sin(w * t) + grow * w * std::cos(w * t),
                 a = 0.7 * w * std::cos(w * t) - grow * w * w * std::sin(w * t);
    const double drive = 0.17 * a + 3.5 * std::sin(q) + 0.11 * std::tanh(v / 0.05);
    const double shown = q + 1e-3 * rng.normal();
    return Eigen::RowVector3d(t, shown, sense * drive + 0.1 * rng.normal());
  };
  expect_senses(row, 0.004, 7);
}

// Over a small range the rates of a weight are the velocity again: what a weight can be late by
// bounds them, or no drag would tell the sense.
TEST(AxisSense, OfASmallRangeIsToldByItsDrag) {
  const auto row = [](double t, double sense, Rng& rng) {
    double q = 0.2, v = 0.0;
    for (const double w : {1.3, 2.9, 4.7}) {
      q += 0.06 * std::sin(w * t);
      v += 0.06 * w * std::cos(w * t);
    }
    const double drag = 0.03 * std::tanh(v / 0.05) + 0.01 * v;
    return Eigen::RowVector3d(t, q, sense * drag + 0.005 * rng.normal());
  };
  expect_senses(row, 0.01, 5);
}

// A sensor at the output of a gear, beside the drive's own torque: it reads a share of it, less the
// gear's friction. Without that share the reading, which goes with the drive, looks like one.
TEST(AxisSense, BesideASimulatedDriveIsThatOfTheRest) {
  const test::TemporaryFolder folder;
  write_file(folder / "machine.json", R"({"kind": "axes", "axes": [{"name": "gear",
      "measured": "output", "unit": "N*m", "position": "q", "simulated": "drive"}]})");
  const System system = read_system(folder / "machine.json");
  for (const double sense : {1.0, -1.0}) {
    Rng rng({17});
    Table table{{"t", "q", "drive", "output"}, Eigen::MatrixXd(3000, 4)};
    for (Index k = 0; k < table.values.rows(); ++k) {
      const double t = 0.01 * static_cast<double>(k), w = 2.9;
      const double q = std::sin(w * t) + 0.4 * std::sin(1.7 * w * t);
      const double v = w * (std::cos(w * t) + 0.68 * std::cos(1.7 * w * t));
      const double drive = 1.5 * std::tanh(v) + 2.0 * std::sin(0.37 * w * t);
      const double friction = 0.4 * std::tanh(v / 0.1);
      table.values.row(k) << t, q, drive, 0.63 * drive + sense * friction + 0.1 * rng.normal();
    }
    write_csv(folder / "log.csv", table);
    const std::vector<Recording> logs{read_recording(folder / "log.csv", {}, system)};
    EXPECT_EQ(sense_of(logs, system, system.axes[0], {}), sense);
  }
}

TEST(NamePrior, FrictionIsTheRuleOnAMachineAlone) {
  const auto rare = [](double p) { return elementary::log(p / (1.0 - p)); };
  Case tool, axis;
  axis.axis = std::make_shared<const AxisPlan>();
  for (const char* name : {"coulomb_friction", "viscous_friction"}) {
    const EffectKind& kind = *find_effect(name);
    EXPECT_EQ(evidence::log_odds_of_name(axis, kind), rare(evidence::prior::kCommon)) << name;
    EXPECT_EQ(evidence::log_odds_of_name(tool, kind), rare(evidence::prior::kName)) << name;
  }
  EXPECT_EQ(evidence::log_odds_of_name(axis, *find_effect("hum")), rare(evidence::prior::kName));
  EXPECT_LT(evidence::log_odds_of_name(axis, *find_effect("gear_friction")),
            rare(evidence::prior::kName));
}

}  // namespace
}  // namespace dcnn
