// SPDX-License-Identifier: Apache-2.0
// dcnn-reproduce on a small scene: what it writes, that finished work is not redone, and how the
// report looks to a browser.
#include <gtest/gtest.h>

#include <algorithm>

#include "dcnn/core/json.h"
#include "dcnn/experiment/evaluate.h"
#include "support/page.h"
#include "support/process.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;
using test::Process;
using test::Result;
using test::run;
using test::slurp;

constexpr const char* kScene = R"({
  "seed": 7, "sample_rate_hz": 500,
  "simulator": {"tool": {"mass_kg": 0.7, "com_m": [0.004, -0.006, 0.16]},
                "sensor": {"bias_n": [0.6, -0.4, 1.1]}},
  "pose_noise": {"m": 5e-6, "rad": 5e-6}, "force_noise": {"n": 0.04, "nm": 0.0, "ar": 0},
  "recordings": [
    {"name": "train", "samples": 3000, "t0_s": 0, "trajectory": {"kind": "multisine", "tones": 6,
     "hz": [0.1, 1.0], "position_m": [0.12, 0.12, 0.12], "angle_rad": [1.05, 0.61, 0.70],
     "angle_center_rad": [0, 0, 3.14159]}},
    {"name": "test", "samples": 1500, "t0_s": 10, "trajectory": {"kind": "multisine", "tones": 6,
     "hz": [0.1, 1.0], "position_m": [0.12, 0.12, 0.12], "angle_rad": [1.05, 0.61, 0.70],
     "angle_center_rad": [0, 0, 3.14159]}}]})";

class Reproduce : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    std::ofstream(at("scene.json")) << kScene;
    first_ = run("reproduce", arguments("out"));
    ASSERT_EQ(first_.exit_code, 0) << first_.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string at(const std::string& name) { return (*folder_ / name).string(); }

  static std::vector<std::string> arguments(const std::string& out,
                                            std::vector<std::string> more = {}) {
    std::vector<std::string> all{"--preset",   "quick",    "--scene",  at("scene.json"),
                                 "--out",      at(out),    "--models", "dcnn",
                                 "dcnn-valid", "--epochs", "2"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  static Result first_;
};
std::unique_ptr<test::TemporaryFolder> Reproduce::folder_;
Result Reproduce::first_;

TEST_F(Reproduce, WritesReportFiguresAndVerdicts) {
  for (const char* name :
       {"data/train.csv", "models/A/dcnn/dcnn.dcnn", "models/B/dcnn-valid/dcnn-valid.dcnn",
        "figures/noise_feature_A.csv", "figures/noise_feature_B.json", "figures/table1.csv",
        "figures/training_A.csv", "scores/feature/A/dcnn/trace.csv", "reproduction.json",
        "report.html"}) {
    EXPECT_TRUE(fs::exists(at(std::string("out/") + name))) << name;
  }
  const std::string draws = slurp(at("out/figures/noise_feature_A.csv"));
  EXPECT_TRUE(draws.starts_with("level,model,run,fx,fy,fz,overall\nclean,ns,0,")) << draws;
  EXPECT_NE(draws.find("\n10,dcnn-valid,1,"), std::string::npos);
  const Json summary = parse_json(slurp(at("out/reproduction.json")), "summary", Exit::kFailure);
  EXPECT_EQ(summary["claims"].size(), 3u);
  for (const auto& [series, claims] : summary["claims"].items()) EXPECT_EQ(claims.size(), 5u);
  EXPECT_EQ(summary["depends_on"]["seed of training and of test noise"], "1");
  EXPECT_EQ(summary["depends_on"]["test samples scored"], "188") << "every 8th of 1500";
}

TEST_F(Reproduce, TheReportIsOneSmallFile) {
  const std::string html = slurp(at("out/report.html"));
  EXPECT_LT(html.size(), std::size_t{8} << 20);
  for (const char* word : {"Fig. 5", "Table I", "C5", "D26", "SHA-256", "Residuals", "not tested"})
    EXPECT_NE(html.find(word), std::string::npos) << word;
}

TEST_F(Reproduce, FinishedWorkIsNotRedone) {
  const auto model = fs::last_write_time(at("out/models/A/dcnn/dcnn.dcnn")),
             scores = fs::last_write_time(at("out/scores/feature/A/dcnn/evaluation.json"));
  const std::string report = slurp(at("out/report.html"));
  const Result again = run("reproduce", arguments("out"));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.err.find("0 cells done"), std::string::npos) << again.err;
  EXPECT_NE(again.err.find("the time left is told from those that were measured"),
            std::string::npos);
  EXPECT_EQ(model, fs::last_write_time(at("out/models/A/dcnn/dcnn.dcnn")));
  EXPECT_EQ(scores, fs::last_write_time(at("out/scores/feature/A/dcnn/evaluation.json")));
  EXPECT_EQ(report, slurp(at("out/report.html")));
}

