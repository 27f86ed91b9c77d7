// SPDX-License-Identifier: Apache-2.0
// No model is shown without what it must beat.
#include "experiment/references.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn {
namespace {

const std::string kTrain = DCNN_SOURCE_DIR "/data/sample/train.csv";
const std::string kTest = DCNN_SOURCE_DIR "/data/sample/test.csv";

TEST(References, WhiteNoiseIsFoundUnderSmoothMotion) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.04);
  Eigen::MatrixXd y(20000, 1);
  for (Eigen::Index k = 0; k < y.rows(); ++k) {
    y(k, 0) = 8.0 * std::sin(0.01 * static_cast<double>(k)) + noise(random);
  }
  EXPECT_NEAR(white_noise(y)[0], 0.04, 0.002);
}

TEST(References, WarnOfATargetWorseThanZeroAndOfAModelWorseThanTheRigidTool) {
  const References references{{1.0, 1.0}, {0.2, 0.2}, {0.01, 0.01}};
  const Targets targets{{"fx", "fy"}, {"N", "N"}};
  EXPECT_TRUE(warnings("m", {0.1, 0.2}, references, targets).empty());
  const auto lines = warnings("m", {1.5, 0.2}, references, targets);
  ASSERT_EQ(lines.size(), 1U) << "what is decisive stands first";
  EXPECT_NE(lines[0].find("fx is predicted worse than by zero (1.5 against 1 N)"),
            std::string::npos)
      << lines[0];
  EXPECT_NE(lines[0].find("times that of the rigid tool"), std::string::npos) << lines[0];
}

TEST(References, StandBesideEveryModelOfTrainAndEval) {
  const test::TemporaryFolder folder;
  const std::string model = folder / "cf.dcnn";
  const auto trained =
      test::run("train", {"-q", "--model", "cf", "--train", kTrain, "--out", model});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_TRUE(trained.out.starts_with("cf.dcnn: its error is ")) << trained.out;
  EXPECT_NE(trained.out.find("rigid tool"), std::string::npos);
  const auto scored = test::run(
      "eval", {model, "--data", kTest, "--snr", "clean", "--json", "--out", folder / "page"});
  const std::string page = test::slurp(folder / "page/report.html");  // shows no target twice
  EXPECT_NE(page.find("The other targets over time"), std::string::npos);
  EXPECT_EQ(page.find("Prediction over time"), std::string::npos);
  const Json json = parse_json(scored.out, "eval", Exit::kFailure);
  const Json& references = json["references"];
  EXPECT_NEAR(references["white_noise"][0].get<double>(), 0.04, 0.003);
  EXPECT_LT(references["rigid_overall"].get<double>(),
            0.25 * json["summary"][0]["rmse_overall_mean"].get<double>());
  EXPECT_EQ(json["warnings"].size(), 1U);
}

TEST(References, EachModelIsJudgedByTheRigidToolOfItsOwnDerivativeInAnyOrder) {
  const test::TemporaryFolder folder;
  const std::string smooth = folder / "smooth.dcnn", causal = folder / "causal.dcnn";
  const auto train = [](const std::vector<std::string>& words) {
    std::vector<std::string> all{"-q", "--train", kTrain};
    all.insert(all.end(), words.begin(), words.end());
    return test::run("train", all).exit_code;
  };
  ASSERT_EQ(train({"--model", "cf", "--out", smooth}), 0);
  ASSERT_EQ(train({"--model", "rigid", "--online", "--out", causal}), 0);
  std::vector<std::vector<std::string>> warnings;
  for (const auto& models : {std::vector{smooth, causal}, std::vector{causal, smooth}}) {
    auto words = models;
    words.insert(words.end(), {"--data", kTest, "--snr", "clean"});
    const std::string text = test::run("eval", words).out;
    for (const char* name : {"(rigid tool of smooth.run)", "(rigid tool of causal.run)"}) {
      EXPECT_NE(text.find(name), std::string::npos) << text;
    }
    words.emplace_back("--json");
    const auto scored = test::run("eval", words);
    const Json json = parse_json(scored.out, "eval", Exit::kFailure);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(json["summary"][i]["rigid_file"].get<std::string>(),
                std::filesystem::path(models[i]).replace_extension(".run") / "rigid.dcnn");
    }
    warnings.push_back(json["warnings"].get<std::vector<std::string>>());
    std::sort(warnings.back().begin(), warnings.back().end());
  }
  EXPECT_EQ(warnings[0], warnings[1]);
}

TEST(References, AModelWithoutItsRunDirectorySaysWhatIsMissing) {
  const test::TemporaryFolder folder;
  const std::string model = folder / "home/cf.dcnn", away = folder / "away/cf.dcnn";
  ASSERT_EQ(
      test::run("train", {"-q", "--model", "cf", "--train", kTrain, "--out", model}).exit_code, 0);
  const auto evaluated = [&](const std::string& file) {
    return test::run("eval", {file, "--data", kTest, "--snr", "clean"});
  };
  const auto home = evaluated(model);
  EXPECT_NE(home.out.find("which is " + (folder / "home/cf.run/rigid.dcnn").string()),
            std::string::npos)
      << home.out;
  EXPECT_EQ(home.err.find("is missing"), std::string::npos) << home.err;
  std::filesystem::create_directories(folder / "away");
  std::filesystem::copy_file(model, away);
  const auto copied = evaluated(away);
  EXPECT_EQ(copied.exit_code, 0) << copied.err;
  EXPECT_NE(copied.err.find("the rigid tool that dcnn-train fitted beside it, " +
                            (folder / "away/cf.run/rigid.dcnn").string() + ", is missing"),
            std::string::npos)
      << copied.err;
}

