// SPDX-License-Identifier: Apache-2.0
// Axes whose motion is read by an encoder: its steps, differentiated, are noise of the prediction.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/periodograms.h"
#include "support/process.h"

namespace dcnn {
namespace {

constexpr double kRow = 1.0 / 250.0, kOwnInertia = 0.2, kReadingNoise = 0.02;  // s, kg m^2, N m

struct JointMotion {
  double q, v, a;
};
using Path = std::function<JointMotion(double)>;
using Rubbing = std::function<double(const JointMotion&)>;

/// There and back at a constant speed [rad/s], turned around within `turn` seconds.
Path to_and_fro(double speed, double half, double turn) {
  return [=](double t) {
    const double phase = std::fmod(t, 2.0 * half), back = phase < half ? 1.0 : -1.0;
    const double into = std::fmod(phase, half) - 0.5 * half, edge = 0.5 * (half - turn);
    if (std::abs(into) < edge) return JointMotion{back * speed * into, back * speed, 0.0};
    // A half sine of the speed's turn about the ends.
    const double side = into > 0.0 ? 1.0 : -1.0, past = std::abs(into) - edge;
    const double w = std::numbers::pi / turn;
    return JointMotion{back * side * speed * (edge + std::sin(w * past) / w),
                       back * speed * std::cos(w * past),
                       -back * side * speed * w * std::sin(w * past)};
  };
}

/// Sines whose sizes fall with the square of their frequencies.
Path swinging(double first_hz) {
  return [=](double t) {
    JointMotion m{};
    for (int k = 1; k < 5; ++k) {
      const double w = 2.0 * std::numbers::pi * first_hz * k * k, size = 0.5 / (k * k);
      m.q += size * std::sin(w * t + k), m.v += size * w * std::cos(w * t + k);
      m.a -= size * w * w * std::sin(w * t + k);
    }
    return m;
  };
}

struct Recorded {
  Path path;
  double seconds, step;  ///< [s]; of the encoder [rad]
};

/// The motion as the encoder reads it, a drive's torque (inertia, `rubbing`, noise), and what a
/// simulator that knows the inertia says.
Table recorded(const Recorded& what, const Rubbing& rubbing, std::uint64_t seed) {
  Rng rng({seed});
  Table table;
  table.columns = {"t", "pos", "torque", "simulated"};
  table.values.resize(std::llround(what.seconds / kRow), 4);
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double t = static_cast<double>(k) * kRow;
    const JointMotion m = what.path(t);
    const double known = kOwnInertia * m.a;
    table.values.row(k) << t, what.step * std::round(m.q / what.step),
        known + rubbing(m) + kReadingNoise * rng.normal(), known;
  }
  return table;
}

class Encoder {
 public:
  Encoder(const Recorded& fit, const Recorded& hold, const Rubbing& rubbing) {
    write_csv(folder_ / "fit.csv", recorded(fit, rubbing, 1));
    write_csv(folder_ / "hold.csv", recorded(hold, rubbing, 2));
  }
  DiagnosisRequest request(const Json& simulator, const char* unit = "rad") const {
    Json axis{{"name", "joint"},
              {"measured", "torque"},
              {"unit", "N*m"},
              {"position_unit", unit},
              {"position", "pos"}};
    axis.update(simulator);
    write_file(folder_ / "system.json",
               Json{{"kind", "axes"}, {"axes", Json::array({axis})}}.dump());
    DiagnosisRequest request;
    request.system = folder_ / "system.json";
    request.fit = {folder_ / "fit.csv"};
    request.holdout = {folder_ / "hold.csv"};
    return request;
  }
  Json report(const Json& simulator, const char* unit = "rad") const {
    return diagnose(request(simulator, unit), nullptr).report;
  }
  std::filesystem::path operator/(const char* name) const { return folder_ / name; }