TEST_F(Reproduce, WhatDependsOnAChangeIsRedoneAndNothingElse) {
  fs::copy(at("out"), at("changed"), fs::copy_options::recursive);
  const Result draws = run("reproduce", arguments("changed", {"--draws", "3"}));
  ASSERT_EQ(draws.exit_code, 0) << draws.err;
  // The simulation, two models in two protocols and their times stay; scores are new.
  EXPECT_NE(draws.err.find("7 skipped"), std::string::npos) << draws.err;
}

TEST_F(Reproduce, GoesOnAfterAnInterruptToTheSameNumbers) {
  auto whole = arguments("whole"), cut = arguments("cut");
  for (auto* all : {&whole, &cut}) {
    all->back() = "8";
    std::erase(*all, "dcnn-valid");
  }
  ASSERT_EQ(run("reproduce", whole).exit_code, 0);
  const Process process("reproduce", cut);
  while (!fs::exists(at("cut/cells/trainings/packs")))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  process.signal(SIGINT);
  const Result stopped = process.wait();
  ASSERT_EQ(stopped.exit_code, 75) << stopped.err;
  EXPECT_NE(stopped.err.find("\nstopping…\n"), std::string::npos) << stopped.err;
  EXPECT_FALSE(fs::exists(at("cut/report.html")));
  ASSERT_EQ(run("reproduce", cut).exit_code, 0);
  EXPECT_EQ(slurp(at("whole/models/A/dcnn/dcnn.dcnn")), slurp(at("cut/models/A/dcnn/dcnn.dcnn")));
  EXPECT_EQ(slurp(at("whole/figures/noise_feature_B.csv")),
            slurp(at("cut/figures/noise_feature_B.csv")));
}

/// As on a cluster: the cells of every stage are run by dcnn-sweep, in shares.
TEST_F(Reproduce, CellsThatOthersRanGiveTheSameNumbers) {
  int stages = 0;
  for (;; ++stages) {
    const Result next = run("reproduce", arguments("shared", {"--prepare", "--quiet"}));
    ASSERT_EQ(next.exit_code, 0) << next.err;
    const std::string folder = next.out.substr(0, next.out.find('\n'));
    if (!fs::exists(folder + "/plan.jsonl")) break;
    ASSERT_LT(stages, 4) << folder;
    for (const char* share : {"2/2", "1/2"}) {
      const Result ran = run("sweep", {"--plan", folder, "--shard", share});
      ASSERT_EQ(ran.exit_code, 0) << ran.err;
    }
  }
  EXPECT_EQ(stages, 4);
  for (const char* name : {"models/B/dcnn/dcnn.dcnn", "figures/noise_feature_A.csv",
                           "figures/noise_pose_A.csv", "figures/training_B.csv"}) {
    EXPECT_EQ(slurp(at(std::string("shared/") + name)), slurp(at(std::string("out/") + name)))
        << name;
  }
}

