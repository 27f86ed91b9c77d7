// SPDX-License-Identifier: Apache-2.0
// The diagnosis of axes of other machines, on axes simulated here.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "dcnn/physics/axis_machine.h"
#include "support/process.h"

namespace dcnn {
namespace {

constexpr double kAxisRate = 250.0, kAxisNoise = 0.05, kInertia = 3.0;

struct State {
  double t, q, v, a;
};

/// What the drive shows beside the inertia.
using Law = std::function<double(const State&)>;

State state_at(double t) {
  State s{t, 0.0, 0.0, 0.0};
  const double hz[] = {0.11, 0.27, 0.53, 0.97};
  for (int k = 0; k < 4; ++k) {
    const double w = 2.0 * std::numbers::pi * hz[k], phase = 1.3 * k * k, size = 0.3 / (1 + k);
    s.q += size * std::sin(w * t + phase);
    s.v += size * w * std::cos(w * t + phase);
    s.a -= size * w * w * std::sin(w * t + phase);
  }
  return s;
}

void write_log(const std::filesystem::path& path, double begin, const Law& law,
               std::uint64_t seed) {
  constexpr Index kSamples = 5000;
  Rng rng({seed});
  Table table;
  table.columns = {"t", "pos", "vel", "acc", "torque", "simulated"};
  table.values.resize(kSamples, 6);
  for (Index k = 0; k < kSamples; ++k) {
    const State s = state_at(begin + static_cast<double>(k) / kAxisRate);
    const double torque = kInertia * s.a + law(s) + kAxisNoise * rng.normal();
    table.values.row(k) << s.t, s.q, s.v, s.a, torque, kInertia * s.a;
  }
  write_csv(path, table);
}

/// One axis with a hidden law, in a folder of its own.
class AxisBench {
 public:
  explicit AxisBench(const Law& law) {
    write_log(folder_ / "fit.csv", 0.0, law, 1);
    write_log(folder_ / "hold.csv", 25.0, law, 2);
  }
  Diagnosis diagnose(Json system) const {
    write_file(folder_ / "system.json", system.dump());
    DiagnosisRequest request;
    request.system = folder_ / "system.json";
    request.fit = {folder_ / "fit.csv"};
    request.holdout = {folder_ / "hold.csv"};
    return dcnn::diagnose(request, nullptr);
  }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  test::TemporaryFolder folder_;
};

Json one_axis(const Json& more = {{"base", Json::array({"acceleration"})}}) {
  Json axis{{"name", "wheel"},   {"measured", "torque"}, {"unit", "N*m"},
            {"position", "pos"}, {"velocity", "vel"},    {"acceleration", "acc"}};
  axis.update(more);
  return {{"kind", "axes"}, {"axes", Json::array({axis})}};
}

const Json* find(const Json& report, const std::string& effect) {
  for (const Json& f : report["findings"]) {
    if (f["effect"] == effect) return &f;
  }
  return nullptr;
}

/// The finding's number, with its unit checked.
double number(const Json& finding, const char* name, const char* unit) {
  EXPECT_EQ(finding["parameters"][name]["unit"], unit) << finding.dump();
  const auto interval = finding["parameters"][name]["ci95"].get<std::vector<double>>();
  EXPECT_LT(interval[0], interval[1]);
  return finding["parameters"][name]["value"];
}

/// Of fit.csv and hold.csv in a folder, whose only axis has these keys, a position q beside them.
Json report_of_axis(const test::TemporaryFolder& folder, Json axis, double lowpass_hz = 0.0) {
  axis["position"] = "q";
  const Json system{
      {"kind", "axes"}, {"lowpass_hz", lowpass_hz}, {"axes", Json::array({std::move(axis)})}};
  write_file(folder / "system.json", system.dump());
  DiagnosisRequest request;
  request.system = folder / "system.json";
  request.fit = {folder / "fit.csv"};
  request.holdout = {folder / "hold.csv"};
  return diagnose(request, nullptr).report;
}

TEST(DiagnoseAxes, SaysThatNothingIsMissing) {
  const Json report = AxisBench([](const State&) { return 0.0; }).diagnose(one_axis()).report;
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"].dump(1);
  EXPECT_EQ(report["targets"], Json::array({"torque"}));
  EXPECT_EQ(report["units"], Json::array({"N*m"}));
  EXPECT_NEAR(report["fit"]["noise_floor"][0].get<double>(), kAxisNoise, 0.005);
  EXPECT_NEAR(report["fit"]["holdout_rmse_after"][0].get<double>(), kAxisNoise, 0.003);
}

// One slow turn: friction that grows with the distance from the rest looks like slow noise in time,
// and a product of what moves explains it far better.
TEST(DiagnoseAxes, FrictionThatGrowsWithThePositionIsNoColourOfNoise) {
  const test::TemporaryFolder folder;
  Rng rng({31});
  Table table;
  table.columns = {"t", "q", "I"};
  for (const auto& [name, from, rows] :
       {std::tuple{"fit.csv", 0.0, Index{700}}, {"hold.csv", 70.0, Index{470}}}) {
    table.values.resize(rows, 3);
    for (Index k = 0; k < rows; ++k) {
      const double t = from + 0.1 * static_cast<double>(k),
                   phase = 2.0 * std::numbers::pi * t / 117.0;
      const double q = 0.59 * std::sin(phase), v = std::cos(phase);
      const double friction = 92.0 * std::abs(q) * std::tanh(20.0 * v);
      table.values.row(k) << t, q, 33.0 * q + friction + 11.0 * rng.normal();
    }
    write_csv(folder / name, table);
  }
  const Json report = report_of_axis(
      folder, {{"name", "knob"}, {"measured", "I"}, {"unit", "mA"}, {"base", Json::array()}});
  EXPECT_NE(report["verdict"], "explained") << report["findings"].dump(1);
  EXPECT_NE(report["verdict"], "consistent");
}

// Two collisions of 0.4 s hold far more energy than the friction of all seconds.
TEST(DiagnoseAxes, CollisionsDoNotHideFriction) {
  const auto hit = [](double t, double at) {
    if (t < at || t > at + 0.4) return 0.0;
    return 5.0 * std::sin(12.0 * std::numbers::pi * (t - at)) *
           std::sin(std::numbers::pi * (t - at) / 0.4);
  };
  const AxisBench bench([&](const State& s) {
    return 0.12 * std::tanh(s.v / 0.01) + hit(s.t, 4.0) + hit(s.t, 12.0);
  });
  const Json report = bench.diagnose(one_axis()).report;
  EXPECT_EQ(report["verdict"], "explained");
  ASSERT_EQ(report["findings"].size(), 1u) << report["findings"].dump(1);
  const Json* friction = find(report, "coulomb_friction");
  ASSERT_NE(friction, nullptr);
  EXPECT_NEAR(number(*friction, "fc", "N*m"), 0.12, 0.006);
  ASSERT_EQ(report["left_out"].size(), 2u) << report["left_out"].dump(1);
  for (std::size_t k = 0; k < 2; ++k) {
    const Json& ends = report["left_out"][k]["interval_s"];
    EXPECT_LE(ends[0].get<double>(), 4.1 + 8.0 * static_cast<double>(k));
    EXPECT_GE(ends[1].get<double>(), 4.3 + 8.0 * static_cast<double>(k));
    EXPECT_LE(ends[1].get<double>() - ends[0].get<double>(), 2.5);
  }
}

// A push on a drive that commands nothing else: readings that repeat their value tell no noise,
// beside which the push would be a collision.
TEST(DiagnoseAxes, TheOnlyRowsThatSayAnythingAreNoCollision) {
  const test::TemporaryFolder folder;
  Table table;
  table.columns = {"t", "pos", "torque"};
  table.values.resize(3000, 3);
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double t = static_cast<double>(k) / 200.0, torque = t > 5.0 && t < 6.0 ? 6.0 : 0.0;
    table.values.row(k) << t, 5e-6 * std::round(torque / 0.1), torque;
  }
  write_csv(folder / "push.csv", table);
  write_file(folder / "system.json", R"({"kind": "axes", "axes": [{"name": "wheel",
      "measured": "torque", "unit": "N*m", "position": "pos", "base": ["acceleration"]}]})");
  DiagnosisRequest request;
  request.system = folder / "system.json";
  request.fit = {folder / "push.csv"};
  const Json report = diagnose(request, nullptr).report;
  EXPECT_TRUE(report["left_out"].empty()) << report["left_out"].dump(1);
  EXPECT_NE(report["verdict"], "consistent");
}

