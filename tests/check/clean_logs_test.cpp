// SPDX-License-Identifier: Apache-2.0
// Logs with nothing wrong in them that a check may take for faulty ones.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "check/held.h"
#include "dcnn/check/check.h"
#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

/// A tool of 1 kg at rest at every instant, `turn` [rad] the size of its slow turns, a row every
/// `step` [s].
check::Log slow_log(Eigen::Index rows, double step, double turn) {
  Table table{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"},
              Eigen::MatrixXd(rows, 10)};
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.04);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(rows);
    const Eigen::Vector3d angles =
        turn * Eigen::Vector3d(std::sin(9.0 * s), std::sin(14.0 * s + 1.0), std::cos(11.0 * s));
    const Eigen::Vector3d force =
        rotation_from_euler(angles).transpose() * Eigen::Vector3d(0.0, 0.0, -9.81);
    table.values.row(i) << step * static_cast<double>(i), 0.3 + 0.1 * std::sin(7.0 * s),
        0.1 * std::cos(5.0 * s), 0.4, angles.transpose(), force[0] + 1.0 + noise(random),
        force[1] - 2.0 + noise(random), force[2] + 0.5 + noise(random);
  }
  check::Declared declared;
  declared.model = ToolModel();
  declared.model->mass = 1.05;
  return check::make_log("slow.csv", table, declared);
}

TEST(CleanLogs, ARowEveryFourSecondsIsNotInMilliseconds) {
  const check::Report report = check::check(slow_log(120, 4.0, 0.6));
  EXPECT_EQ(report.stopping({}), nullptr) << check::to_text(report);
}

TEST(CleanLogs, MillisecondsAreStillFound) {
  const check::Report report = check::check(slow_log(4000, 4.0, 0.6));
  ASSERT_NE(report.stopping({}), nullptr) << check::to_text(report);
  EXPECT_EQ(report.stopping({})->id, "clock_unit");
}

// A hand that trembles at 9.7 Hz by half a millimetre for seconds at a time, at 100 Hz: forces and
// accelerations pass one low-pass, and a rigid tool leaves nothing of it.
TEST(CleanLogs, ATremorIsNoContact) {
  constexpr Eigen::Index kRows = 4000;
  constexpr double kStep = 0.01, kMass = 0.6, kNoise = 0.012, kTurn = 0.1, kTremor = 5e-4;
  constexpr double kOmega = 2.0 * std::numbers::pi * 9.7;
  const auto position = [](double t) {
    const double apart = std::fmod(t, 10.0) - 6.0, a = kTremor * std::exp(-apart * apart);
    return Eigen::Vector3d(0.2 * std::sin(0.7 * t) + a * std::sin(kOmega * t),
                           0.1 * std::cos(0.9 * t) + a * std::cos(kOmega * t),
                           0.3 + 0.05 * std::sin(1.1 * t));
  };
  Table table{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"},
              Eigen::MatrixXd(kRows, 10)};
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, kNoise);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double t = kStep * static_cast<double>(i), h = 1e-4;
    const Eigen::Vector3d acceleration =
        (position(t + h) - 2.0 * position(t) + position(t - h)) / (h * h);
    const Eigen::Vector3d angles =
        kTurn * Eigen::Vector3d(std::sin(0.5 * t), std::sin(0.8 * t + 1.0), std::cos(0.6 * t));
    const Eigen::Vector3d force = kMass * (rotation_from_euler(angles).transpose() *
                                           (Eigen::Vector3d(0.0, 0.0, -9.81) - acceleration));
    table.values.row(i) << t, position(t).transpose(), angles.transpose(),
        force[0] + 0.3 + noise(random), force[1] - 0.2 + noise(random),
        force[2] + 0.1 + noise(random);
  }
  check::Declared declared;
  declared.model = ToolModel();
  declared.model->mass = kMass;
  const check::Report report = check::check(check::make_log("tremor.csv", table, declared));
  EXPECT_TRUE(report.faults.empty()) << check::to_text(report);
}

// A robot that turns its wrist about one point: columns that never vary are in no order.
TEST(CleanLogs, PosesAboutOnePointAreNoMotion) {
  Table table{{"x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"}, Eigen::MatrixXd(50, 9)};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::uniform_real_distribution<double> angle(-1.0, 1.0);
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const Eigen::Vector3d angles(angle(random), angle(random), angle(random));
    const Eigen::Vector3d force =
        rotation_from_euler(angles).transpose() * Eigen::Vector3d(0.0, 0.0, -9.81);
    table.values.row(i) << 0.37, 0.5, -0.69, angles.transpose(), force[0] + noise(random),
        force[1] + noise(random), force[2] + noise(random);
  }
  check::Declared declared;
  declared.model = ToolModel();
  declared.model->mass = 1.0;
  const check::Log log = check::make_log("poses.csv", table, declared);
  EXPECT_FALSE(log.smooth);
  const check::Report report = check::check(log);
  EXPECT_TRUE(report.faults.empty()) << check::to_text(report);
}

