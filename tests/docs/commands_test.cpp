// SPDX-License-Identifier: Apache-2.0
// Every command of docs/use and of the README runs as it stands there, or has its reason here.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "dcnn/core/json.h"
#include "support/process.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

struct NotRun {
  const char* command;  ///< how it begins
  const char* why;
};

/// The one list of commands that the tests do not run.
const std::vector<NotRun> kNotRun{
    {"tools/demo", "builds everything"},
    {"tools/test", "runs this"},
    {"export PATH=", "names the folder of a build; the test has its own"},
    {"cmake ", "configures, builds or installs; tests/consumer.cmake does"},
    {"build/examples/robot_loop", "tests/consumer.cmake builds it, it needs a robot's other end"},
    {"tools/teleop-live", "90 seconds of real time"},
    {"tools/hybrid", "minutes"},
    {"dcnn-run --model m.dcnn --fallback data/sample/sim.json --listen",
     "waits for packets until it is ended; tests/cli/run_test.cpp"},
    {"dcnn-calibrate --static static_24_poses.csv", "recordings of others (docs/results/real.md)"},
    {"dcnn-diagnose --system configs/systems/emps.json",
     "recordings of others (docs/results/real.md)"},
    {"dcnn diagnose --sim data/sample", "the command of docs/use/first-log.md by its other name"},
    {"dcnn-forward report/model.json", "the log of a machine; tests/cli/forward_test.cpp"},
    {"dcnn-identify a.csv", "logs of the reader's own arm; tests/cli/identify_test.cpp"},
    {"dcnn-teleop --model", "a minute; tests/cli/teleop_test.cpp runs it with less"},
};

/// Without what a reader is told beside it.
std::string without_comment(const std::string& command) {
  const std::string text = command.substr(0, command.find(" #"));
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// Commands of a page: indented lines of a block, those that end in a backslash joined.
std::vector<std::string> commands_of(const std::filesystem::path& page) {
  static const std::set<std::string> kPrograms{"cc", "cmake", "export", "echo"};
  std::ifstream file(page);
  std::vector<std::string> commands;
  bool goes_on = false, list = false;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != ' ') list = line.starts_with("- ") || line.starts_with("1.");
    if (goes_on) {
      commands.back() += "\n" + line;
    } else if (line.starts_with("    ") && !list) {
      const std::string text = line.substr(4), word = text.substr(0, text.find(' '));
      const bool ours = word == "dcnn" || word.starts_with("dcnn-") || word.starts_with("tools/") ||
                        word.starts_with("./") || word.starts_with("build/");
      if (!ours && !kPrograms.contains(word)) continue;
      commands.push_back(text);
    } else {
      continue;
    }
    goes_on = line.ends_with("\\");
  }
  return commands;
}

const NotRun* reason_of(const std::string& command) {
  const auto found = std::find_if(kNotRun.begin(), kNotRun.end(), [&](const NotRun& entry) {
    return command.starts_with(entry.command);
  });
  return found == kNotRun.end() ? nullptr : &*found;
}

/// A folder like a clone: what commands read is there, what they write goes with it.
class Clone {
 public:
  Clone() {
    // Copies: what a command writes to one of these folders must not reach the source.
    const std::filesystem::path source = DCNN_SOURCE_DIR;
    for (const char* name : {"data/sample", "configs", "examples"}) {
      std::filesystem::create_directories((folder_ / name).parent_path());
      std::filesystem::copy(source / name, folder_ / name,
                            std::filesystem::copy_options::recursive);
    }
  }

  /// Logs of the reader's own: 2 s of the sample recording, by the libraries of their formats.
  /// Where Debian's Python lacks one, the commands that read its log are left out.
  void add_logs() {
    std::ifstream sample(folder_ / "data/sample/train.csv");
    std::ofstream rows(folder_ / "rows.csv");
    std::string line;
    for (int k = 0; k <= 1000 && std::getline(sample, line); ++k) rows << line << "\n";
    rows.close();
    for (const std::string kind : {"bag", "db3", "mat"}) {
      const int status =
          std::system(("cd '" + folder_.path().string() +
                       "' && /usr/bin/python3 '" DCNN_SOURCE_DIR "/tests/import/write_logs.py' " +
                       kind + " log." + kind + " none rows.csv")
                          .c_str());
      if (WEXITSTATUS(status) == 77) {
        missing_.push_back(kind);
      } else {
        EXPECT_EQ(status, 0) << kind;
      }
    }
  }
  bool lacks(const std::string& command) const {
    return std::any_of(missing_.begin(), missing_.end(), [&](const std::string& kind) {
      return command.find("log." + kind) != command.npos ||
             command.find("from-" + kind) != command.npos;
    });
  }