// Where the base simulator has a constant, a spring's rest is no number of its own: it was fitted
// as the difference of two constants of any size.
TEST(DiagnoseAxes, ASpringBesideAConstantHasNoRest) {
  const AxisBench bench([](const State& s) { return -kInertia * s.a + 1.5 * s.q + 4.0; });
  const Diagnosis diagnosis = bench.diagnose(one_axis({{"base", Json::array()}}));
  const Json& report = diagnosis.report;
  EXPECT_EQ(to_text(diagnosis).find("angle at rest"), std::string::npos) << to_text(diagnosis);
  const Json* spring = find(report, "cable_spring");
  ASSERT_NE(spring, nullptr) << report["findings"].dump(1);
  EXPECT_NEAR(std::abs(number(*spring, "k", "N*m/rad")), 1.5, 0.01);
  EXPECT_EQ((*spring)["parameters"]["rest"]["value"], 0.0);
  // An empty base says that nothing is known: no share of it is held against a simulator.
  EXPECT_TRUE(report["fit"]["holdout_explained_before"][0].is_null()) << report["fit"].dump(1);
}

// Another recording may be noisier: its error is compared with its own noise.
TEST(DiagnoseAxes, ANoisierHeldOutRecordingRefutesNothing) {
  Rng rng({77});
  const AxisBench bench([&](const State& s) {
    const double more = s.t > 24.0 ? 0.17 * rng.normal() : 0.0;
    return 0.8 * std::tanh(s.v / 0.01) + more;
  });
  const Json report = bench.diagnose(one_axis()).report;
  EXPECT_EQ(report["verdict"], "explained") << report["unnamed"].dump(1);
  EXPECT_GT(report["fit"]["holdout_rmse_after"][0].get<double>(), 0.15);
  EXPECT_NEAR(report["fit"]["noise_floor"][0].get<double>(), kAxisNoise, 0.005);
  EXPECT_NEAR(report["fit"]["holdout_noise_floor"][0].get<double>(), 0.18, 0.02);
}

