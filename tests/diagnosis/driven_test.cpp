// SPDX-License-Identifier: Apache-2.0
// Laws whose strength follows a logged signal, on an axis and on a wrist.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "dcnn/core/random.h"
#include "diagnosis/support.h"

namespace dcnn {
namespace {

using test::found;
using Names = std::set<std::string>;

/// Torque of a drive at a position and a rate, while its motor has a temperature.
using WarmLaw = std::function<double(double q, double v, double temperature)>;

void write_warm_axis(const std::filesystem::path& path, double begin, const WarmLaw& law) {
  constexpr Index kSamples = 6000;
  constexpr double kStep = 0.005, kTorqueNoise = 0.05;
  Rng rng({static_cast<std::uint64_t>(begin) + 1});
  Table table{{"t", "pos", "torque", "simulated", "motor"}, Eigen::MatrixXd(kSamples, 5)};
  for (Index k = 0; k < kSamples; ++k) {
    const double t = begin + kStep * static_cast<double>(k);
    double q = 0.0, v = 0.0, a = 0.0;
    const double hz[] = {0.09, 0.23, 0.51};
    for (int i = 0; i < 3; ++i) {
      const double w = 2.0 * std::numbers::pi * hz[i], size = 0.7 / (1 + i);
      q += size * std::sin(w * t + i);
      v += size * w * std::cos(w * t + i);
      a -= size * w * w * std::sin(w * t + i);
    }
    const double temperature = 22.0 + 12.0 * (1.0 - std::exp(-t / 40.0)) + 0.5 * std::sin(t / 6.0);
    table.values.row(k) << t, q + 1e-5 * rng.normal(),
        0.8 * a + law(q, v, temperature) + kTorqueNoise * rng.normal(), 0.8 * a,
        temperature + 0.01 * rng.normal();
  }
  write_csv(path, table);
}

Json report_of(const WarmLaw& law) {
  const test::TemporaryFolder folder;
  write_warm_axis(folder / "fit.csv", 0.0, law);
  write_warm_axis(folder / "hold.csv", 40.0, law);
  write_file(folder / "system.json", Json{{"kind", "axes"},
                                          {"axes",
                                           {{{"name", "joint"},
                                             {"measured", "torque"},
                                             {"unit", "N*m"},
                                             {"position", "pos"},
                                             {"simulated", "simulated"},
                                             {"signals", {"motor"}}}}}}
                                         .dump());
  DiagnosisRequest request;
  request.system = folder / "system.json";
  request.fit = {folder / "fit.csv"};
  request.holdout = {folder / "hold.csv"};
  return diagnose(request, nullptr).report;
}

bool is_driven(const Json& finding) { return finding["parameters"].contains("driven_by"); }

TEST(DiagnoseDriven, NamesFrictionThatFallsWithTheTemperatureOfTheMotor) {
  const Json report =
      report_of([](double, double v, double t) { return (1.5 - 0.03 * (t - 22.0)) * v; });
  ASSERT_EQ(found(report), Names{"viscous_friction"}) << report["findings"].dump(1);
  const Json& parameters = report["findings"][0]["parameters"];
  ASSERT_TRUE(is_driven(report["findings"][0])) << report["findings"].dump(1);
  EXPECT_EQ(parameters["driven_by"]["value"], "motor");
  EXPECT_NEAR(parameters["slope"]["value"].get<double>(), -0.03, 0.003);
  EXPECT_NEAR(
      parameters["c"]["value"].get<double>() + 28.0 * parameters["slope"]["value"].get<double>(),
      1.5 - 0.03 * 6.0, 0.02);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 0.052);
}

TEST(DiagnoseDriven, NamesAnOffsetThatFollowsASignal) {
  const Json report = report_of([](double, double, double t) { return 0.08 * (t - 26.0); });
  ASSERT_EQ(found(report), Names{"bias"}) << report["findings"].dump(1);
  const Json& parameters = report["findings"][0]["parameters"];
  ASSERT_TRUE(is_driven(report["findings"][0])) << report["findings"].dump(1);
  EXPECT_NEAR(parameters["slope"]["value"].get<double>(), 0.08, 0.004);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 0.052);
}

TEST(DiagnoseDriven, ASignalThatDrivesNothingIsNotNamed) {
  const Json report = report_of([](double, double v, double) { return 1.2 * v; });
  ASSERT_EQ(found(report), Names{"viscous_friction"}) << report["findings"].dump(1);
  EXPECT_FALSE(is_driven(report["findings"][0]));
}

TEST(DiagnoseDriven, NamesAHoseThatStiffensWithItsPressureSomeTimeAfter) {
  const test::Bench bench(test::configuration(Json::array()));
  const auto pressure = [](double t) { return 2.0 + std::sin(0.9 * t) + 0.5 * std::sin(2.3 * t); };
  test::change(bench, [&](Recording& log) {
    const Eigen::VectorXd t = log.column("t"), alpha = log.column("alpha");
    Eigen::VectorXd force = log.column("fy");
    for (Index k = 0; k < t.size(); ++k) {
      force(k) -= (0.1 + 0.2 * pressure(t(k) - 0.25)) * (alpha(k) - 0.3);
    }
    log.set("fy", force);
    log.set("pressure", t.unaryExpr(pressure));
  });
  DiagnosisRequest request = bench.request();
  request.signals = {"pressure"};
  const Diagnosis seen = diagnose(request, nullptr);
  ASSERT_EQ(found(seen.report), Names{"cable_spring"}) << seen.report["findings"].dump(1);
  const Json& hose = seen.report["findings"][0];
  ASSERT_TRUE(is_driven(hose)) << hose.dump(1);
  EXPECT_EQ(hose["axis"], "alpha:sensor_y");
  EXPECT_NEAR(hose["parameters"]["slope"]["value"].get<double>(), 0.2, 0.02);
  EXPECT_NEAR(hose["parameters"]["lag_s"]["value"].get<double>(), 0.25, 0.03);
  EXPECT_EQ(seen.report["verdict"], "explained");
  EXPECT_EQ(seen.model["effects"][0]["parameters"]["driven_by"], "pressure");
}

}  // namespace
}  // namespace dcnn