// A list of poses without a clock, several rows of each: nothing is held at a rate.
TEST(CleanLogs, RowsOfOnePoseAfterAnotherAreNotHeld) {
  constexpr Eigen::Index kPoses = 200, kRowsEach = 5;
  Table table{{"q_1", "tau_1"}, Eigen::MatrixXd(kPoses * kRowsEach, 2)};
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double q = 0.01 * static_cast<double>(i / kRowsEach);
    const bool again = i % kRowsEach > 1;  // the first row of a pose is logged while it settles
    table.values.row(i) << q,
        again ? double(table.values(i - 1, 1)) : 0.4 * std::sin(q) + noise(random);
  }
  const check::Report report = check::check(check::make_log("poses.csv", table, {}));
  for (const check::Fault& fault : report.faults) EXPECT_NE(fault.id, "held") << fault.words;
}

// Values that are new in any row with the same chance: of the lengths for which they stand one is
// always the most frequent.
TEST(CleanLogs, ValuesThatAreNewNowAndThenAreNotHeld) {
  constexpr Eigen::Index kReadings = 800;
  int held = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> value;
    std::bernoulli_distribution is_new(1.0 / 20.0);
    Table table{{"t", "fx"}, Eigen::MatrixXd(kReadings, 2)};
    double fx = 0.0;
    for (Eigen::Index i = 0; i < kReadings; ++i) {
      if (is_new(random)) fx = std::round(1e4 * value(random)) / 1e4;
      table.values.row(i) << 0.01 * static_cast<double>(i), fx;
    }
    const check::Log log = check::make_log("now_and_then.csv", table, {});
    held += check::held_of(log, {"fx"}).probability >= check::kLikely;
  }
  EXPECT_EQ(held, 0);
}

// Forty milliseconds of a motion are no list of poses: nothing is fitted to them.
TEST(CleanLogs, TwentyRowsOfAMotionAreTooShortForATool) {
  const check::Log log = slow_log(4000, 0.002, 0.6);
  Table table = log.table;
  table.values = Eigen::MatrixXd(log.table.values.topRows(20));
  check::Declared declared;
  declared.model = ToolModel();
  declared.model->mass = 1.05;
  const check::Report report = check::check(check::make_log("short.csv", table, declared));
  ASSERT_EQ(report.notes.size(), 1U) << check::to_text(report);
  EXPECT_EQ(report.notes[0].find("too short to fit a rigid tool"), 0U) << report.notes[0];
  EXPECT_TRUE(report.measured.empty());
}

// A press of five rows is sharp beside the sensor's noise, and no single row is off.
TEST(CleanLogs, ShortPressesAreNoSpikes) {
  const check::Log log = slow_log(4000, 0.01, 0.6);
  Table table = log.table;
  for (Eigen::Index peak = 300; peak < 3900; peak += 400) {
    for (Eigen::Index k = -3; k <= 3; ++k) {
      table.values(peak + k, 9) += 3.0 * (1.0 + std::cos(static_cast<double>(k)));
    }
  }
  const check::Report report = check::check(check::make_log("presses.csv", table, log.declared));
  for (const check::Fault& fault : report.faults) EXPECT_NE(fault.id, "spikes") << fault.words;
}

TEST(CleanLogs, AForceThatIsNoToolsIsSaid) {
  check::Log log = slow_log(4000, 0.004, 0.6);
  EXPECT_TRUE(check::check(log).notes.empty());
  Table table = log.table;
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double s = static_cast<double>(i) / 4000.0;
    for (Eigen::Index j = 7; j < 10; ++j) {
      table.values(i, j) += 30.0 * std::sin((40.0 + 7.0 * static_cast<double>(j)) * s);
    }
  }
  const check::Report report = check::check(check::make_log("pressed.csv", table, log.declared));
  ASSERT_FALSE(report.notes.empty());
  EXPECT_NE(report.notes[0].find("no rigid tool's"), std::string::npos) << report.notes[0];
}