// What was found in other recordings is part of the simulator: the new difference alone is named.
TEST(DiagnoseAxes, TakesACorrectedSimulator) {
  const auto friction = [](const State& s) { return 0.8 * std::tanh(s.v / 0.01); };
  const Json model = AxisBench(friction).diagnose(one_axis()).model;
  const AxisBench later([&](const State& s) { return friction(s) + 1.5 * (s.q - 0.1); });
  const Diagnosis diagnosis = later.diagnose(model);
  const Json& report = diagnosis.report;
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  const Json* spring = find(report, "cable_spring");
  ASSERT_TRUE(spring);
  EXPECT_NEAR(number(*spring, "k", "N*m/rad"), 1.5, 0.05);
  // The model that it writes holds both.
  const AxisMachine both = parse_axis_machine(diagnosis.model, "model", Exit::kModel);
  EXPECT_EQ(both.axes[0].effects.size(), 2U);
  const Recording hold = read_recording(later / "hold.csv", ReadOptions(), both.system);
  const Eigen::VectorXd left = hold.column("torque") - predict_axes(both, hold).col(0);
  EXPECT_LT(std::sqrt(left.squaredNorm() / double(left.size())), 1.05 * kAxisNoise);
}

TEST(DiagnoseAxes, NamesDryFrictionAndAnOffsetWithTheirValues) {
  const AxisBench bench([](const State& s) { return 0.8 * std::tanh(s.v / 0.01) - 0.3; });
  const Diagnosis diagnosis = bench.diagnose(one_axis());
  const Json& report = diagnosis.report;
  EXPECT_EQ(report["verdict"], "explained") << report.dump(1);
  ASSERT_EQ(report["findings"].size(), 2U) << report["findings"].dump(1);
  const Json *dry = find(report, "coulomb_friction"), *offset = find(report, "bias");
  ASSERT_TRUE(dry && offset);
  EXPECT_EQ((*dry)["axis"], "wheel");
  EXPECT_NEAR(number(*dry, "fc", "N*m"), 0.8, 0.02);
  EXPECT_NEAR(number(*dry, "v0", "rad/s"), 0.01, 0.01);
  EXPECT_NEAR(number(*offset, "delta_bias", "N*m"), -0.3, 0.02);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 1.05 * kAxisNoise);
  EXPECT_GT(report["fit"]["holdout_rmse_before"][0].get<double>(), 0.5);

  // model.json alone says what the report's prediction file says.
  write_diagnosis(bench / "out", diagnosis);
  const AxisMachine machine =
      parse_axis_machine(read_json(bench / "out/model.json", Exit::kModel), "model", Exit::kModel);
  const Recording hold = read_recording(bench / "hold.csv", ReadOptions(), machine.system);
  const Table written = read_csv(bench / "out/holdout_0_pred.csv");
  ASSERT_EQ(written.columns, (std::vector<std::string>{"t", "torque"}));
  EXPECT_LT((written.values.col(1) - predict_axes(machine, hold)).cwiseAbs().maxCoeff(), 1e-9);
}

