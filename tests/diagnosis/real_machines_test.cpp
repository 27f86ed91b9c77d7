// SPDX-License-Identifier: Apache-2.0
// The ready configurations on real machines, whose recordings are not part of the repository.
#include <gtest/gtest.h>

#include <algorithm>

#include "dcnn/diagnosis/diagnose.h"
#include "support/process.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

const std::filesystem::path kData = std::filesystem::path(DCNN_SOURCE_DIR) / "../shared/data";

Json report_of(const std::string& system, const std::vector<std::string>& fit,
               const std::string& holdout) {
  DiagnosisRequest request;
  request.system = std::filesystem::path(DCNN_SOURCE_DIR) / "configs/systems" / system;
  for (const auto& file : fit) request.fit.push_back(kData / file);
  request.holdout = {kData / holdout};
  return diagnose(request, nullptr).report;
}

bool names(const Json& report, const std::vector<std::string>& any_of) {
  return std::any_of(report["findings"].begin(), report["findings"].end(), [&](const Json& f) {
    return std::find(any_of.begin(), any_of.end(), f["effect"]) != any_of.end();
  });
}

TEST(RealMachines, ASlideShowsItsDryFriction) {
  if (!std::filesystem::exists(kData / "emps")) GTEST_SKIP() << "no " << kData;
  const Json report = report_of("emps.json", {"emps/emps_train.csv"}, "emps/emps_test_pulses.csv");
  EXPECT_TRUE(names(report, {"coulomb_friction"})) << report["findings"].dump(1);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 2.0);
  EXPECT_GT(report["fit"]["holdout_rmse_before"][0].get<double>(), 9.0);
  EXPECT_LT(report["fit"]["unfiltered"]["holdout_rmse_after"][0].get<double>(), 8.0);
}

TEST(RealMachines, ASurgicalToolShowsItsFrictionAndItsCable) {
  if (!std::filesystem::exists(kData / "davinci_tool")) GTEST_SKIP() << "no " << kData;
  const Json report =
      report_of("davinci_spindle.json",
                {"davinci_tool/run_00.csv", "davinci_tool/run_23.csv", "davinci_tool/run_40.csv"},
                "davinci_tool/run_11.csv");
  EXPECT_TRUE(names(report, {"coulomb_friction", "stribeck_friction", "lugre_friction"}))
      << report["findings"].dump(1);
  EXPECT_TRUE(names(report, {"cable_spring"})) << report["findings"].dump(1);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(), 0.0130);
}

// Silverbox: an electronic mass on a spring that stiffens. Whitened columns that overflow there end
// a fit, not the program.
TEST(RealMachines, AnOscillatorShowsItsCubicSpring) {
  const auto file = kData / "silverbox/silverbox_SNLS80mV.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run it";
  const test::TemporaryFolder folder;
  const Table whole = read_csv(file);
  const auto cut = [&](const char* name, Index first, Index rows) {
    Table part = whole;
    part.values = whole.values.middleRows(first, rows);
    write_csv(folder / name, part);
    return folder / name;
  };
  DiagnosisRequest request;
  request.system = std::filesystem::path(DCNN_SOURCE_DIR) / "configs/systems/silverbox.json";
  request.fit = {cut("fit.csv", 40000, 12000)};
  request.holdout = {cut("hold.csv", 52000, 8000)};
  const Json report = diagnose(request, nullptr).report;
  EXPECT_TRUE(names(report, {"cubic_spring"})) << report["findings"].dump(1);
  EXPECT_LT(report["fit"]["holdout_rmse_after"][0].get<double>(),
            0.6 * report["fit"]["holdout_rmse_before"][0].get<double>());
}

}  // namespace
}  // namespace dcnn