// Pushes in nearly half of the rows; in the others next to nothing is left of a weight, with the
// wrong sign, as where a controller has subtracted a little too much.
TEST(CleanLogs, AForceThatIsMostlyNoToolsTellsNoSign) {
  const check::Log log = slow_log(4000, 0.01, 0.6);
  Table table = log.table;
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const Eigen::Index phase = i % 500;
    for (Eigen::Index j = 7; j < 10; ++j) {
      const auto axis = static_cast<double>(j - 7);
      table.values(i, j) *= -0.1;
      if (phase < 225) {
        table.values(i, j) +=
            30.0 * std::sin(0.013 * static_cast<double>(phase) * (axis + 1.0) + axis);
      }
    }
  }
  const check::Report report = check::check(check::make_log("pushed.csv", table, {}));
  ASSERT_FALSE(report.notes.empty());
  for (const check::Fault& fault : report.faults) EXPECT_NE(fault.id, "reaction") << fault.words;
}

// Its weight is a constant then, which an offset explains as well: no reason to say that it is
// gone.
TEST(CleanLogs, AToolThatHardlyTurnsIsNotCompensated) {
  for (const double turn : {0.003, 0.01, 0.03}) {
    const check::Report report = check::check(slow_log(4000, 0.004, turn));
    EXPECT_EQ(report.stopping({"no_motion"}), nullptr) << turn << "\n" << check::to_text(report);
  }
}

/// Two joints with friction, called as dcnn-import calls them; the drive of the second reads the
/// other way round, and `scale` is what its description says.
check::Report two_joints(double scale, bool described) {
  Table table{{"t", "q_elbow", "tau_elbow", "q_wrist", "tau_wrist"}, Eigen::MatrixXd(6000, 5)};
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double t = 0.005 * static_cast<double>(i);
    const auto torque = [&](double v) { return 0.5 * std::tanh(v / 0.01) + v + noise(random); };
    table.values.row(i) << t, std::sin(1.3 * t), torque(1.3 * std::cos(1.3 * t)), std::sin(0.9 * t),
        -torque(0.9 * std::cos(0.9 * t));
  }
  check::Declared declared;
  if (described) {
    Json axes = Json::array();
    for (const char* name : {"elbow", "wrist"}) {
      axes.push_back({{"name", name},
                      {"measured", std::string("tau_") + name},
                      {"unit", "N*m"},
                      {"scale", name == std::string("wrist") ? scale : 1.0},
                      {"position", std::string("q_") + name},
                      {"base", Json::array()}});
    }
    declared.system = parse_system(Json{{"kind", "axes"}, {"axes", axes}}, "system.json");
  }
  return check::check(check::make_log("arm.csv", table, declared));
}

TEST(CleanLogs, ATorqueWhoseScaleSaysItsSignHasTheRightOne) {
  for (const bool described : {true, false}) {
    const check::Report wrong = two_joints(1.0, described);
    ASSERT_NE(wrong.stopping({}), nullptr) << check::to_text(wrong);
    EXPECT_EQ(wrong.stopping({})->id, "power_sign");
    EXPECT_EQ(wrong.stopping({})->channel, "tau_wrist");
  }
  const check::Report right = two_joints(-20.0, true);
  EXPECT_EQ(right.stopping({}), nullptr) << check::to_text(right);
}

// An elbow swings on a shoulder whose drive holds it softly: the shoulder's torque takes out for
// long what power the elbow puts in.
TEST(CleanLogs, AJointThatAnotherOneDrivesHasTheRightSign) {
  constexpr double kStep = 0.002, kStiffness = 20.0, kDamping = 3.0;
  constexpr double kOwn = 0.9, kBoth = 0.35, kElbow = 0.3;  // inertia of the pair [kg m²]
  Table table{{"t", "q_1", "tau_1", "q_2", "tau_2"}, Eigen::MatrixXd(8000, 5)};
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.01);
  double q1 = 0.2, v1 = 0.0;
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double t = kStep * static_cast<double>(i);
    const double q2 = 0.8 * std::sin(5.0 * t) + 0.5 * std::sin(3.1 * t),
                 v2 = 4.0 * std::cos(5.0 * t) + 1.55 * std::cos(3.1 * t),
                 a2 = -20.0 * std::sin(5.0 * t) - 4.805 * std::sin(3.1 * t);
    const double tau1 = -kStiffness * q1 - kDamping * v1;
    const double inertia = kOwn + 2.0 * kBoth * std::cos(q2),
                 transmitted = kElbow + kBoth * std::cos(q2);
    const double coriolis = -kBoth * std::sin(q2) * (2.0 * v1 * v2 + v2 * v2);
    const double a1 = (tau1 - transmitted * a2 - coriolis - 0.1 * v1) / inertia;
    const double tau2 = transmitted * a1 + kElbow * a2 + kBoth * std::sin(q2) * v1 * v1 + 0.05 * v2;
    table.values.row(i) << t, q1, tau1 + noise(random), q2, tau2 + noise(random);
    v1 += kStep * a1;
    q1 += kStep * v1;
  }
  const check::Report report = check::check(check::make_log("driven.csv", table, {}));
  for (const check::Fault& fault : report.faults) EXPECT_NE(fault.id, "power_sign") << fault.words;
}