// The same machine logged in another unit of length, or a thousandth of its size: the same name.
TEST(DiagnoseAxes, NamesTheSameInEveryUnit) {
  const AxisBench bench([](const State& s) { return 0.8 * std::tanh(s.v / 0.01) + 0.9 * s.v; });
  for (const double unit : {1e-3, 1e3}) {
    for (const char* file : {"fit.csv", "hold.csv"}) {
      Table table = read_csv(bench / file);
      table.values.middleCols(1, 3) *= unit;
      write_csv(bench / file, table);
    }
    const Json report = bench.diagnose(one_axis()).report;
    ASSERT_EQ(report["findings"].size(), 2U) << report["findings"].dump(1);
    const Json *dry = find(report, "coulomb_friction"), *drag = find(report, "viscous_friction");
    ASSERT_TRUE(dry && drag) << report["findings"].dump(1);
    const double length = unit < 1.0 ? unit : 1.0;  // of a radian, after both
    EXPECT_NEAR(number(*dry, "fc", "N*m"), 0.8, 0.03);
    EXPECT_NEAR(number(*dry, "v0", "rad/s") / length, 0.01, 0.01);
    EXPECT_NEAR(number(*drag, "c", "N*m*s/rad") * length, 0.9, 0.06);
  }
}

TEST(DiagnoseAxes, NamesACubicSpring) {
  const AxisBench bench([](const State& s) { return 0.6 * s.q + 2.0 * s.q * s.q * s.q; });
  const Json report =
      bench.diagnose(one_axis({{"base", {"acceleration", "velocity", "position"}}})).report;
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  const Json* spring = find(report, "cubic_spring");
  ASSERT_TRUE(spring) << report["findings"].dump(1);
  EXPECT_NEAR(number(*spring, "k3", "N*m/rad^3"), 2.0, 0.1);
}

// Far below the band in which a machine's own errors are expected, and above its motion.
TEST(DiagnoseAxes, NamesAHumOfSixHertz) {
  const AxisBench bench(
      [](const State& s) { return kAxisNoise * std::sin(2.0 * std::numbers::pi * 6.05 * s.t); });
  const Json report = bench.diagnose(one_axis()).report;
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  const Json* hum = find(report, "hum");
  ASSERT_TRUE(hum) << report["findings"].dump(1);
  EXPECT_NEAR(number(*hum, "freq", "Hz"), 6.05, 0.01);
}

TEST(DiagnoseAxes, ComparesWithASimulatorsColumn) {
  const AxisBench bench([](const State& s) { return 0.1 * kInertia * s.a + 0.4 * s.v; });
  Json system = one_axis({{"simulated", "simulated"}, {"scale", -2.0}, {"unit", "A"}});
  for (const char* file : {"fit.csv", "hold.csv"}) {  // logged with another sign and scale
    Table table = read_csv(bench / file);
    table.values.col(4) *= -0.5;
    write_csv(bench / file, table);
  }
  const Json report = bench.diagnose(system).report;
  ASSERT_EQ(report["findings"].size(), 2U) << report["findings"].dump(1);
  const Json* friction = find(report, "viscous_friction");
  ASSERT_TRUE(friction);
  // All the simulator says is the inertial torque: its scale or the inertia are the same fault, and
  // friction is what the reading shows beside either.
  EXPECT_TRUE(find(report, "gain") || find(report, "inertia"));
  EXPECT_NEAR(number(*friction, "c", "A*s/rad"), 0.4, 0.004);
}

