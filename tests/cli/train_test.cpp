// SPDX-License-Identifier: Apache-2.0
// dcnn-sim, dcnn-train, dcnn-eval and dcnn-predict as a user runs them.
#include <gtest/gtest.h>

#include "dcnn/core/json.h"
#include "dcnn/data/csv.h"
#include "support/page.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::Process;
using test::Result;
using test::run;
using test::slurp;

constexpr const char* kTrainingScene = R"({
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
     "angle_center_rad": [0, 0, 3.14159]}}],
  "hidden": [{"effect": "coulomb_friction", "axis": "tool_z", "interval_s": null,
              "parameters": {"fc_n": 0.4, "v0_mps": 0.01}}]})";

/// One simulated data set for all tests of this file.
class Tools : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    std::ofstream(at("scene.json")) << kTrainingScene;
    const Result result = run("sim", {"--config", at("scene.json"), "--out", at("data")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string at(const std::string& name) { return (*folder_ / name).string(); }

  static std::vector<std::string> training(const std::string& out,
                                           std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{
        "--train", at("data/train.csv"), "--preset", "quick", "--out", at(out), "--quiet"};
    if (std::find(more.begin(), more.end(), "--epochs") == more.end())
      more.insert(more.end(), {"--epochs", "3"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> Tools::folder_;

TEST_F(Tools, SimulatedFolderHoldsRecordingsTruthAndSimulator) {
  for (const char* name : {"train.csv", "train_clean.csv", "test.csv", "sim.json", "truth.json"}) {
    EXPECT_TRUE(std::filesystem::exists(at(std::string("data/") + name))) << name;
  }
  EXPECT_EQ(read_csv(at("data/train.csv")).values.rows(), 3000);
  EXPECT_EQ(slurp(at("data/sim.json")).find("coulomb"), std::string::npos)
      << "sim.json must not tell";
  EXPECT_NE(slurp(at("data/truth.json")).find("coulomb_friction"), std::string::npos);
}

TEST_F(Tools, SameSeedGivesTheSameModelForOneAndTwoThreads) {
  ASSERT_EQ(run("train", training("one.dcnn", {"--threads", "1"})).exit_code, 0);
  ASSERT_EQ(run("train", training("two.dcnn", {"--threads", "2"})).exit_code, 0);
  ASSERT_EQ(run("train", training("other.dcnn", {"--threads", "2", "--seed", "9"})).exit_code, 0);
  EXPECT_EQ(slurp(at("one.dcnn")), slurp(at("two.dcnn")));
  EXPECT_NE(slurp(at("one.dcnn")), slurp(at("other.dcnn")));
}

TEST_F(Tools, TrainingLearnsAndEvaluationAgreesWithPrediction) {
  ASSERT_EQ(run("train", training("model.dcnn", {"--epochs", "8"})).exit_code, 0);
  const Result result =
      run("eval", {at("model.dcnn"), "--data", at("data/test.csv"), "--snr", "clean,20", "--runs",
                   "3", "--json", "--quiet", "--out", at("report")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = parse_json(result.out, "eval", Exit::kFailure);
  EXPECT_EQ(json["samples"], 1500);
  EXPECT_EQ(json["targets"], Json({"fx", "fy", "fz"}));
  EXPECT_EQ(json["rows"].size(), 4u);  // one clean, three noisy
  EXPECT_TRUE(json["rows"][0]["snr_db"].is_null());
  EXPECT_LT(json["summary"][0]["rmse_overall_mean"].get<double>(),
            0.5 * json["unidentified"]["rmse_overall"].get<double>());
  EXPECT_GT(json["summary"][1]["rmse_overall_std"].get<double>(), 0.0);
  test::expect_usable_page(slurp(at("report/report.html")));

  ASSERT_EQ(run("predict", {at("model.dcnn"), "--data", at("data/test.csv"), "--out", at("p.csv")})
                .exit_code,
            0);
  const Table table = read_csv(at("p.csv"));
  const auto column = [&](const std::string& name) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), name);
    return table.values.col(found - table.columns.begin()).eval();
  };
  const double rmse = std::sqrt((column("fx_hat") - column("fx")).array().square().mean());
  EXPECT_NEAR(rmse, json["rows"][0]["rmse"][0].get<double>(), 1e-9);
}

/// A model that knows the band of its training says where a recording leaves it.
TEST_F(Tools, MotionUnlikeTheTrainingIsToldToTheUser) {
  std::string scene = kTrainingScene;
  for (auto place = scene.find("[0.1, 1.0]"); place != std::string::npos;
       place = scene.find("[0.1, 1.0]", place)) {
    scene.replace(place, 10, "[0.4, 4.0]");
  }
  std::ofstream(at("fast.json")) << scene;
  ASSERT_EQ(run("sim", {"--config", at("fast.json"), "--out", at("fast")}).exit_code, 0);
  ASSERT_EQ(run("train", training("band.dcnn", {"--model", "frame-tcn"})).exit_code, 0);
  for (const std::string name : {"data", "fast"}) {
    const Result told = run("predict", {at("band.dcnn"), "--data", at(name + "/test.csv"), "--out",
                                        at(name + "_p.csv")});
    ASSERT_EQ(told.exit_code, 0) << told.err;
    EXPECT_EQ(told.err.find("unlike the training") != std::string::npos, name == "fast")
        << told.err;
    const Result scored = run(
        "eval", {at("band.dcnn"), "--data", at(name + "/test.csv"), "--snr", "clean", "--json"});
    const Json json = parse_json(scored.out, "eval", Exit::kFailure);
    const double share = json["summary"][0]["share_beyond_training"];
    EXPECT_TRUE(name == "fast" ? share > 0.5 : share < 0.01) << name << " " << share;
    EXPECT_EQ(json["notes"].empty(), name == "data");
    const Table table = read_csv(at(name + "_p.csv"));
    EXPECT_EQ(table.columns.back(), "novelty");
    EXPECT_NEAR((table.values.rightCols(1).array() > 1.0).cast<double>().mean(), share, 1e-9);
  }
}

TEST_F(Tools, NoiseOnThePoseIsLearnedAndScored) {
  std::ofstream(at("pose.json")) << R"({"noise": {"on": "pose"}})";
  Result result = run("train", training("pose.dcnn", {"--config", at("pose.json")}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::string> arguments{
      at("pose.dcnn"), "--data", at("data/test.csv"), "--snr", "20", "--runs", "2", "--json"};
  auto on_pose = arguments;
  on_pose.insert(on_pose.end(), {"--noise-on", "pose"});
  const Json features = parse_json(run("eval", arguments).out, "eval", Exit::kFailure);
  result = run("eval", on_pose);
  const Json pose = parse_json(result.out, "eval", Exit::kFailure);
  EXPECT_EQ(run("eval", on_pose).out, result.out);
  EXPECT_NE(pose["rows"][0]["rmse"], features["rows"][0]["rmse"]);
  EXPECT_NE(pose["rows"][0]["rmse"], pose["rows"][1]["rmse"]);
  EXPECT_EQ(pose["noise"].get<std::string>().find("pose"), 0U);

  std::ofstream(at("body.json")) << R"({"noise": {"on": "pose"}, "features": {"set": "body"}})";
  result = run("train", training("body_pose.dcnn", {"--config", at("body.json")}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("noise.on 'features'"), std::string::npos) << result.err;
}

TEST_F(Tools, ResumedAfterInterruptEndsWithTheBytesOfAnUninterruptedRun) {
  ASSERT_EQ(run("train", training("whole.dcnn", {"--epochs", "12"})).exit_code, 0);
  const Process process("train", training("cut.dcnn", {"--epochs", "12"}));
  while (!std::filesystem::exists(at("cut.run/checkpoint.safetensors"))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  process.signal(SIGINT);
  ASSERT_EQ(process.wait().exit_code, 75);
  EXPECT_FALSE(std::filesystem::exists(at("cut.dcnn")));
  ASSERT_EQ(run("train", training("cut.dcnn", {"--epochs", "12", "--resume"})).exit_code, 0);
  EXPECT_EQ(slurp(at("whole.dcnn")), slurp(at("cut.dcnn")));
  EXPECT_EQ(slurp(at("whole.run/metrics.jsonl")), slurp(at("cut.run/metrics.jsonl")));
}

TEST_F(Tools, KilledAtAnyTimeNeverLosesTheLastGoodCheckpoint) {
  ASSERT_EQ(run("train", training("sound.dcnn", {"--epochs", "12"})).exit_code, 0);
  const auto arguments = training("killed.dcnn", {"--epochs", "12", "--resume"});
  int kills = 0;
  for (int delay_ms = 30; kills < 25; delay_ms = 30 + (delay_ms * 7 + 13) % 120) {
    const Process process("train", arguments);
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    process.signal(SIGKILL);
    const int code = process.wait().exit_code;
    if (code == 0) break;
    ASSERT_EQ(code, 128 + SIGKILL) << "a run must go on from whatever the kill left";
    ++kills;
  }
  EXPECT_GT(kills, 2);
  ASSERT_EQ(run("train", arguments).exit_code, 0);
  EXPECT_EQ(slurp(at("sound.dcnn")), slurp(at("killed.dcnn")));
}

TEST_F(Tools, ResumeRefusesAnotherConfiguration) {
  ASSERT_EQ(run("train", training("r.dcnn")).exit_code, 0);
  const Result result = run("train", training("r.dcnn", {"--resume", "--seed", "2"}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("another configuration"), std::string::npos) << result.err;
}

TEST_F(Tools, ChoosesAmongCandidatesOnTheValidationRows) {
  std::ofstream(at("choice.json"))
      << R"({"preset": "quick", "training": {"candidate_epochs": 8, "candidates":
    [{"training": {"lr": 1e-9}}, {"training": {"lr": 1e-3}}]}})";
  ASSERT_EQ(run("train", training("chosen.dcnn", {"--config", at("choice.json")})).exit_code, 0);
  const Json chosen = read_json(at("chosen.run/configuration.json"), Exit::kFailure);
  EXPECT_EQ(chosen["training"]["lr"], 1e-3) << "the other one cannot learn";
  EXPECT_EQ(chosen["training"]["epochs"], 3);
  EXPECT_FALSE(chosen["training"].contains("candidates"));
}

TEST_F(Tools, LearnsWhatABaseSimulatorLeaves) {
  ASSERT_EQ(run("train", training("rest.dcnn", {"--base", at("data/sim.json")})).exit_code, 0);
  const Result result =
      run("eval", {at("rest.dcnn"), "--data", at("data/test.csv"), "--snr", "clean", "--json"});
  const Json json = parse_json(result.out, "eval", Exit::kFailure);
  EXPECT_LT(json["summary"][0]["rmse_overall_mean"].get<double>(), 0.3)
      << "friction and noise are all that is left";
  const Result onnx = run("predict", {at("rest.dcnn"), "--onnx", at("rest.onnx")});
  EXPECT_EQ(onnx.exit_code, 2);
  EXPECT_NE(onnx.err.find("adds to a simulator"), std::string::npos) << onnx.err;
}

TEST_F(Tools, AddsNothingToASimulatorThatLeavesNothing) {
  Json whole = read_json(at("data/sim.json"), Exit::kFailure);
  whole["effects"] = read_json(at("data/truth.json"), Exit::kFailure)["effects"];
  std::ofstream(at("whole.json")) << whole.dump();
  for (const char* kind : {"mlp", "dcnn"}) {
    const std::string model = std::string(kind) + "_more.dcnn";
    const Result trained =
        run("train", training(model, {"--base", at("whole.json"), "--model", kind, "--json"}));
    ASSERT_EQ(trained.exit_code, 0) << trained.err;
    const Json trust = parse_json(trained.out, "train", Exit::kFailure)["trust"];
    const Result result =
        run("eval", {at(model), "--data", at("data/test.csv"), "--snr", "clean", "--json"});
    const Json json = parse_json(result.out, "eval", Exit::kFailure);
    EXPECT_LT(json["summary"][0]["rmse_overall_mean"].get<double>(), 0.0412)
        << kind << ": 0.04 N is the noise; trust " << trust.dump();
  }
}

TEST_F(Tools, TheSimulatorPredictsALoggedMotion) {
  ASSERT_EQ(run("sim", {"--sim", at("data/sim.json"), "--motion", at("data/test.csv"), "--out",
                        at("s.csv")})
                .exit_code,
            0);
  ASSERT_EQ(
      run("predict", {at("data/sim.json"), "--data", at("data/test.csv"), "--out", at("q.csv")})
          .exit_code,
      0);
  const Table simulated = read_csv(at("s.csv")), predicted = read_csv(at("q.csv"));
  const auto fz = std::find(simulated.columns.begin(), simulated.columns.end(), "fz") -
                  simulated.columns.begin();
  const auto hat = std::find(predicted.columns.begin(), predicted.columns.end(), "fz_hat") -
                   predicted.columns.begin();
  EXPECT_EQ(simulated.values.col(fz), predicted.values.col(hat));
}

struct Mistake {
  std::string name, verb;
  std::vector<std::string> arguments;
  int exit_code;
  std::string says;
};

TEST_F(Tools, EveryMistakeIsOneLineWithItsExitCode) {
  ASSERT_EQ(run("train", training("m.dcnn", {"--epochs", "1"})).exit_code, 0);
  std::ofstream(at("bad.csv")) << "t,alpha,beta,gamma,fx,fy,fz\n0,0,0,0,1,abc,3\n";
  std::ofstream(at("typo.json")) << R"({"training": {"epoch": 3}})";
  std::ofstream(at("broken.json")) << "{\"training\": }";
  std::ofstream(at("notes.dcnn")) << "these are notes, not a model";
  const std::vector<Mistake> mistakes{
      {"unknown flag", "train", {"--frobnicate"}, 2, "--help"},
      {"no arguments", "eval", {}, 2, "--help"},
      {"missing recording", "eval", {at("m.dcnn"), "--data", at("none.csv")}, 3, "none.csv"},
      {"missing training recording",
       "train",
       {"--train", at("none.csv"), "--out", at("x.dcnn")},
       3,
       "none.csv"},
      {"bad cell", "eval", {at("m.dcnn"), "--data", at("bad.csv")}, 3, "bad.csv:2"},
      {"not a model", "eval", {at("notes.dcnn"), "--data", at("data/test.csv")}, 4, "notes.dcnn"},
      {"missing model",
       "predict",
       {at("none.dcnn"), "--data", at("data/test.csv"), "--out", at("x.csv")},
       4,
       "none.dcnn"},
      {"unknown key", "train", training("x.dcnn", {"--config", at("typo.json")}), 2,
       "did you mean 'epochs'"},
      {"broken JSON", "train", training("x.dcnn", {"--config", at("broken.json")}), 2, "line 1"},
      {"unknown model", "train", training("x.dcnn", {"--model", "dcn"}), 2, "did you mean 'dcnn'"},
      {"bad level",
       "eval",
       {at("m.dcnn"), "--data", at("data/test.csv"), "--snr", "loud"},
       2,
       "loud"},
      {"unwritable output",
       "predict",
       {at("m.dcnn"), "--data", at("data/test.csv"), "--out", "/proc/none/x.csv"},
       1,
       "/proc/none"}};
  for (const Mistake& mistake : mistakes) {
    const Result result = run(mistake.verb, mistake.arguments);
    EXPECT_EQ(result.exit_code, mistake.exit_code) << mistake.name << ": " << result.err;
    EXPECT_NE(result.err.find(mistake.says), std::string::npos)
        << mistake.name << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1)
        << mistake.name << ": " << result.err;
    EXPECT_EQ(result.err.rfind("dcnn-" + mistake.verb + ": ", 0), 0u)
        << mistake.name << ": " << result.err;
  }
}

TEST_F(Tools, HelpTeachesWithExamples) {
  for (const char* verb : {"sim", "train", "eval", "predict"}) {
    const Result result = run(verb, {"--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("Examples:"), std::string::npos) << verb;
    EXPECT_EQ(run(verb, {"--version"}).exit_code, 0);
  }
}

}  // namespace
}  // namespace dcnn