TEST(References, AModelThatIsASimulatorSaysSoAndCountsNoParameters) {
  const test::TemporaryFolder folder;
  const std::string simulator = folder / "model.json";
  Json json = read_json(DCNN_SOURCE_DIR "/data/sample/sim.json", Exit::kData);
  json["effects"] = Json::array({Json{{"effect", "coulomb_friction"},
                                      {"axis", "tool_z"},
                                      {"parameters", {{"fc_n", 0.4}, {"v0_mps", 0.01}}}}});
  std::ofstream(simulator) << json.dump();
  const auto trained = [&](const std::string& kind) {
    return test::run("train", {"-q", "--model", kind, "--base", simulator, "--preset", "quick",
                               "--train", kTrain, "--out", folder / (kind + ".dcnn")});
  };
  const auto alone = trained("ns"), beside = trained("cf");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_NE(alone.out.find("ns.dcnn (simulator with dry friction)\n"), std::string::npos)
      << alone.out;
  EXPECT_NE(beside.out.find(" parameters beside a simulator with dry friction)\n"),
            std::string::npos)
      << beside.out;
  const auto scored = [&](const char* where) {
    return test::run("eval", {folder / "ns.dcnn", "--data", kTest, "--snr", "clean,20", "--runs",
                              "2", "--noise-on", where, "--json"});
  };
  const auto noisy = scored("pose"), spared = scored("features");
  ASSERT_EQ(noisy.exit_code, 0) << noisy.err;
  const Json summary = parse_json(noisy.out, "eval", Exit::kFailure)["summary"];
  EXPECT_GT(summary[1]["rmse_mean"][0].get<double>(),
            2.0 * summary[0]["rmse_mean"][0].get<double>())
      << "noise on the pose reaches the simulator";
  EXPECT_NE(spared.err.find("--noise-on pose shows"), std::string::npos) << spared.err;
}

TEST(References, AutoKeepsTheBestAndSaysWhy) {
  const test::TemporaryFolder folder;
  const std::string model = folder / "best.dcnn";
  const auto result = test::run("train", {"-q", "--model", "auto", "--preset", "quick", "--epochs",
                                          "1", "--train", kTrain, "--out", model, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json choice = parse_json(result.out, "train", Exit::kFailure)["choice"];
  EXPECT_EQ(choice["model"], "physics") << "the sample's tool has dry friction";
  EXPECT_EQ(choice["tried"].size(), 5U);
  const std::string why = choice["why"];
  EXPECT_NE(why.find("rigid (trained like the others) "), std::string::npos) << why;
  EXPECT_NE(why.find("rigid tool (the reference, "), std::string::npos) << why;
  const double least = choice["tried"][1]["relative_error"];
  EXPECT_LT(least, 0.05);
  for (const Json& one : choice["tried"]) EXPECT_GE(one["relative_error"].get<double>(), least);
  const auto scored = test::run("eval", {model, "--data", kTest, "--snr", "clean", "--json"});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const Json score = parse_json(scored.out, "eval", Exit::kFailure);
  EXPECT_TRUE(score["warnings"].empty()) << scored.out;
  EXPECT_LT(score["summary"][0]["rmse_mean"][2].get<double>(),
            0.25 * score["references"]["rigid"][2].get<double>())
      << scored.out;
  // What it was fitted to ends a second before the validation rows.
  const std::string rows = test::slurp(folder / "best.run/physics/train_0.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 2900);
}

TEST(References, AutoAnswersASignalInItsDiagnosisAndGoesOn) {
  const test::TemporaryFolder folder;
  const std::string model = folder / "best.dcnn";
  const std::vector<std::string> words{"--model", "auto",    "--preset", "quick", "--epochs",
                                       "1",       "--train", kTrain,     "--out", model};
  const test::Process process("train", words);
  // The identification has written its simulator: the diagnosis has begun.
  while (!std::filesystem::exists(folder / "best.run/physics/sim.json")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  process.signal(SIGINT);
  const auto stopped = process.wait();
  EXPECT_EQ(stopped.exit_code, 75) << stopped.err;
  EXPECT_FALSE(std::filesystem::exists(model));
  EXPECT_FALSE(std::filesystem::exists(folder / "best.run/physics/model.json"));
  EXPECT_NE(stopped.err.find("go on with the same command and --resume"), std::string::npos)
      << stopped.err;
  auto again = words;
  again.emplace_back("--resume");
  const auto done = test::run("train", again);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(done.out.starts_with("chosen: physics")) << done.out;
}

TEST(References, AutoForUseOnlineSaysWhyPhysicsIsLeftOut) {
  const test::TemporaryFolder folder;
  const std::string model = folder / "best.dcnn";
  const auto result = test::run("train", {"--model", "auto", "--online", "--preset", "quick",
                                          "--epochs", "1", "--train", kTrain, "--out", model});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("physics is left out: with --online"), std::string::npos) << result.err;
  EXPECT_TRUE(result.out.starts_with("chosen: ")) << result.out;
  const auto served = test::run("run", {"--model", model, "--stdin", "-q"}, {.input = kTest});
  EXPECT_EQ(served.exit_code, 0) << served.err;
}

}  // namespace
}  // namespace dcnn