// A spring that holds back 45 % as much in the held-out recording: there half of the fitted one
// errs more than none, and that the fitted rows are sure of it is no evidence.
TEST(DiagnoseAxes, HeldOutDataDecideMoreThanTheFittedRows) {
  const auto spring = [](double k) { return [k](const State& s) { return k * s.q; }; };
  const AxisBench bench(spring(0.05)), other(spring(0.0225));
  std::filesystem::copy_file(other / "hold.csv", bench / "hold.csv",
                             std::filesystem::copy_options::overwrite_existing);
  const Json report = bench.diagnose(one_axis()).report;
  EXPECT_TRUE(report["findings"].empty()) << report["findings"].dump(1);
  EXPECT_FALSE(report["refuted"].empty());
}

// What rubs is read as it is, however wrong the simulator's scale: it simulates twenty times the
// torque.
TEST(DiagnoseAxes, GivesForcesInUnitsOfTheReadingBesideAScale) {
  const auto simulated = [](double a, double q) { return kInertia * a + 6.0 * std::cos(2.0 * q); };
  const AxisBench bench([&](const State& s) {
    return 0.05 * simulated(s.a, s.q) - kInertia * s.a + 0.8 * std::tanh(s.v / 0.02);
  });
  for (const char* file : {"fit.csv", "hold.csv"}) {
    Table table = read_csv(bench / file);
    for (Index k = 0; k < table.values.rows(); ++k) {
      table.values(k, 5) = simulated(table.values(k, 3), table.values(k, 1));
    }
    write_csv(bench / file, table);
  }
  const Json report = bench.diagnose(one_axis({{"simulated", "simulated"}})).report;
  const Json *friction = find(report, "coulomb_friction"), *gain = find(report, "gain");
  ASSERT_TRUE(friction && gain) << report["findings"].dump(1);
  EXPECT_NEAR(number(*friction, "fc", "N*m"), 0.8, 0.02);
  EXPECT_NEAR(number(*gain, "gain", ""), -0.95, 0.005);
}

// A third of a second, of a motion that turns every half second.
TEST(DiagnoseAxes, NamesADelayOrALeadOfThirtyRowsAndMore) {
  for (const double delay : {0.3, -0.3}) {
    const AxisBench bench(
        [&](const State& s) { return kInertia * (state_at(s.t - delay).a - s.a); });
    const Json report = bench.diagnose(one_axis({{"simulated", "simulated"}})).report;
    const Json* found = find(report, "time_delay");
    ASSERT_TRUE(found) << report["findings"].dump(1);
    EXPECT_NEAR(number(*found, "delay", "s"), delay, 0.005);
    EXPECT_EQ(report["verdict"], "explained");
  }
}

// Beside a base that is fitted, which without the delay is another one: it leaves half of the
// torque, and the friction seems to drive.
TEST(DiagnoseAxes, NamesALongDelayBesideAFittedBase) {
  for (const double delay : {0.3, -0.3, 0.1}) {
    const AxisBench bench([&](const State& s) {
      const State then = state_at(s.t - delay);
      return kInertia * (then.a - s.a) + 6.0 * then.v + std::tanh(then.v / 0.02);
    });
    const Json report =
        bench.diagnose(one_axis({{"base", Json::array({"acceleration", "velocity"})}})).report;
    const Json *found = find(report, "time_delay"), *dry = find(report, "coulomb_friction");
    ASSERT_TRUE(found && dry) << delay << report["findings"].dump(1);
    EXPECT_NEAR(number(*found, "delay", "s"), delay, 0.003);
    EXPECT_NEAR(number(*dry, "fc", "N*m"), 1.0, 0.03);
    EXPECT_EQ(report["findings"].size(), 2U) << report["findings"].dump(1);
    EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 1.1 * kAxisNoise);
  }
}

TEST(DiagnoseAxes, DoesNotNameWhatItDoesNotKnow) {
  const Json report =
      AxisBench([](const State& s) { return 0.7 * std::sin(3.0 * s.q) * s.v * s.a; })
          .diagnose(one_axis())
          .report;
  EXPECT_TRUE(report["verdict"] == "unexplained" || report["verdict"] == "partly-explained")
      << report["verdict"];
  EXPECT_GT(report["unnamed"]["excess_rms"][0].get<double>(), 0.05);
}