 private:
  test::TemporaryFolder folder_;
};

const Json kFittedInertia{{"base", Json::array({"acceleration"})}};
const Json kSimulated{{"simulated", "simulated"}};

std::vector<std::string> names_in(const Json& report) {
  std::vector<std::string> names;
  for (const Json& f : report["findings"]) names.push_back(f["effect"]);
  std::sort(names.begin(), names.end());
  return names;
}

// White noise s of a position, twice differentiated behind a filter H: (J w^2 |H|)^2 s^2.
TEST(PositionNoise, HasTheDensityOfTheFilteredSecondDerivative) {
  const double step = 1e-3;  // rad: coarse, so that its error is white
  const Encoder bench({swinging(0.1), 60.0, step}, {swinging(0.1), 10.0, step},
                      [](const JointMotion&) { return 0.0; });
  LoadedAxes axes = load_axes(bench.request(kFittedInertia));
  Case& study = axes.cases.front().fit;
  set_base(study, Eigen::VectorXd::Constant(1, kOwnInertia));
  std::vector<Floor> floors(1);
  floors[0].dt = kRow;
  const Signals loud(1, Eigen::MatrixXd::Random(study.logs.front().motion.samples(), 1));
  add_position_noise(study, {}, loud, floors);
  for (const double hz : {3.0, 6.0, 12.0}) {
    const double w = 2.0 * std::numbers::pi * hz;
    const double edge = 1.0 / (1.0 + std::pow(hz / study.derivative.cutoff_hz, 8.0));
    const double expected = std::pow(kOwnInertia * w * w * edge, 2) * step * step / 12.0;
    double drawn = 0.0;  // mean of the bins near it: one draw has 10 windows and more
    for (const double near : {0.9, 0.95, 1.0, 1.05, 1.1})
      drawn += floors[0].pose_density(near * hz);
    EXPECT_NEAR(std::log(drawn / 5.0 / expected), 0.0, 0.35) << hz;
  }
}

// Of a motion that an encoder of coarse steps reads, with turns faster than the smoother passes:
// what is derived from it errs, and nothing is missing.
TEST(DiagnoseEncoder, StepsOfAnEncoderAreNoLaw) {
  const Recorded log{to_and_fro(1.5, 0.9037, 0.12), 20.0, 1e-4};
  const Json none =
      Encoder(log, log, [](const JointMotion&) { return 0.0; }).report(kFittedInertia);
  EXPECT_EQ(none["verdict"], "consistent") << none["unnamed"].dump(1);
  EXPECT_TRUE(none["findings"].empty()) << none["findings"].dump(1);
  const Json viscous =
      Encoder(log, log, [](const JointMotion& m) { return 0.2 * m.v; }).report(kFittedInertia);
  EXPECT_EQ(viscous["verdict"], "explained") << viscous["unnamed"].dump(1);
}

// Of held-out recordings of a few seconds the ends are no part, and fewer windows fit into the
// rest.
TEST(DiagnoseEncoder, ShortRecordingsHaveAVerdict) {
  for (const double seconds : {3.0, 5.0, 8.0}) {
    const Recorded log{swinging(0.4), seconds, 1e-4};
    const Encoder bench(log, log, [](const JointMotion& m) { return 0.3 * m.v; });
    const Json report = bench.report(kFittedInertia);
    EXPECT_EQ(names_in(report), std::vector<std::string>{"viscous_friction"}) << seconds;
  }
}

// Fitted where motion is slow, whose own noise wants a low cut-off, and held out where it is fast.
TEST(DiagnoseEncoder, AFasterMotionPassesTheSmoother) {
  const Encoder bench({swinging(0.07), 40.0, 1e-5}, {swinging(0.25), 20.0, 1e-5},
                      [](const JointMotion& m) { return 0.3 * m.v; });
  const Json report = bench.report(kFittedInertia);
  EXPECT_EQ(names_in(report), std::vector<std::string>{"viscous_friction"});
  EXPECT_EQ(report["verdict"], "explained") << report["unnamed"].dump(1);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 1.3 * kReadingNoise);
}

// A linear motor's poles: 80 mm apart, 13 of them in the range, an order of 79 per m.
TEST(DiagnoseEncoder, NamesTheCoggingOfALinearMotor) {
  const Recorded log{swinging(0.12), 30.0, 1e-6};
  const Encoder bench(log, log, [](const JointMotion& m) { return 0.1 * std::sin(78.5 * m.q); });
  const Json report = bench.report(kFittedInertia, "m");
  ASSERT_EQ(names_in(report), std::vector<std::string>{"cogging"}) << report["findings"].dump(1);
  EXPECT_NEAR(report["findings"][0]["parameters"]["order"]["value"].get<double>(), 78.5, 0.3);
}

