// SPDX-License-Identifier: Apache-2.0
// dcnn-import as a user runs it.
#include <gtest/gtest.h>

#include <cstdlib>

#include "dcnn/core/json.h"
#include "dcnn/data/csv.h"
#include "import/logs.h"

namespace dcnn {
namespace {

using test::run;

const std::string kSample = DCNN_SOURCE_DIR "/data/sample/";

double largest_difference(const Table& a, const Table& b, const std::string& column, Index rows) {
  const auto at = [&](const Table& table) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), column);
    EXPECT_NE(found, table.columns.end()) << column;
    return found - table.columns.begin();
  };
  return (a.values.col(at(a)).head(rows) - b.values.col(at(b)).head(rows)).cwiseAbs().maxCoeff();
}

TEST(ImportTool, TheSampleAsABagOfRos2IsTheSampleAgain) {
  const test::TemporaryFolder folder;
  const auto result = run("import", {kSample + "log.mcap", "--out", (folder / "out").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("geometry_msgs/WrenchStamped"), std::string::npos) << result.out;
  EXPECT_EQ(result.err.find("would refuse"), std::string::npos) << result.err;
  const Table original = read_csv(kSample + "train.csv"), again = read_csv(folder / "out/log.csv");
  ASSERT_EQ(again.values.rows(), original.values.rows());
  for (const char* column : {"x", "y", "z", "fx", "fy", "fz", "tx", "ty", "tz"}) {
    EXPECT_EQ(largest_difference(original, again, column, original.values.rows()), 0.0) << column;
  }
}

TEST(ImportTool, AForeignTextIsTheSampleAgain) {
  const test::TemporaryFolder folder;
  const auto result = run("import", {kSample + "log.txt", "--out", (folder / "out").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table original = read_csv(kSample + "train.csv"), again = read_csv(folder / "out/log.csv");
  ASSERT_EQ(again.values.rows(), 1000);
  for (const char* column : {"t", "x", "fx", "tz"}) {
    EXPECT_LT(largest_difference(original, again, column, 1000), 1e-12) << column;
  }
}

TEST(ImportTool, EveryToolReadsALogByItsRecipe) {
  const test::TemporaryFolder folder;
  const std::string out = (folder / "out").string(), sim = kSample + "sim.json";
  ASSERT_EQ(run("import", {kSample + "log.mcap", "--out", out, "-q"}).exit_code, 0);
  const auto by_recipe = run("sim", {"--sim", sim, "--motion", kSample + "log.mcap", "--recipe",
                                     out + "/import.json", "--out", (folder / "a.csv").string()});
  ASSERT_EQ(by_recipe.exit_code, 0) << by_recipe.err;
  ASSERT_EQ(
      run("sim", {"--sim", sim, "--motion", out + "/log.csv", "--out", (folder / "b.csv").string()})
          .exit_code,
      0);
  EXPECT_EQ(test::slurp(folder / "a.csv"), test::slurp(folder / "b.csv"));
  const auto again = run("import", {kSample + "log.mcap", "--recipe", out + "/import.json", "--out",
                                    (folder / "again").string()});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(test::slurp(folder / "again/log.csv"), test::slurp(folder / "out/log.csv"));
  EXPECT_EQ(test::slurp(folder / "again/import.json"), test::slurp(folder / "out/import.json"));
}

TEST(ImportTool, WhatARecipeSaysIsNotSaidAgain) {
  const test::TemporaryFolder folder;
  const std::string out = (folder / "out").string(), recipe = out + "/import.json";
  ASSERT_EQ(run("import", {kSample + "log.txt", "--out", out, "-q"}).exit_code, 0);
  const std::vector<std::vector<std::string>> given{
      {"--map", "fx=Fz"}, {"--unit", "fx=mN"},  {"--gain", "fx=-1"}, {"--also", "Fx"},
      {"--use", "file1"}, {"--decimal", ","},   {"--rate", "100"},   {"--zeroed"},
      {"--assume"},       {"--resample", "50"}, {"--clock", "t"},    {"--payload", "1"}};
  for (const auto& option : given) {
    std::vector<std::string> words{kSample + "log.txt", "--recipe", recipe, "--dry-run"};
    words.insert(words.end(), option.begin(), option.end());
    const auto result = run("import", words);
    EXPECT_EQ(result.exit_code, 2) << option[0];
    EXPECT_NE(result.err.find(option[0]), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("--recipe"), std::string::npos) << result.err;
  }
  EXPECT_EQ(run("import", {kSample + "log.txt", "--recipe", recipe, "--dry-run", "--truncated"})
                .exit_code,
            0);
}

TEST(ImportTool, DryRunWritesNothingAndJsonIsOneDocument) {
  const test::TemporaryFolder folder;
  const auto result = run("import", {kSample + "log.mcap", "--dry-run", "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = parse_json(result.out, "import", Exit::kFailure);
  EXPECT_EQ(json["streams"].size(), 2U);
  EXPECT_EQ(json["recipe"]["clock"], Json("/ft/wrench"));
}

TEST(ImportTool, SaysInOneLineWhatItMustKnow) {
  const test::TemporaryFolder folder;
  test::spill(folder / "log.txt", "t fx fy fz\n0 1 2 3\n4 1 2 3\n8 1 2 3\n");
  const std::string log = (folder / "log.txt").string(), out = (folder / "out").string();
  const auto asked = run("import", {log, "--out", out, "-q"});
  EXPECT_EQ(asked.exit_code, 3);
  EXPECT_EQ(std::count(asked.err.begin(), asked.err.end(), '\n'), 1) << asked.err;
  EXPECT_NE(asked.err.find("--clock-unit ms"), std::string::npos) << asked.err;
  EXPECT_EQ(run("import", {log, "--clock-unit", "ms", "--out", out, "-q"}).exit_code, 0);
  EXPECT_EQ(run("import", {log, "--out", out, "-q"}).exit_code, 2);  // the result is kept
  EXPECT_EQ(run("import", {log}).exit_code, 2);
  EXPECT_EQ(run("import", {(folder / "none.bag").string(), "--dry-run"}).exit_code, 3);
}

TEST(ImportTool, SaysThatARobotDescriptionIsNotUsed) {
  const test::TemporaryFolder folder;
  test::spill(folder / "log.csv",
              "t,alpha,beta,gamma,fx,fy,fz\n0,0,0,0.1,1,2,3\n0.1,0,0,0.2,1,2,3\n"
              "0.2,0,0,0.3,1,2,3\n");
  const auto result =
      run("import", {folder / "log.csv", "--dry-run", "--urdf", "robot.urdf", "--link", "tool"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("--urdf is not used"), std::string::npos) << result.err;
}

TEST(ImportTool, SaysHowToNameTheChannelsOfAnAxis) {
  const test::TemporaryFolder folder;
  test::spill(folder / "log.txt", "0\t0.1\t-8\n10\t0.2\t-7\n20\t0.3\t-3\n30\t0.4\t-3\n");
  const std::string log = (folder / "log.txt").string();
  const std::vector<std::string> named{log, "--columns", "time_ms", "a", "b"};
  auto dry = named;
  dry.push_back("--dry-run");
  const std::string proposed = run("import", dry).out;
  EXPECT_NE(proposed.find("such as: dcnn-import " + log +
                          " --columns time_ms a b --map q:1=a --map tau:1=b --clock time_ms "
                          "--out imported ("),
            std::string::npos)
      << proposed;
  auto with_rate = named;
  with_rate.insert(with_rate.end(), {"--rate", "100", "--out", (folder / "other").string()});
  const auto refusal = run("import", with_rate);
  EXPECT_EQ(refusal.exit_code, 3);
  const std::string refused = refusal.out + refusal.err;
  EXPECT_NE(refused.find("b --rate 100 --out " + (folder / "other").string() +
                         " --map q:1=a --map tau:1=b ("),
            std::string::npos)
      << refused;
  auto said = named;
  said.insert(said.end(), {"--clock", "time_ms", "--clock-unit", "ms", "--map", "q:1=a", "--map",
                           "tau:1=b", "--out", (folder / "out").string()});
  const auto result = run("import", said);
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

/// The commands of the page, in the order in which a reader comes to them.
TEST(ImportTool, CommandsOfThePageRunAsTheyStandThere) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory_symlink(DCNN_SOURCE_DIR "/data", folder / "data");
  std::ifstream page(DCNN_SOURCE_DIR "/docs/use/import.md");
  int count = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("    dcnn-import") && !line.starts_with("    dcnn-sim")) continue;
    ++count;
    const std::string command = "cd '" + folder.path().string() +
                                "' && PATH=" DCNN_BIN_DIR ":$PATH " + line + " > printed 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << line << "\n" << test::slurp(folder / "printed");
  }
  EXPECT_GE(count, 4);
}

}  // namespace
}  // namespace dcnn