/// A law found on an axis, told in its terms; the model that is written predicts what the report
/// says, whether the log shows the drive or the reaction to it.
TEST(DiagnoseAxes, DiscoversAnEddyCurrentBrake) {
  for (const double sense : {1.0, -1.0}) {
    const AxisBench bench([sense](const State& s) {
      const double u = s.v / 0.3;
      const double drive = 1.6 * u / (1.0 + u * u);
      return sense > 0.0 ? drive : -drive - 2.0 * kInertia * s.a;
    });
    const Diagnosis diagnosis = bench.diagnose(one_axis());
    const Json* law = find(diagnosis.report, "discovered");
    ASSERT_TRUE(law) << diagnosis.report["findings"].dump(1);
    EXPECT_EQ((*law)["axis"], "wheel");
    EXPECT_TRUE((*law)["words"].get<std::string>().starts_with(
        "an effort against the motion of wheel, largest at 0.3"))
        << (*law)["words"];
    EXPECT_NEAR(number(*law, "amplitude", "N*m"), 1.6 * sense, 0.05);
    EXPECT_NEAR(number(*law, "scale_1", "rad/s"), 0.3, 0.01);
    const bool tells = diagnosis.report["notes"].dump().find("the reaction") != std::string::npos;
    EXPECT_EQ(tells, sense < 0.0) << diagnosis.report["notes"].dump();
    // Its picture: over the velocity, the law leaves little of what is left without it.
    ASSERT_EQ(diagnosis.portraits.size(), 1U);
    const Portrait& picture = diagnosis.portraits[0];
    EXPECT_NE(picture.x_label.find("velocity"), std::string::npos) << picture.x_label;
    double alone = 0.0, beside = 0.0;
    for (std::size_t k = 0; k < picture.x.size(); ++k) {
      alone += picture.left[k] * picture.left[k];
      beside += (picture.left[k] - picture.law[k]) * (picture.left[k] - picture.law[k]);
    }
    EXPECT_LT(beside, 0.02 * alone);
    EXPECT_LT(diagnosis.report["fit"]["holdout_rmse_after"][0].get<double>(), 1.05 * kAxisNoise);
    const AxisMachine written = parse_axis_machine(diagnosis.model, "model", Exit::kModel);
    const Recording hold = read_recording(bench / "hold.csv", ReadOptions(), written.system);
    const Eigen::VectorXd left = hold.column("torque") - predict_axes(written, hold).col(0);
    EXPECT_LT(std::sqrt(left.squaredNorm() / double(left.size())), 1.05 * kAxisNoise);
  }
}

// Dry friction and a drag that grows slower at speed imitate a root of the speed; one law explains
// more than both.
TEST(DiagnoseAxes, OneLawStandsInThePlaceOfTwoNames) {
  const Json report = AxisBench([](const State& s) {
                        return 2.0 * std::copysign(std::sqrt(std::abs(s.v) / 0.5), s.v);
                      })
                          .diagnose(one_axis())
                          .report;
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  EXPECT_EQ(report["findings"][0]["effect"], "discovered");
  EXPECT_EQ(report["verdict"], "unexplained");
  EXPECT_NEAR(number(report["findings"][0], "power_1", ""), 0.5, 0.05);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 1.05 * kAxisNoise);
}

// Beside a constant, which a spring far from its rest had held, one law explains more than names of
// several kinds.
TEST(DiagnoseAxes, OneLawAndAConstantStandInThePlaceOfNames) {
  const Json report = AxisBench([](const State& s) {
                        const double u = s.v / 0.7;
                        return 0.3 + 1.5 * u / (1.0 + u * u);
                      })
                          .diagnose(one_axis())
                          .report;
  const Json *constant = find(report, "bias"), *law = find(report, "discovered");
  ASSERT_TRUE(constant && law) << report["findings"].dump(1);
  EXPECT_EQ(report["findings"].size(), 2U) << report["findings"].dump(1);
  EXPECT_NEAR(number(*constant, "delta_bias", "N*m"), 0.3, 0.01);
  EXPECT_NEAR(number(*law, "scale_1", "rad/s"), 0.7, 0.03);
}

