// tools/challenge with the programs of this build: made, sealed, diagnosed, scored, resumed.
#include <gtest/gtest.h>

#include <cstdlib>

#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn {
namespace {

int challenge(const std::string& arguments) {
  const std::string command = std::string(DCNN_SOURCE_DIR) + "/tools/challenge --bin " +
                              DCNN_BIN_DIR + " " + arguments + " >/dev/null 2>&1";
  return WEXITSTATUS(std::system(command.c_str()));
}

TEST(ChallengeScript, RunsFromASeedToAReport) {
  const test::TemporaryFolder folder;
  const auto set = folder / "set";
  ASSERT_EQ(challenge("--scenarios 2 --seed 4 --out " + set.string()), 0);
  const Json scores = read_json(set / "scores.json", Exit::kData);
  EXPECT_EQ(scores["scenarios"].size(), 2U);
  EXPECT_TRUE(scores["missing"].empty());
  EXPECT_EQ(scores["sha256"].get<std::string>(), test::slurp(set / "seal.sha256").substr(0, 64));
  EXPECT_EQ(scores["tables"]["all"]["ran"]["k"], 2);
  for (const Json& s : scores["scenarios"]) EXPECT_GT(s["seconds"].get<double>(), 0.0);
  const std::string page = test::slurp(set / "report.html");
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);

  // Nothing that the diagnosis could see tells what is hidden.
  const Json answers = read_json(set.string() + ".sealed.json", Exit::kData);
  for (const Json& s : answers["scenarios"]) {
    const auto scenario = set / s["id"].get<std::string>();
    EXPECT_EQ(test::slurp(scenario / "sim.json").find("hidden"), std::string::npos);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scenario), {}),
              static_cast<std::ptrdiff_t>(s["sha256"].size()));
  }

  // The same command goes on where it was stopped: what is finished stays as it is.
  const auto kept = set / "reports" / "s0001" / "run.json";
  const auto before = std::filesystem::last_write_time(kept);
  ASSERT_EQ(challenge("--scenarios 2 --seed 4 --out " + set.string()), 0);
  EXPECT_EQ(std::filesystem::last_write_time(kept), before);
  EXPECT_EQ(challenge("--scenarios 3 --seed 4 --out " + set.string()), 2);
}

TEST(ChallengeScript, TellsHowItIsUsed) {
  EXPECT_EQ(challenge("--help"), 0);
  EXPECT_EQ(challenge("--scenarios 2"), 2);
}

}  // namespace
}  // namespace dcnn