// Three joints for 7 s, of whose torques much is no column of the check: gravity of sums of angles,
// inertia that depends on them.
TEST(CleanLogs, JointsOfWhichMuchIsNotDescribedHaveTheRightSigns) {
  constexpr double kPi = 3.14159265358979;
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int log = 0; log < 30; ++log) {
    Table table{{"t", "q_1", "q_2", "q_3", "tau_1", "tau_2", "tau_3"}, Eigen::MatrixXd(700, 7)};
    std::array<std::array<double, 10>, 3> sizes;
    for (auto& joint : sizes) {
      for (double& size : joint) size = 0.35 * normal(random);
    }
    for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
      const double t = 0.01 * static_cast<double>(i);
      std::array<double, 3> q{}, v{}, a{};
      for (std::size_t j = 0; j < 3; ++j) {
        for (int k = 1; k <= 5; ++k) {
          const double w = 0.2 * kPi * k;
          const double s = sizes[j][std::size_t(2 * k - 2)] / k,
                       c = sizes[j][std::size_t(2 * k - 1)] / k;
          q[j] += s * std::sin(w * t) + c * std::cos(w * t);
          v[j] += w * (s * std::cos(w * t) - c * std::sin(w * t));
          a[j] -= w * w * (s * std::sin(w * t) + c * std::cos(w * t));
        }
      }
      table.values(i, 0) = t;
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t o = (j + 1) % 3;
        const auto column = static_cast<Eigen::Index>(j);
        table.values(i, 1 + column) = q[j];
        table.values(i, 4 + column) = 0.3 * a[j] + 2.0 * v[j] + 4.0 * std::cos(q[j] + q[o]) +
                                      0.6 * std::cos(q[o] - q[j]) * a[o] + 0.02 * normal(random);
      }
    }
    const check::Report report = check::check(check::make_log("arm.csv", table, {}));
    for (const check::Fault& fault : report.faults)
      EXPECT_NE(fault.id, "power_sign") << fault.words;
  }
}

// The current of a drive that can only pull, with rare jolts from its controller.
TEST(CleanLogs, AReadingThatIsCutOffAtZeroHasNoDropouts) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int log = 0; log < 20; ++log) {
    Table table{{"t", "q_1", "tau_1"}, Eigen::MatrixXd(3000, 3)};
    for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
      const double t = 0.005 * static_cast<double>(i), phase = 2.0 * t + 0.1 * t * t;
      const double n = normal(random), jolt = 4.0 * n * n * n * std::abs(n);
      const double pull = 60.0 + 80.0 * std::cos(phase) + jolt;
      table.values.row(i) << t, 5.0 * std::sin(phase), std::max(0.0, std::round(pull));
    }
    const check::Report report = check::check(check::make_log("pull.csv", table, {}));
    for (const check::Fault& fault : report.faults) EXPECT_NE(fault.id, "dropouts") << fault.words;
  }
}

// A joint whose encoder begins anew after each turn, at 1 rad/s: two jumps in 15 s.
TEST(CleanLogs, AJointThatBeginsAnewAfterATurnWraps) {
  Table table{{"t", "q_1", "qd_1", "tau_1"}, Eigen::MatrixXd(3000, 4)};
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double t = 0.005 * static_cast<double>(i);
    table.values.row(i) << t, std::fmod(1.4 + t, 6.283185307179586), 1.0 + noise(random),
        0.5 + noise(random);
  }
  const check::Report report = check::check(check::make_log("turns.csv", table, {}));
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "wrap") << check::to_text(report);
  EXPECT_GE(report.faults[0].probability, check::kLikely);
}

/// A motor's shaft at `speed` [rad/s].
check::Report shaft(double speed) {
  Table table{{"t", "q_1", "tau_1"}, Eigen::MatrixXd(4000, 3)};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const double t = 0.005 * static_cast<double>(i);
    table.values.row(i) << t, speed * t - std::cos(t), 0.3 + 0.2 * std::cos(t) + noise(random);
  }
  return check::check(check::make_log("shaft.csv", table, {}));
}

// The size of an angle that only grows tells no unit: no cable goes round with a motor.
TEST(CleanLogs, AShaftThatTurnsAndTurnsIsNotInDegrees) {
  for (const double speed : {30.0, 200.0}) {
    const check::Report report = shaft(speed);
    EXPECT_EQ(report.stopping({}), nullptr) << check::to_text(report);
  }
}

}  // namespace
}  // namespace dcnn
