// SPDX-License-Identifier: Apache-2.0
// The identifiers without gradient descent as a user runs them.
#include <gtest/gtest.h>

#include <fstream>

#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;

/// Poses at rest, as simulated by the ready configuration.
class ClosedFormTools : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    const std::string scene = DCNN_SOURCE_DIR "/configs/sim/static.json";
    const auto result = run("sim", {"--config", scene, "--out", at("data"), "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const auto& entry : std::filesystem::directory_iterator(at("data"))) {
      const auto name = entry.path().filename().string();
      if (name.ends_with(".csv") && !name.ends_with("_clean.csv")) poses_ = entry.path().string();
    }
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string at(const std::string& name) { return (*folder_ / name).string(); }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::string poses_;
};
std::unique_ptr<test::TemporaryFolder> ClosedFormTools::folder_;
std::string ClosedFormTools::poses_;

TEST_F(ClosedFormTools, LearnFromPosesAtRestAndLeaveARunDirectory) {
  for (const char* model : {"ns", "cf", "rigid"}) {
    const std::string out = at(std::string(model) + ".dcnn");
    const auto fitted = run("train", {"--model", model, "--train", poses_, "--out", out, "--json"});
    ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
    const Json summary = parse_json(fitted.out, "train", Exit::kFailure);
    EXPECT_EQ(summary["model"], model);
    EXPECT_GT(summary["validation_rows"].get<int>(), 0);
    const auto folder = std::filesystem::path(out).replace_extension(".run");
    EXPECT_EQ(test::slurp(folder / "best.dcnn"), test::slurp(out));
    EXPECT_EQ(test::slurp(folder / "last.dcnn"), test::slurp(out));
    const std::string metrics = test::slurp(folder / "metrics.jsonl");
    EXPECT_EQ(std::count(metrics.begin(), metrics.end(), '\n'), 1);
    const auto scored = run("eval", {out, "--data", poses_, "--snr", "clean", "--json"});
    ASSERT_EQ(scored.exit_code, 0) << scored.err;
    const auto predicted =
        run("predict", {out, "--data", poses_, "--out", at("predicted.csv"), "--force"});
    EXPECT_EQ(predicted.exit_code, 0) << predicted.err;
  }
}

TEST_F(ClosedFormTools, TheReactionIsNoticed) {
  const std::vector<std::string> command{"--model", "cf", "--train", poses_, "--out", at("r.dcnn")};
  EXPECT_EQ(run("train", command).err.find("negative"), std::string::npos);
  auto reaction = command;
  reaction.insert(reaction.end(), {"--force-sign", "-1", "--force", "--accept", "reaction"});
  const auto result = run("train", reaction);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("the fitted mass is negative"), std::string::npos) << result.err;
}

TEST_F(ClosedFormTools, WhatNeedsTimeOrEpochsIsRefused) {
  for (const char* model : {"rls", "dcnn"}) {
    const auto result = run("train", {"--model", model, "--train", poses_, "--out", at("x.dcnn")});
    EXPECT_EQ(result.exit_code, 3) << result.err;
  }
  const auto epochs =
      run("train", {"--model", "cf", "--epochs", "3", "--train", poses_, "--out", at("x.dcnn")});
  EXPECT_EQ(epochs.exit_code, 2);
  EXPECT_NE(epochs.err.find("one pass"), std::string::npos) << epochs.err;
}

}  // namespace
}  // namespace dcnn