// A force that grows with the square of the speed and has one sign begins as friction that differs
// between the directions; beside the law nothing is left of that.
TEST(DiagnoseAxes, ANameThatALawMakesNeedlessGoes) {
  const Json report =
      AxisBench([](const State& s) { return 4.0 * s.v * s.v; }).diagnose(one_axis()).report;
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  EXPECT_EQ(report["findings"][0]["effect"], "discovered");
  EXPECT_NEAR(number(report["findings"][0], "power_1", ""), 2.0, 0.02);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 1.05 * kAxisNoise);
}

// A log of torques that come 0.65 s before the motion has no lead of 0.6 s, where its range ends.
TEST(DiagnoseAxes, NoLeadEndsWhereItsRangeDoes) {
  const Json report =
      AxisBench([](const State& s) { return kInertia * (state_at(s.t + 0.65).a - s.a); })
          .diagnose(one_axis({{"simulated", "simulated"}}))
          .report;
  EXPECT_FALSE(find(report, "time_delay")) << report["findings"].dump(1);
  EXPECT_NE(report["verdict"], "explained");
}

TEST(DiagnoseAxes, LowPassesBothSidesAndShowsTheRawFiguresBeside) {
  const AxisBench bench([](const State& s) { return 0.8 * std::tanh(s.v / 0.01); });
  Json system = one_axis();
  system["lowpass_hz"] = 10;
  const Json report = bench.diagnose(system).report;
  ASSERT_TRUE(find(report, "coulomb_friction")) << report["findings"].dump(1);
  const Json& fit = report["fit"];
  // White noise behind a filter of 10 Hz of 125: a quarter is left.
  EXPECT_LT(fit["holdout_rmse_after"][0].get<double>(), 0.35 * kAxisNoise);
  EXPECT_NEAR(fit["unfiltered"]["holdout_rmse_after"][0].get<double>(), kAxisNoise, 0.005);
  EXPECT_NEAR(fit["noise_floor"][0].get<double>(), 0.28 * kAxisNoise, 0.03 * kAxisNoise);
  EXPECT_EQ(report["lowpass_hz"], 10);
}

// Its edge is beyond what the rows of a search at a stride could hold.
TEST(DiagnoseAxes, AFastLowPassHidesNothing) {
  const AxisBench bench(
      [](const State& s) { return 0.3 * std::sin(2.0 * std::numbers::pi * 13.2 * s.t); });
  Json system = one_axis();
  system["lowpass_hz"] = 56;
  const Json report = bench.diagnose(system).report;
  EXPECT_TRUE(find(report, "hum")) << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "explained");
}

// A tenth of it is slower than the band in which the floor is read: likelier noise than physics.
TEST(DiagnoseAxes, SlowNoiseBesideASimulatorIsNothingMissing) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const test::TemporaryFolder folder;
    for (const auto& [file, rows] : {std::pair{"fit.csv", 6000}, {"hold.csv", 4000}}) {
      Rng rng({seed, static_cast<std::uint64_t>(rows)});
      Table table{{"t", "q", "simulated", "torque"}, Eigen::MatrixXd(rows, 4)};
      double slow = rng.normal();
      for (Index k = 0; k < rows; ++k) {
        const double t = 0.01 * static_cast<double>(k), kept = std::exp(-0.01);
        slow = kept * slow + std::sqrt(1.0 - kept * kept) * rng.normal();
        const double q = 0.5 * std::sin(1.1 * t) + 0.3 * std::sin(2.9 * t);
        const double torque = 3.0 * (0.55 * std::cos(1.1 * t) + 0.87 * std::cos(2.9 * t));
        table.values.row(k) << t, q, torque, torque + 0.1 * rng.normal() + 0.045 * slow;
      }
      write_csv(folder / file, table);
    }
    const Json report = report_of_axis(
        folder,
        {{"name", "joint"}, {"measured", "torque"}, {"unit", "N*m"}, {"simulated", "simulated"}});
    EXPECT_EQ(report["verdict"], "consistent") << seed;
  }
}

