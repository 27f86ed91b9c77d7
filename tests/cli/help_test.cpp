// SPDX-License-Identifier: Apache-2.0
// One table of options: --help, manual page and completions of every program say the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>

#include "support/process.h"

namespace dcnn {
namespace {

using Names = std::set<std::string>;

std::vector<std::string> verbs() {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(DCNN_BIN_DIR)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("dcnn-") && !name.starts_with("dcnn-peer-")) all.push_back(name.substr(5));
  }
  return all;
}

Names matches(const std::string& text, const std::string& pattern) {
  Names found;
  const std::regex regex(pattern);
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) {
    found.insert((*match)[1]);
  }
  return found;
}

/// Long names at the beginning of a help's line: "  --out FILE" or "  -q, --quiet".
Names in_help(const std::string& text) { return matches(text, "\n  (?:-[a-z], )?(--[a-z-]+)"); }

/// Long names that a fish completion has for this command.
Names in_fish(const std::string& text, const std::string& command) {
  Names names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("complete -c " + command + " ")) continue;
    for (const auto& word : matches(line, "^[^\\[]*? -l ([a-z-]+)")) names.insert("--" + word);
  }
  return names;
}

TEST(Help, NamesTheSameOptionsAsManualAndCompletions) {
  for (const std::string& verb : verbs()) {
    SCOPED_TRACE(verb);
    const test::TemporaryFolder folder;
    const std::string name = "dcnn-" + verb;
    const auto help = test::run(verb, {"--help"});
    ASSERT_EQ(help.exit_code, 0);
    ASSERT_EQ(test::run(verb, {"--describe", folder.path()}).exit_code, 0);
    const Names options = in_help(help.out);
    EXPECT_TRUE(options.count("--help") && options.count("--json"));

    std::string page = test::slurp(folder / ("man1/" + name + ".1"));
    page = std::regex_replace(page, std::regex("\\\\-"), "-");
    EXPECT_EQ(matches(page, "\n\\.B (?:-[a-z], )?(--[a-z-]+)"), options);
    const std::string bash = test::slurp(folder / ("bash/" + name));
    const std::string words = bash.substr(bash.rfind("compgen -W"));
    EXPECT_EQ(matches(words, "(--[a-z][a-z-]*)"), options);
    EXPECT_EQ(matches(test::slurp(folder / ("zsh/_" + name)), "\n  '\\*?(--[a-z-]+)\\["), options);
    const std::string fish = test::slurp(folder / ("fish/" + name + ".fish"));
    EXPECT_EQ(in_fish(fish, name), options);
    EXPECT_EQ(in_fish(fish, "dcnn -n '__fish_seen_subcommand_from " + verb + "'"), options);
  }
}

TEST(Help, IsShortAndSetsTheExitCodeWhereNothingIsGiven) {
  for (const std::string& verb : verbs()) {
    SCOPED_TRACE(verb);
    const auto result = test::run(verb, {});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.out.find("Usage: dcnn-" + verb), std::string::npos);
    EXPECT_NE(result.out.find("--help has all options"), std::string::npos);
    EXPECT_EQ(result.err, "dcnn-" + verb + ": nothing to do; see dcnn-" + verb + " --help\n");
  }
}

/// A command that draws nothing has no seed, and one that computes next to nothing no threads.
TEST(Help, ShowsOnlyOptionsThatDoSomething) {
  const Names seeded{"bench",     "conceal", "design", "eval", "live",
                     "reproduce", "sim",     "teleop", "train"};
  const Names idle{"calibrate", "conceal", "import", "live", "run", "sim", "sweep", "teleop"};
  for (const std::string& verb : verbs()) {
    SCOPED_TRACE(verb);
    const Names options = in_help(test::run(verb, {"--help"}).out);
    EXPECT_EQ(options.contains("--seed"), seeded.contains(verb));
    EXPECT_NE(options.contains("--threads"), idle.contains(verb));
  }
}

TEST(Help, NamesAMistypedOptionBeforeWhatIsMissingWithoutIt) {
  const auto typo = test::run("train", {"--trian", "a.csv"});
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_NE(typo.err.find("did you mean --train?"), std::string::npos) << typo.err;
  EXPECT_EQ(typo.err.find("required"), std::string::npos) << typo.err;
  const auto range = test::run("train", {"--train", "a", "--out", "b", "--threads", "5000"});
  EXPECT_NE(range.err.find("5000 is not between 1 and 1024"), std::string::npos) << range.err;
  const auto word = test::run("train", {"--train", "a", "--out", "b", "--preset", "quik"});
  EXPECT_NE(word.err.find("did you mean 'quick'?"), std::string::npos) << word.err;
}

TEST(Scripts, RefuseAMistypedOptionBeforeTheyDoAnything) {
  int scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(DCNN_SOURCE_DIR "/tools")) {
    if (!entry.is_regular_file() || entry.path().has_extension()) continue;
    const std::string script = entry.path();
    const int status =
        std::system(("timeout 20 " + script + " --nonsense < /dev/null > /dev/null 2>&1").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2) << script;
    ++scripts;
  }
  EXPECT_GT(scripts, 20);
}

TEST(Dispatch, ListsEveryProgramAndRunsIt) {
  const auto dcnn = [](const std::string& arguments) {
    FILE* pipe = ::popen((DCNN_BIN_DIR "/dcnn " + arguments + " 2>&1").c_str(), "r");
    std::string text;
    for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
    const int status = ::pclose(pipe);
    return std::pair(WEXITSTATUS(status), text);
  };
  const std::string list = dcnn("").second;
  for (const std::string& verb : verbs()) {
    EXPECT_TRUE(std::regex_search(list, std::regex("\n  " + verb + " +[A-Z]"))) << verb << "\n"
                                                                                << list;
  }
  EXPECT_EQ(list.find("Other:"), std::string::npos) << "a verb without a group";
  std::istringstream lines(list);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  EXPECT_EQ(dcnn("help train").second, test::run("train", {"--help"}).out);
  EXPECT_EQ(dcnn("train --help").second, test::run("train", {"--help"}).out);
  EXPECT_EQ(dcnn("--version").first, 0);
  const auto [code, words] = dcnn("diagnos");
  EXPECT_EQ(code, 2);
  EXPECT_NE(words.find("did you mean 'diagnose'?"), std::string::npos) << words;
}

/// Every program of a folder of the source that is run by its name.
std::vector<std::filesystem::path> scripts_of(const std::string& folder) {
  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::directory_iterator(DCNN_SOURCE_DIR "/" + folder)) {
    const bool runs = (entry.status().permissions() & std::filesystem::perms::owner_exec) !=
                      std::filesystem::perms::none;
    if (entry.is_regular_file() && runs) all.push_back(entry.path());
  }
  return all;
}

TEST(Scripts, PrintTheirHelpAndDoNothing) {
  const test::TemporaryFolder folder;
  std::size_t count = 0;
  for (const char* place : {"tools", "bench", ".ci"}) {
    for (const auto& script : scripts_of(place)) {
      const std::string command = "cd '" + folder.path().string() + "' && timeout 10 '" +
                                  script.string() + "' --help > out.txt 2>&1";
      EXPECT_EQ(std::system(command.c_str()), 0) << script;
      const std::string text = test::slurp(folder / "out.txt");
      EXPECT_GE(std::count(text.begin(), text.end(), '\n'), 2) << script;
      EXPECT_NE(text.find(script.filename().string()), text.npos)
          << script << " does not name itself";
      EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << script;
      ++count;
    }
  }
  EXPECT_GE(count, 20U);
}

}  // namespace
}  // namespace dcnn
