// SPDX-License-Identifier: Apache-2.0
// Sensors as they are used: zeroed for each recording, or with a payload's weight subtracted.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "dcnn/core/random.h"
#include "dcnn/data/rotation.h"
#include "diagnosis/support.h"

namespace dcnn {
namespace {

using test::Bench;
using test::configuration;
using test::hidden;
using test::names;

void zero(Recording& log) {
  for (const char* name : {"fx", "fy", "fz"}) {
    log.set(name, log.column(name).array() - log.column(name).head(10).mean());
  }
}

TEST(ZeroedRecordings, GetTheNamesOfTheRawOnes) {
  const Bench bench(
      configuration(Json::array({hidden("viscous_friction", "base_x", {{"c_nspm", 0.6}})})));
  test::change(bench, zero);
  DiagnosisRequest request = bench.request();
  const Json raw = diagnose(request, nullptr).report;
  EXPECT_NE(names(raw), std::vector<std::string>{"viscous_friction"}) << "the test tells nothing";
  request.zeroed = {bench / "fit.csv", bench / "hold.csv"};
  const Json report = diagnose(request, nullptr).report;
  EXPECT_EQ(names(report), std::vector<std::string>{"viscous_friction"}) << report["findings"];
  EXPECT_EQ(report["verdict"], "explained");
  EXPECT_EQ(report["zeroed"], (Json{"fit.csv", "hold.csv"}));
  for (const Json& error : report["fit"]["holdout_rmse_after"]) {
    EXPECT_NEAR(error.get<double>(), 0.04, 0.004);
  }
}

TEST(ZeroedRecordings, OfASimulatorThatIsRightLackNothing) {
  const Bench bench(configuration(Json::array()));
  test::change(bench, zero);
  DiagnosisRequest request = bench.request(false);
  request.zeroed = {bench / "fit.csv"};
  const Json report = diagnose(request, nullptr).report;
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"];
}

/// A fitted recording that was zeroed tells nothing of the offset of another.
TEST(ZeroedRecordings, TellNoOffsetOfWhatIsHeldOut) {
  const Bench bench(configuration(Json::array()));
  test::change(bench, [](Recording& log) { log.set("fx", log.column("fx").array() + 5.0); });
  DiagnosisRequest request = bench.request();
  request.zeroed = {bench / "fit.csv"};
  const Json report = diagnose(request, nullptr).report;
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"];
  EXPECT_EQ(report["zeroed"], (Json{"fit.csv", "hold.csv"}));
}

/// Of three recordings of a joint in white noise of 0.05 N*m, this much higher in the second and
/// lower in the third.
Json report_of_joint(double apart) {
  const test::TemporaryFolder folder;
  Rng rng({77});
  for (int log = 0; log < 3; ++log) {
    std::string text = "t,q,tau,tau_sim\n";
    for (int row = 0; row < 6000; ++row) {
      const double t = 0.004 * row + 40.0 * log;
      const double q = 0.5 * std::sin(0.9 * t + log) + 0.3 * std::sin(2.1 * t);
      const double acceleration = -0.405 * std::sin(0.9 * t + log) - 1.323 * std::sin(2.1 * t);
      const double simulated = 0.4 * acceleration, zero = log == 0   ? 0.0
                                                          : log == 1 ? apart
                                                                     : -apart;
      char line[200];
      std::snprintf(line, sizeof(line), "%.4f,%.9f,%.9f,%.9f\n", t, q,
                    simulated + zero + 0.05 * rng.normal(), simulated);
      text += line;
    }
    write_file(folder / ("log" + std::to_string(log) + ".csv"), text);
  }
  write_file(folder / "system.json", R"({"kind": "axes", "axes": [{"name": "joint",
      "position": "q", "measured": "tau", "unit": "N*m", "simulated": "tau_sim"}]})");
  DiagnosisRequest request;
  request.system = folder / "system.json";
  request.fit = {folder / "log0.csv", folder / "log1.csv"};
  request.holdout = {folder / "log2.csv"};
  return diagnose(request, nullptr).report;
}

TEST(ZerosOfRecordings, ThatDifferByLessThanTheNoiseAreNoted) {
  const Json report = report_of_joint(0.008);
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"];
  const std::string note = report["notes"].back();
  EXPECT_TRUE(note.starts_with("the zero of tau is another one in each recording")) << note;
}

TEST(ZerosOfRecordings, ThatDifferByMoreAreNotPassedOver) {
  const Json report = report_of_joint(0.15);
  EXPECT_NE(report["verdict"], "consistent");
}

TEST(SubtractedPayload, IsAddedBackInTheSensorsFrame) {
  const Bench bench(configuration(Json::array()));
  const Recording raw = read_recording(bench / "fit.csv", ReadOptions(), System());
  ReadOptions read;
  read.payload = {0.5, {0.0, 0.01, 0.1}, {0.3, -0.2, 0.1}};
  const Recording added = read_recording(bench / "fit.csv", read, System());
  const Eigen::Matrix3d R_BS = rotations(raw)[7] * rotation_from_euler({0.1, -0.2, 0.3});
  const Eigen::Vector3d weight = R_BS.transpose() * Eigen::Vector3d(0.0, 0.0, -0.5 * 9.80665);
  const Eigen::MatrixXd change = added.block({"fx", "fy", "fz"}) - raw.block({"fx", "fy", "fz"});
  EXPECT_LT((change.row(7).transpose() - weight).norm(), 1e-12);
}

}  // namespace
}  // namespace dcnn
