// SPDX-License-Identifier: Apache-2.0
// dcnn-check, and the check that other tools run first, as a user runs them.
#include <gtest/gtest.h>

#include "data/testing.h"
#include "dcnn/core/file.h"
#include "dcnn/core/json.h"
#include "support/page.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;
using testing::contains;

/// FOLDER/log.csv and sim.json with a fault.
void make_log(const test::TemporaryFolder& folder, const std::string& fault) {
  const test::TemporaryFolder sealed;
  ASSERT_EQ(run("conceal", {"--fault", fault, "--seed", "1", "--out", folder.path().string(),
                            "--seal", sealed / "seal", "--force"})
                .exit_code,
            0);
}

TEST(CheckTool, NamesTheFaultAndWritesItsPage) {
  const test::TemporaryFolder folder;
  make_log(folder, "position_mm");
  const auto out = (folder / "check").string();
  const auto result = run("check", {(folder / "log.csv").string(), "--sim",
                                    (folder / "sim.json").string(), "--out", out, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = parse_json(result.out, "check", Exit::kFailure);
  EXPECT_EQ(json["faults"][0]["fault"], "position_unit");
  EXPECT_EQ(json["faults"][0]["flag"], "--position-unit mm");
  EXPECT_EQ(read_json(folder / "check/check.json", Exit::kData)["faults"].size(),
            json["faults"].size());
  const std::string page = read_file(folder / "check/check.html", 1 << 24, Exit::kData);
  EXPECT_TRUE(contains(page, "--position-unit mm") && contains(page, "<svg"));
  test::expect_usable_page(page);
}

TEST(CheckTool, SaysOfAMissingLogWhatEveryToolSays) {
  const auto result = run("check", {"nosuch.csv"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "nosuch.csv: does not exist or cannot be reached"))
      << result.err;
}

/// What a reader of recordings refuses, since it would be left out of every result.
TEST(CheckTool, RefusesColumnsThatAreKnownUnderAnotherSpelling) {
  const test::TemporaryFolder folder;
  const auto checked = [&](const std::string& header) {
    std::ofstream file(folder / "log.csv");
    file << header << "\n";
    for (int k = 0; k < 60; ++k) file << 0.01 * k << "," << 0.1 * k << "," << k % 7 << ",1\n";
    file.close();
    return run("check", {(folder / "log.csv").string()});
  };
  const auto refused = checked("t,alpha,Fx [N],fy");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(contains(refused.err, ":1: column 'Fx [N]': did you mean fx?") &&
              contains(refused.err, "dcnn-import"))
      << refused.err;
  EXPECT_EQ(checked("Time,alpha,fx,fy").exit_code, 3);
  EXPECT_EQ(checked("t,alpha,fx,fy").exit_code, 0);
  // q_x is the position of a joint called x, no part of a quaternion.
  const auto joint = checked("t,q_x,qd_x,tau_x");
  EXPECT_EQ(joint.exit_code, 0) << joint.err;
}

TEST(CheckTool, ACertainFaultStopsATrainingUnlessItIsAccepted) {
  const test::TemporaryFolder folder;
  make_log(folder, "position_mm");
  const std::vector<std::string> train{"--model", "rigid",
                                       "--train", (folder / "log.csv").string(),
                                       "--out",   (folder / "m.dcnn").string()};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), train.begin(), train.end());
    return run("train", more);
  };
  const auto stopped = with({});
  EXPECT_EQ(stopped.exit_code, 3);
  EXPECT_TRUE(contains(stopped.err, "millimetres") && contains(stopped.err, "--position-unit mm"))
      << stopped.err;
  EXPECT_EQ(with({"--position-unit", "mm"}).exit_code, 0);
}

TEST(CheckTool, AMountingThatNobodyDeclaredIsLearnedInSilence) {
  const test::TemporaryFolder folder;
  make_log(folder, "mounting");
  const std::string log = (folder / "log.csv").string(), sim = (folder / "sim.json").string();
  const auto trained = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--train", log});
    const auto result = run("train", more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  EXPECT_FALSE(contains(trained({"--model", "rigid", "--out", folder / "rigid.dcnn"}), "mounting"));
  EXPECT_TRUE(contains(trained({"--model", "mlp", "--preset", "quick", "--epochs", "1", "--base",
                                sim, "--out", folder / "mlp.dcnn"}),
                       "likely: log.csv: mounting"));
}

TEST(CheckTool, ForcesInTheBaseFrameAreNotIdentifiedInSilence) {
  const test::TemporaryFolder folder;
  make_log(folder, "base_frame");
  const std::string log = (folder / "log.csv").string(), out = (folder / "found.json").string();
  const auto stopped = run("identify", {log, "--out", out});
  EXPECT_EQ(stopped.exit_code, 3);
  EXPECT_TRUE(contains(stopped.err, "base frame") &&
              contains(stopped.err, "dcnn-import LOG --wrench-frame base --out FOLDER") &&
              contains(stopped.err, "--accept base_frame"))
      << stopped.err;
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(run("identify", {log, "--out", out, "--accept", "base_frame"}).exit_code, 0);
  const auto turned = run("import", {log, "--wrench-frame", "base", "--out", folder / "turned"});
  ASSERT_EQ(turned.exit_code, 0) << turned.err;
  const auto mended = run("identify", {folder / "turned/log.csv", "--out", out, "--force"});
  EXPECT_EQ(mended.exit_code, 0) << mended.err;
}

TEST(CheckTool, ALikelyFaultIsTheFirstLineOfADiagnosis) {
  const test::TemporaryFolder folder;
  make_log(folder, "gaps");
  const auto result =
      run("diagnose", {"--sim", (folder / "sim.json").string(), "--fit",
                       (folder / "log.csv").string(), "--out", (folder / "report").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("likely: log.csv: gaps")) << result.out;
  EXPECT_FALSE(read_json(folder / "report/report.json", Exit::kData)["check"].empty());
}

// A drag touches nothing, but to a check that knows rigid bodies alone: the diagnosis says so.
TEST(CheckTool, ASuspicionThatTheDiagnosisDoesNotBearOutIsSaidToBeNone) {
  const test::TemporaryFolder folder;
  const auto set = (folder / "set").string();
  ASSERT_EQ(run("conceal", {"--scenario", "single:2/quadratic_drag/2", "--seed", "11", "--out", set,
                            "--seal", folder / "seal"})
                .exit_code,
            0);
  const auto scenario = folder / "set/s0001";
  const auto result =
      run("diagnose", {"--sim", (scenario / "sim.json").string(), "--fit",
                       (scenario / "fit_0.csv").string(), "--out", (folder / "report").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json report = read_json(folder / "report/report.json", Exit::kData);
  ASSERT_EQ(report["check"].size(), 1u) << report["check"];
  const auto line = report["check"][0].get<std::string>();
  EXPECT_TRUE(contains(line, ": contact: ") && contains(line, "finds none")) << line;
}

TEST(CheckTool, ADiagnosisOfAForceInTheBaseFrameIsRefused) {
  const test::TemporaryFolder folder;
  make_log(folder, "base_frame");
  const std::vector<std::string> diagnose{"--sim", (folder / "sim.json").string(),
                                          "--fit", (folder / "log.csv").string(),
                                          "--out", (folder / "report").string()};
  const auto result = run("diagnose", diagnose);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "base frame") && contains(result.err, "--accept base_frame"))
      << result.err;
}

}  // namespace
}  // namespace dcnn