// At a constant speed to and fro a friction is the integral of the inertial torque, as that of a
// sensor which creeps to sixty times its reading would be.
TEST(DiagnoseEncoder, NoSensorCreepsToSixtyTimesItsReading) {
  const Recorded log{to_and_fro(2.0, 1.6, 0.15), 15.0, 1e-6};
  const Encoder bench(log, log,
                      [](const JointMotion& m) { return 0.2 + (m.v > 0.0 ? 0.2 : -0.2); });
  const Json report = bench.report(kSimulated);
  EXPECT_EQ(report["findings"].size(), 2U) << report["findings"].dump(1);
  for (const auto* list : {"findings", "refuted"}) {
    for (const Json& name : report[list]) EXPECT_NE(name["effect"], "creep") << report.dump(1);
  }
}

// A motion that repeats leaves lines, beside what is missing too; none of them is a hum.
TEST(DiagnoseEncoder, ADelayInAMotionThatRepeatsIsNoHum) {
  const Path path = to_and_fro(1.5, 0.4, 0.03);
  const Recorded log{path, 30.0, 1e-6}, other{swinging(0.3), 20.0, 1e-6};
  const Encoder bench(log, other, [](const JointMotion&) { return 0.0; });
  for (const char* name : {"fit.csv", "hold.csv"}) {
    Table table = read_csv(bench / name);
    const Eigen::VectorXd simulated = table.values.col(3);
    Rng rng({3});
    for (Index k = 0; k < table.values.rows(); ++k) {
      table.values(k, 2) = simulated(std::max<Index>(0, k - 3)) + kReadingNoise * rng.normal();
    }
    write_csv(bench / name, table);
  }
  const Json report = bench.report(kSimulated);
  EXPECT_EQ(names_in(report), std::vector<std::string>{"time_delay"}) << report.dump(1);
}

// One row far off says nothing of whether the reading drives the axis or resists it.
TEST(DiagnoseEncoder, ASpikeDoesNotTurnTheReading) {
  const Recorded log{swinging(0.12), 20.0, 1e-6};
  const Encoder bench(log, log, [](const JointMotion& m) { return 0.3 * std::tanh(m.v / 0.02); });
  Table table = read_csv(bench / "fit.csv");
  Index fastest = 0;
  const Eigen::VectorXd q = table.values.col(1);
  (q.tail(q.size() - 1) - q.head(q.size() - 1)).maxCoeff(&fastest);
  table.values(fastest, 2) -= 4000.0;
  write_csv(bench / "fit.csv", table);
  const Json report = bench.report(kSimulated);
  EXPECT_EQ(names_in(report), std::vector<std::string>{"coulomb_friction"}) << report.dump(1);
}

// Where all that is simulated is inertia, a fifth more of the one is a fifth more of the other;
// that the acceleration comes from an encoder, and the simulated torque from elsewhere, tells
// nothing.
TEST(DiagnoseEncoder, AScaleOfInertiaMayBeMoreInertia) {
  const Recorded log{swinging(0.12), 15.0, 1e-4};
  const Encoder bench(log, log,
                      [](const JointMotion& m) { return 0.2 * kOwnInertia * m.a + 0.3 * m.v; });
  const Json report = bench.report(kSimulated);
  ASSERT_EQ(report["findings"].size(), 2U) << report["findings"].dump(1);
  std::set<std::string> either;
  for (const Json& finding : report["findings"]) {
    if (finding["effect"] == "viscous_friction") continue;
    either.insert(finding["effect"]);
    for (const Json& other : finding["alternatives"]) either.insert(other);
  }
  EXPECT_EQ(either, (std::set<std::string>{"gain", "inertia"})) << report["findings"].dump(1);
}

/// A position beside two readings of its motion.
Table two_readings(const Recorded& what, const std::function<double(double)>& first,
                   const std::function<double(double)>& second) {
  Table table;
  table.columns = {"t", "pos", "first", "second"};
  table.values.resize(std::llround(what.seconds / kRow), 4);
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double t = static_cast<double>(k) * kRow;
    table.values.row(k) << t, what.path(t).q, first(t), second(t);
  }
  return table;
}