TEST_F(Reproduce, WhereACellFailsEndsAsItsToolDoes) {
  std::ofstream(at("bad.csv")) << "t,x\n0,1\n";
  const Result result =
      run("reproduce", {"--preset", "quick", "--data", at("bad.csv"), at("out/data/test.csv"),
                        "--out", at("bad"), "--models", "cf", "--quiet"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.err.find("/cf: exit 3: dcnn-train: "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("in/data/train.csv"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(at("bad/report.html")));
  // The remedy that dcnn-train names is one of dcnn-reproduce.
  const std::vector<std::string> turned{"--preset",
                                        "quick",
                                        "--data",
                                        at("out/data/train.csv"),
                                        at("out/data/test.csv"),
                                        "--out",
                                        at("turned"),
                                        "--models",
                                        "cf",
                                        "--quiet",
                                        "--force-sign",
                                        "-1"};
  const Result reaction = run("reproduce", turned);
  EXPECT_EQ(reaction.exit_code, 3) << reaction.err;
  EXPECT_NE(reaction.err.find("--accept reaction goes on"), std::string::npos) << reaction.err;
  auto accepted = turned;
  accepted.insert(accepted.end(), {"--accept", "reaction"});
  EXPECT_EQ(run("reproduce", accepted).exit_code, 0);
}

TEST_F(Reproduce, TakesTheUsersRecordings) {
  const Result result =
      run("reproduce", {"--preset", "quick", "--data", at("out/data/train.csv"),
                        at("out/data/test.csv"), "--out", at("own"), "--models", "dcnn", "--epochs",
                        "1", "--quiet", "--repeat", "training", "--trainings", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(slurp(at("own/data/test.csv")), slurp(at("out/data/test.csv")));
  EXPECT_FALSE(fs::exists(at("own/cells/recordings")));
  EXPECT_NE(slurp(at("own/report.html")).find("Spread over trainings"), std::string::npos);
}

TEST_F(Reproduce, RefusesWhatItCannotDo) {
  EXPECT_EQ(run("reproduce", {"--models", "dcn", "--out", at("x")}).exit_code, 2);
  EXPECT_EQ(run("reproduce", {"--scene", at("missing.json"), "--out", at("x")}).exit_code, 2);
  const Result plan =
      run("reproduce", {"--preset", "standard", "--scene", at("scene.json"), "--plan"});
  EXPECT_EQ(plan.exit_code, 0);
  EXPECT_NE(plan.out.find("models/A/dcnn\n"), std::string::npos);
}

TEST_F(Reproduce, EveryKthSampleIsScoredAsItWouldBeAmongAll) {
  EvaluationRequest request;
  request.models = {at("out/models/A/dcnn/dcnn.dcnn")};
  request.data = {at("out/data/test.csv")};
  request.levels = {std::nullopt};
  const Trace all = evaluate(request, {}).traces.at(0);
  request.every = 7;
  const Evaluation thin = evaluate(request, {});
  ASSERT_EQ(thin.samples, (1500 + 6) / 7);
  double sum = 0;
  for (Index i = 0; i < thin.samples; ++i) {
    const double error = all.predicted(7 * i, 2) - all.measured(7 * i, 2);
    sum += error * error;
    EXPECT_EQ(thin.traces.at(0).t[i], all.t[7 * i]);
  }
  EXPECT_NEAR(thin.rows.at(0).score.rmse.at(2), std::sqrt(sum / static_cast<double>(thin.samples)),
              1e-6);
}

TEST_F(Reproduce, TheReportIsUsable) { test::expect_usable_page(slurp(at("out/report.html"))); }

/// A few epochs are no verdict: the first look shows no crosses.
TEST_F(Reproduce, AFirstLookJudgesNoClaim) {
  const std::string html = slurp(at("out/report.html"));
  EXPECT_EQ(html.find("✗"), std::string::npos);
  EXPECT_NE(html.find("does not judge the paper&#39;s claims"), std::string::npos);
  EXPECT_NE(html.find("predicts the test recording best"), std::string::npos);
}

}  // namespace
}  // namespace dcnn
