// SPDX-License-Identifier: Apache-2.0
// Axes of a machine at rest: positions and efforts without a clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "support/process.h"

namespace dcnn {
namespace {

constexpr double kPoseNoise = 0.02, kGravity = 1.7, kHose = 0.4, kHoseRest = 0.3;

/// Two joints held in poses at random: gravity turns with the first, a hose pulls at the second.
void write_poses(const std::filesystem::path& path, std::uint64_t seed) {
  constexpr Index kPoses = 300;
  Rng rng({seed});
  Table table;
  table.columns = {"q1", "q2", "tau1", "tau2", "sin1"};
  table.values.resize(kPoses, 5);
  for (Index k = 0; k < kPoses; ++k) {
    const double q1 = rng.uniform(-1.0, 1.0), q2 = rng.uniform(-1.2, 1.2);
    const double tau1 = kGravity * std::sin(q1) + kPoseNoise * rng.normal();
    const double tau2 = kHose * (q2 - kHoseRest) + kPoseNoise * rng.normal();
    table.values.row(k) << q1, q2, tau1, tau2, std::sin(q1);
  }
  write_csv(path, table);
}

class AxesAtRest : public ::testing::Test {
 protected:
  AxesAtRest() {
    write_poses(folder_ / "fit.csv", 1);
    write_poses(folder_ / "hold.csv", 2);
    const Json axes = {{{"name", "shoulder"},
                        {"measured", "tau1"},
                        {"unit", "N*m"},
                        {"position", "q1"},
                        {"base", {"sin1"}}},
                       {{"name", "elbow"},
                        {"measured", "tau2"},
                        {"unit", "N*m"},
                        {"position", "q2"},
                        {"base", Json::array()}}};
    write_file(folder_ / "system.json", Json{{"kind", "axes"}, {"axes", axes}}.dump());
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(AxesAtRest, ASpringIsFoundWithoutAClock) {
  DiagnosisRequest request;
  request.system = at("system.json");
  request.fit = {at("fit.csv")};
  request.holdout = {at("hold.csv")};
  const Json report = dcnn::diagnose(request, nullptr).report;
  ASSERT_EQ(report["findings"].size(), 1U) << report["findings"].dump(1);
  const Json& spring = report["findings"][0];
  EXPECT_EQ(spring["effect"], "cable_spring");
  EXPECT_EQ(spring["axis"], "elbow");
  EXPECT_NEAR(std::abs(spring["parameters"]["k"]["value"].get<double>()), kHose, 0.02);
  EXPECT_EQ(report["verdict"], "explained");
  const auto after = report["fit"]["holdout_rmse_after"].get<std::vector<double>>();
  for (const double rmse : after) EXPECT_NEAR(rmse, kPoseNoise, 0.1 * kPoseNoise);
}

TEST_F(AxesAtRest, TheCorrectedSimulatorPredictsPosesAgain) {
  const auto diagnosed =
      test::run("diagnose", {"--system", at("system.json"), "--fit", at("fit.csv"), "--holdout",
                             at("hold.csv"), "--out", at("report")});
  ASSERT_EQ(diagnosed.exit_code, 0) << diagnosed.err;
  const auto predicted = test::run(
      "predict", {at("report/model.json"), "--data", at("hold.csv"), "--out", at("predicted.csv")});
  ASSERT_EQ(predicted.exit_code, 0) << predicted.err;
  const Table table = read_csv(at("predicted.csv")), truth = read_csv(at("hold.csv"));
  ASSERT_EQ(table.values.rows(), truth.values.rows());
  const auto column = std::find(table.columns.begin(), table.columns.end(), "tau2_hat");
  ASSERT_NE(column, table.columns.end());
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double q2 = truth.values(k, 1);
    EXPECT_NEAR(table.values(k, column - table.columns.begin()), kHose * (q2 - kHoseRest),
                kPoseNoise);
  }
}

}  // namespace
}  // namespace dcnn