/// Derivatives that end at a low-pass which motion reaches would be another inertia's.
TEST(DiagnoseAxes, AMotionBeyondTheLowPassKeepsItsInertia) {
  const test::TemporaryFolder folder;
  for (const auto& [file, seed] : {std::pair{"fit.csv", 1u}, {"hold.csv", 2u}}) {
    Rng rng({seed});
    Table table{{"t", "q", "torque"}, Eigen::MatrixXd(2400, 3)};
    std::vector<double> phases(40);
    for (double& phase : phases) phase = rng.uniform(0.0, 2.0 * std::numbers::pi);
    for (Index k = 0; k < table.values.rows(); ++k) {
      const double t = 0.005 * static_cast<double>(k);
      double q = 0.0, v = 0.0, a = 0.0;
      for (std::size_t i = 0; i < phases.size(); ++i) {  // up to 6 Hz
        const double w = 2.0 * std::numbers::pi * 0.15 * static_cast<double>(i + 1);
        const double size = 0.3 / (1.0 + w);
        q += size * std::sin(w * t + phases[i]);
        v += size * w * std::cos(w * t + phases[i]);
        a -= size * w * w * std::sin(w * t + phases[i]);
      }
      const double torque = 0.19 * a + 0.4 * std::tanh(v / 0.02);
      table.values.row(k) << t, q + 1e-4 * rng.normal(), torque + 0.1 * rng.normal();
    }
    write_csv(folder / file, table);
  }
  const Json report = report_of_axis(
      folder, {{"name", "link"}, {"measured", "torque"}, {"unit", "N*m"}, {"base", Json::array()}},
      4.0);
  const Json* inertia = find(report, "inertia");
  ASSERT_TRUE(inertia) << report["findings"].dump(1);
  EXPECT_NEAR((*inertia)["parameters"]["delta_inertia"]["value"].get<double>(), 0.19, 0.004);
  EXPECT_TRUE(find(report, "coulomb_friction")) << report["findings"].dump(1);
  // White noise behind 4 Hz of 100 is 0.02.
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 0.03);
}

TEST(DiagnoseAxes, PutsAxesSideBySide) {
  const AxisBench bench([](const State& s) { return 0.8 * std::tanh(s.v / 0.01); });
  Json system = one_axis();
  Json second = system["axes"][0];
  second["name"] = "still";
  second["measured"] = "simulated";
  second["base"] = Json::array({"acceleration"});
  system["axes"].push_back(second);
  for (const char* file : {"fit.csv", "hold.csv"}) {
    Table table = read_csv(bench / file);
    Rng rng({7u});
    for (double& v : table.values.col(5)) v += kAxisNoise * rng.normal();
    write_csv(bench / file, table);
  }
  const Diagnosis diagnosis = bench.diagnose(system);
  EXPECT_EQ(diagnosis.report["targets"], Json::array({"torque", "simulated"}));
  EXPECT_EQ(diagnosis.report["fit"]["holdout_rmse_after"].size(), 2U);
  ASSERT_EQ(diagnosis.report["findings"].size(), 1U);
  EXPECT_EQ(diagnosis.report["findings"][0]["axis"], "wheel");
  EXPECT_EQ(diagnosis.holdout.front().after.cols(), 2);
}

std::string refusal(const AxisBench& bench, const Json& system) {
  try {
    bench.diagnose(system);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "accepted " << system.dump();
  return "";
}

TEST(DiagnoseAxes, RefusesBadDescriptionsInOneLine) {
  const AxisBench bench([](const State&) { return 0.0; });
  const auto says = [&](const Json& system, const char* what) {
    EXPECT_NE(refusal(bench, system).find(what), std::string::npos) << refusal(bench, system);
  };
  says(one_axis({{"base", {"acceleration", "jerk"}}}), "jerk");
  says(one_axis({{"simulated", "nothing"}}), "nothing");
  says(one_axis(Json::object()), "simulator");
  says(one_axis({{"base", Json::array({"acceleration"})}, {"simulated", "simulated"}}), "excludes");
  Json arm = one_axis(Json::object());
  arm["arm"] = {{"convention", "modified"}, {"dh", {{0, 0, 0, 0}, {1, 0, 0, 0}}}};
  says(arm, "dh");
  arm["arm"] = {{"convention", "upside-down"}, {"dh", {{0, 0, 0, 0}}}};
  says(arm, "convention");
  Json fast = one_axis();
  fast["lowpass_hz"] = 500;
  says(fast, "lowpass_hz");
  says({{"kind", "wrist"}}, "--sim");
}

}  // namespace
}  // namespace dcnn
