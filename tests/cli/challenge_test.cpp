// SPDX-License-Identifier: Apache-2.0
// tools/challenge with the programs of this build: made, sealed, diagnosed, scored, resumed.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "dcnn/core/json.h"
#include "support/page.h"
#include "support/process.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

int challenge(const std::string& arguments) {
  const std::string command = std::string(DCNN_SOURCE_DIR) + "/tools/challenge --bin " +
                              DCNN_BIN_DIR + " " + arguments + " >/dev/null 2>&1";
  return WEXITSTATUS(std::system(command.c_str()));
}

/// Twelve scenarios of seven groups, six where a sanitizer makes them slow. Groups are the same for
/// every seed; with this one the laws that no catalogue has are found in seconds.
constexpr int kScenarios = test::kSanitized ? 6 : 12;
const std::string kSet = "--scenarios " + std::to_string(kScenarios) + " --seed 7 --out ";

double rate(const Json& counted) {
  return counted["k"].get<double>() / std::max(1.0, counted["n"].get<double>());
}

TEST(ChallengeScript, RunsFromASeedToAReport) {
  const test::TemporaryFolder folder;
  const auto set = folder / "set";
  ASSERT_EQ(challenge(kSet + set.string()), 0);
  const Json scores = read_json(set / "scores.json", Exit::kData);
  EXPECT_EQ(scores["scenarios"].size(), static_cast<std::size_t>(kScenarios));
  EXPECT_TRUE(scores["missing"].empty());
  EXPECT_EQ(scores["sha256"].get<std::string>(), test::slurp(set / "seal.sha256").substr(0, 64));
  const Json& all = scores["tables"]["all"];
  EXPECT_EQ(all["ran"]["k"], kScenarios);
  EXPECT_GE(all["top1"]["n"].get<int>(), kScenarios / 2);
  EXPECT_GE(rate(all["top1"]), 0.6);
  EXPECT_GE(all["null_specificity"]["n"].get<int>(), 1);
  EXPECT_GE(rate(all["null_specificity"]), 0.8);
  EXPECT_LE(rate(all["false_discovery"]), 0.3);
  for (const Json& s : scores["scenarios"]) EXPECT_GT(s["seconds"].get<double>(), 0.0);
  const std::string page = test::slurp(set / "report.html");
  test::expect_usable_page(page);
  for (const Json& s : scores["scenarios"]) {
    for (const Json& id : s["hidden"]) {
      const std::string name = id.get<std::string>();
      if (name.find('_') == name.npos) continue;
      EXPECT_EQ(page.find(">" + name + "<"), page.npos) << name << ": figures name it in words";
    }
  }

  // Nothing that the diagnosis could see tells what is hidden.
  const Json answers = read_json(set.string() + ".sealed.json", Exit::kData);
  for (const Json& s : answers["scenarios"]) {
    const auto scenario = set / s["id"].get<std::string>();
    EXPECT_EQ(test::slurp(scenario / "sim.json").find("hidden"), std::string::npos);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scenario), {}),
              static_cast<std::ptrdiff_t>(s["sha256"].size()));
  }

  // The same command does nothing again: what is finished stays as it is, what was lost comes back
  // from the pack.
  const auto kept = set / "reports" / "s0001" / "run.json";
  const auto before = std::filesystem::last_write_time(kept);
  const std::string lost = test::slurp(set / "reports" / "s0002" / "report.json");
  std::filesystem::remove_all(set / "reports" / "s0002");
  ASSERT_EQ(challenge(kSet + set.string()), 0);
  EXPECT_EQ(std::filesystem::last_write_time(kept), before);
  EXPECT_EQ(test::slurp(set / "reports" / "s0002" / "report.json"), lost);
  EXPECT_EQ(challenge("--scenarios 3 --seed 1 --out " + set.string()), 2);
}