  testing::AssertionResult run(const std::string& command) const {
    std::ofstream(folder_ / "command") << command << "\n";
    const std::string line =
        "cd '" + folder_.path().string() +
        "' && env OMP_WAIT_POLICY=passive PATH=" DCNN_BIN_DIR ":$PATH CPATH=" DCNN_SOURCE_DIR
        "/include LIBRARY_PATH=" DCNN_BINARY_DIR "/lib LD_LIBRARY_PATH=" DCNN_BINARY_DIR
        "/lib timeout 400 bash command > printed 2>&1";
    if (std::system(line.c_str()) == 0) return testing::AssertionSuccess();
    return testing::AssertionFailure() << test::slurp(folder_ / "printed");
  }
  std::string text(const std::string& name) const { return test::slurp(folder_ / name); }
  /// What the last command printed.
  std::string printed() const { return test::slurp(folder_ / "printed"); }
  bool has(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

 private:
  test::TemporaryFolder folder_;
  std::vector<std::string> missing_;  // kinds of logs that no library here writes
};

/// Pages in the order in which a reader comes to them: later ones use what earlier ones wrote.
const std::vector<const char*> kPages{"first-log.md", "import.md",    "check.md", "identify.md",
                                      "diagnose.md",  "discover.md",  "train.md", "export.md",
                                      "outputs.md",   "calibrate.md", "run.md",   "teleop.md",
                                      "cluster.md"};

TEST(DocumentedCommands, OfEveryPageRunOrSayWhyNot) {
  if (test::kSanitized) GTEST_SKIP() << "as any program under sanitizers, by tests of its own";
  Clone clone;
  clone.add_logs();
  std::set<std::string> done;
  for (const char* page : kPages) {
    for (const std::string& command :
         commands_of(std::string(DCNN_SOURCE_DIR "/docs/use/") + page)) {
      if (reason_of(command) || clone.lacks(command)) continue;
      if (!done.insert(without_comment(command)).second) continue;
      EXPECT_TRUE(clone.run(command)) << page << ": " << command;
    }
  }
  EXPECT_GE(done.size(), 18U);
  // From every kind of log to the same verdict.
  std::set<std::string> found;
  for (const char* log : {"from-bag", "from-db3", "from-mcap", "from-mat", "from-text"}) {
    if (clone.lacks(log)) continue;
    const Json report = Json::parse(clone.text(log + std::string("-report/report.json")));
    EXPECT_EQ(report["verdict"], "explained") << log;
    for (const Json& finding : report["findings"]) found.insert(finding["effect"]);
  }
  EXPECT_EQ(found, std::set<std::string>{"coulomb_friction"});
  for (const char* written : {"report/report.html", "evaluation/report.html", "mlp.onnx",
                              "calibration.html", "external.csv", "teleop/report.html"}) {
    EXPECT_TRUE(clone.has(written)) << written;
  }
}

/// What a command runs as: the README's `auto` takes minutes, `rigid` seconds; references_test.cpp
/// trains `auto` on the sample.
std::string affordable(std::string command) {
  const std::string automatic = "--model auto";
  const auto at = command.find(automatic);
  return at == command.npos ? command : command.replace(at, automatic.size(), "--model rigid");
}

/// The last cell of the line of a table that begins with `row`.
std::string last_cell(const std::string& table, const std::string& row) {
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(row)) continue;
    const auto end = line.find_last_not_of(' ');
    return line.substr(line.rfind(' ', end) + 1, end - line.rfind(' ', end));
  }
  return "nothing";
}

/// Its digits of no identification and the rigid tool are what dcnn-eval prints.
TEST(DocumentedCommands, OfTheReadmeRunOrSayWhyNot) {
  if (test::kSanitized) GTEST_SKIP() << "as any program under sanitizers, by tests of its own";
  const Clone clone;
  std::string scores;
  for (const std::string& command : commands_of(DCNN_SOURCE_DIR "/README.md")) {
    if (reason_of(command)) continue;
    EXPECT_TRUE(clone.run(affordable(command))) << command;
    if (command.starts_with("dcnn-eval ")) scores = clone.printed();
  }
  const std::string digits = "\n| " + last_cell(scores, "(no identification)") + " N | " +
                             last_cell(scores, "(rigid tool)") + " N | **";
  EXPECT_NE(test::slurp(DCNN_SOURCE_DIR "/README.md").find(digits), std::string::npos)
      << digits << "\n"
      << scores;
}

/// The README's first result, a quotation, is a line that its first command prints.
TEST(DocumentedCommands, TheReadmesFirstResultIsWhatItsCommandPrints) {
  if (test::kSanitized) GTEST_SKIP() << "as any program under sanitizers, by tests of its own";
  const Clone clone;
  for (const std::string& command : commands_of(DCNN_SOURCE_DIR "/README.md")) {
    if (!command.starts_with("dcnn diagnose")) continue;
    ASSERT_TRUE(clone.run(command)) << command;
    const std::string readme = test::slurp(DCNN_SOURCE_DIR "/README.md");
    const auto at = readme.find("\n> ");
    ASSERT_NE(at, readme.npos);
    const std::string quoted = readme.substr(at + 3, readme.find('\n', at + 1) - at - 2);
    EXPECT_NE(("\n" + clone.printed()).find("\n" + quoted), std::string::npos)
        << quoted << clone.printed();
    return;
  }
  FAIL() << "the README has no command that begins with dcnn diagnose";
}

TEST(DocumentedCommands, AreOfKnownPagesAndTheListIsNotStale) {
  std::string all;
  std::set<std::string> pages;
  for (const auto& entry : std::filesystem::directory_iterator(DCNN_SOURCE_DIR "/docs/use")) {
    pages.insert(entry.path().filename());
    for (const auto& command : commands_of(entry.path())) all += "\n" + command;
  }
  for (const auto& command : commands_of(DCNN_SOURCE_DIR "/README.md")) all += "\n" + command;
  for (const auto& page : pages) {
    if (commands_of(std::string(DCNN_SOURCE_DIR "/docs/use/") + page).empty()) continue;
    EXPECT_TRUE(std::find(kPages.begin(), kPages.end(), page) != kPages.end())
        << page << " has commands and is not in the list of pages";
  }
  for (const NotRun& entry : kNotRun) {
    EXPECT_NE(all.find(std::string("\n") + entry.command), all.npos) << entry.command;
  }
}

}  // namespace
}  // namespace dcnn