// The same joint on a second encoder, 8 ms later, beside noise; or its rate on a gyroscope.
TEST(DiagnoseEncoder, ASecondReadingOfTheMotionIsLateAndHasNoFriction) {
  const Recorded log{swinging(0.12), 15.0, 1e-4};
  const Encoder bench(log, log, [](const JointMotion&) { return 0.0; });
  for (const bool rate : {false, true}) {
    for (const char* name : {"fit.csv", "hold.csv"}) {
      Rng rng({7u});
      const auto reading = [&](double t) { return rate ? log.path(t).v : log.path(t).q; };
      write_csv(bench / name, two_readings(log, reading, [&](double t) {
                  return reading(t - 0.008) + 1e-3 * rng.normal();
                }));
    }
    const Json report = bench.report(
        Json{{"measured", "second"}, {"unit", rate ? "rad/s" : "rad"}, {"simulated", "first"}});
    EXPECT_EQ(names_in(report), std::vector<std::string>{"time_delay"})
        << report["findings"].dump(1);
    EXPECT_EQ(report["verdict"], "explained");
  }
}

/// One frequency, as sines are tested with.
Path waving(double hz, double speed) {
  return [=](double t) {
    const double w = 2.0 * std::numbers::pi * hz;
    return JointMotion{speed / w * std::sin(w * t), speed * std::cos(w * t),
                       -speed * w * std::sin(w * t)};
  };
}

// A scale and a delay of a gyroscope that swings at 3 Hz: there they are a resonance, or a spring,
// as well; at 5 Hz, held out, they are not.
TEST(DiagnoseEncoder, AGainAndADelayOfOneFrequencyAreNoResonance) {
  const Recorded fit{waving(3.0, 2.0), 12.0, 1e-5}, hold{waving(5.0, 2.0), 12.0, 1e-5};
  const Encoder bench(fit, hold, [](const JointMotion&) { return 0.0; });
  for (const char* name : {"fit.csv", "hold.csv"}) {
    const Recorded& log = std::string(name) == "fit.csv" ? fit : hold;
    Rng rng({11u});
    const auto rate = [&](double t) { return log.path(t).v; };
    write_csv(bench / name, two_readings(log, rate, [&](double t) {
                return 0.85 * rate(t - 0.007) - 0.045 + 0.03 * rng.normal();
              }));
  }
  const Json report =
      bench.report(Json{{"measured", "second"}, {"unit", "rad/s"}, {"simulated", "first"}});
  EXPECT_EQ(names_in(report), (std::vector<std::string>{"bias", "gain", "time_delay"}))
      << report["findings"].dump(1);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 0.036);
}

/// What nothing describes: forty waves between 0.5 and 8 Hz, rms 1.
double waves(double t, std::uint64_t seed) {
  Rng rng({seed});
  double sum = 0.0;
  for (int k = 0; k < 40; ++k) {
    const double hz = 0.5 + 7.5 * rng.uniform(), phase = 2.0 * std::numbers::pi * rng.uniform();
    sum += std::sin(2.0 * std::numbers::pi * hz * t + phase) / std::sqrt(20.0);
  }
  return sum;
}

// No simulator of a machine is exact: what it leaves within 0.3 % of the reading is nothing.
TEST(DiagnoseEncoder, WhatIsWithinTheErrorOfAnySimulatorIsNothing) {
  for (const double share : {0.002, 0.02}) {
    const Recorded log{swinging(0.3), 20.0, 1e-7};
    const Encoder bench(log, log, [](const JointMotion&) { return 0.0; });
    std::uint64_t seed = 1;
    for (const char* name : {"fit.csv", "hold.csv"}) {
      Table table = read_csv(bench / name);
      const double rms = table.values.col(3).norm() / std::sqrt(double(table.values.rows()));
      Rng rng({seed});
      for (Index k = 0; k < table.values.rows(); ++k) {
        const double left = share * waves(table.values(k, 0), seed) + 1e-4 * rng.normal();
        table.values(k, 2) = table.values(k, 3) + rms * left;
      }
      write_csv(bench / name, table);
      ++seed;
    }
    const Json report = bench.report(kSimulated);
    EXPECT_EQ(report["verdict"], share < 0.003 ? "consistent" : "unexplained") << report.dump(1);
  }
}

}  // namespace
}  // namespace dcnn