TEST(ChallengeScript, RivalsAndAblationsAreScoredOnTheSameFiles) {
  const test::TemporaryFolder folder;
  const auto set = folder / "set", log = set / "s0001";
  ASSERT_EQ(challenge("--scenarios 1 --seed 1 --out " + set.string()), 0);
  const std::vector<std::string> files{"--sim",     (log / "sim.json").string(),
                                       "--fit",     (log / "fit_0.csv").string(),
                                       "--holdout", (log / "holdout_0.csv").string()};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), files.begin(), files.end());
    return more;
  };
  const auto rivals =
      test::Process("rivals",
                    with({"-q", "--networks", "mlp", "--out", (set / "rivals" / "s0001").string()}))
          .wait();
  ASSERT_EQ(rivals.exit_code, 0) << rivals.err;
  const auto ablation =
      test::Process("diagnose", with({"-q", "--without", "refinement", "omnibus", "--out",
                                      (set / "ablations" / "refinement" / "s0001").string()}))
          .wait();
  ASSERT_EQ(ablation.exit_code, 0) << ablation.err;
  EXPECT_EQ(
      read_json(set / "ablations" / "refinement" / "s0001" / "report.json", Exit::kData)["without"],
      Json({"refinement", "omnibus"}));
  ASSERT_EQ(challenge("--scenarios 1 --seed 1 --out " + set.string()), 0);
  const Json scores = read_json(set / "scores.json", Exit::kData);
  for (const char* method :
       {"stlsq", "ensemble-stlsq", "lasso-1se", "lasso-min", "omp-bic", "greedy-bic", "mlp"}) {
    ASSERT_TRUE(scores["rivals"].contains(method)) << method;
    const Json& rates = scores["rivals"][method];
    EXPECT_GT(rates["seconds"]["median"].get<double>(), 0.0) << method;
    EXPECT_GT(rates["after_over_oracle"]["median"].get<double>(), 0.9) << method;
    EXPECT_EQ(rates.contains("ran"), std::string(method) != "mlp") << method;
  }
  EXPECT_EQ(scores["ablations"]["refinement"]["ran"]["n"], 1);
  const std::string page = test::slurp(set / "report.html");
  EXPECT_NE(page.find("the true law"), std::string::npos);
  EXPECT_NE(page.find("without refinement"), std::string::npos);
}

TEST(ChallengeScript, OneScenarioOfAKindTellsItsStory) {
  const test::TemporaryFolder folder;
  const auto set = folder / "set";
  ASSERT_EQ(challenge("--scenario single:1/viscous_friction/1 --seed 5 --out " + set.string()), 0);
  const Json scores = read_json(set / "scores.json", Exit::kData);
  ASSERT_EQ(scores["scenarios"].size(), 1U);
  EXPECT_EQ(scores["scenarios"][0]["named"], Json::array({"viscous_friction"}));
}

/// Processes other than this one whose arguments name the folder or that work in it.
int processes_of(const std::filesystem::path& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string id = entry.path().filename().string();
    if (id.find_first_not_of("0123456789") != std::string::npos) continue;
    if (std::stoi(id) == ::getpid()) continue;
    std::error_code gone;
    const auto at = std::filesystem::read_symlink(entry.path() / "cwd", gone).string();
    count +=
        (test::slurp(entry.path() / "cmdline") + at).find(folder.string()) != std::string::npos;
  }
  return count;
}

/// Diagnoses that work in a folder below this one.
int diagnoses_in(const std::filesystem::path& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::error_code gone;
    const auto at = std::filesystem::read_symlink(entry.path() / "cwd", gone).string();
    count +=
        at.starts_with(folder.string()) && test::slurp(entry.path() / "comm") == "dcnn-diagnose\n";
  }
  return count;
}

/// Waits up to a minute; false where it did not come true.
template <class Condition>
bool soon(const Condition& condition) {
  for (int k = 0; k < 1200 && !condition(); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return condition();
}

// A shell that runs a program does not look at signals until that ends, and every cell is a process
// group of its own.
TEST(ChallengeScript, StoppedItLeavesNothingRunningAndGoesOn) {
  const test::TemporaryFolder folder;
  const auto set = folder / "set";
  const std::string arguments = "--scenarios 2 --seed 3 --jobs 2 --out " + set.string();
  const std::string command = std::string("exec ") + DCNN_SOURCE_DIR + "/tools/challenge --bin " +
                              DCNN_BIN_DIR + " " + arguments;
  const pid_t script = ::fork();
  if (script == 0) {
    if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr))
      ::_exit(1);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  ASSERT_TRUE(soon([&] { return diagnoses_in(set) == 2; }));
  ::kill(script, SIGTERM);
  int status = 0;
  ::waitpid(script, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
  EXPECT_EQ(processes_of(set), 0);
  EXPECT_FALSE(std::filesystem::exists(set / "scores.json"));
  ASSERT_EQ(challenge(arguments), 0);
  EXPECT_EQ(read_json(set / "scores.json", Exit::kData)["tables"]["all"]["ran"]["k"], 2);
}

TEST(ChallengeScript, SkipsRealRecordingsThatAreNotThere) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(
      challenge("--out " + (folder / "real").string() + " --real " + (folder / "nowhere").string()),
      0);
}

TEST(ChallengeScript, TellsHowItIsUsed) {
  EXPECT_EQ(challenge("--help"), 0);
  EXPECT_EQ(challenge("--scenarios 2"), 2);
}

}  // namespace
}  // namespace dcnn
