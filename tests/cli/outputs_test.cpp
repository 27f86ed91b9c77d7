// SPDX-License-Identifier: Apache-2.0
// Results and inputs survive every command line (docs/use/outputs.md).
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "dcnn/core/claims.h"
#include "dcnn/core/file.h"
#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn {
namespace {

using Arguments = std::vector<std::string>;

struct Case {
  const char* verb;
  Arguments arguments;   ///< "@x" is x in the test's folder
  const char* precious;  ///< the file that must survive
  const char* words;     ///< of the refusal
};

class Outputs : public ::testing::TestWithParam<Case> {
 protected:
  std::string at(const std::string& name) const { return folder_ / name; }
  Arguments placed(Arguments arguments) const {
    for (auto& word : arguments) {
      if (word.starts_with("@")) word = at(word.substr(1));
    }
    return arguments;
  }

  test::TemporaryFolder folder_;
};

TEST_P(Outputs, AreRefusedWhereSomethingWouldBeDestroyed) {
  const Case& c = GetParam();
  write_file(at(c.precious), "precious\n");
  const auto result = test::run(c.verb, placed(c.arguments));
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_NE(result.err.find(c.words), std::string::npos) << result.err;
  EXPECT_EQ(test::slurp(at(c.precious)), "precious\n");
}

constexpr const char* kInput = "is also an input";
constexpr const char* kKept = "kept";
constexpr const char* kBoth = "one of them would be lost";
const Case kCases[] = {
    {"predict", {"m.dcnn", "--data", "@a.csv", "--out", "@a.csv", "--force"}, "a.csv", kInput},
    {"predict", {"m.dcnn", "--data", "a.csv", "--out", "@p.csv"}, "p.csv", kKept},
    {"predict", {"m.dcnn", "--onnx", "@m.onnx"}, "m.onnx", kKept},
    {"sim", {"--sim", "s.json", "--motion", "@a.csv", "--out", "@a.csv"}, "a.csv", kInput},
    {"sim", {"--sim", "s.json", "--motion", "a.csv", "--out", "@b.csv"}, "b.csv", kKept},
    {"sim", {"--config", "c.json", "--out", "@set"}, "set/truth.json", kKept},
    {"train", {"--train", "@a.csv", "--out", "@a.csv", "--force"}, "a.csv", kInput},
    {"train", {"--train", "@a.csv", "--out", "@new/../a.csv", "--force"}, "a.csv", kInput},
    {"train", {"--train", "a.csv", "--out", "@m.dcnn"}, "m.dcnn", kKept},
    {"train", {"--train", "a.csv", "--out", "@new/../m.dcnn"}, "m.dcnn", kKept},
    {"train", {"--train", "@a.csv", "@a.csv", "--out", "@m.dcnn"}, "a.csv", "is named twice"},
    {"train",
     {"--train", "@a.csv", "--valid", "@a.csv", "--out", "@m.dcnn"},
     "a.csv",
     "is learned from and judged by"},
    {"diagnose",
     {"--sim", "s.json", "--fit", "b.csv", "@a.csv", "--holdout", "@a.csv", "--out", "@r"},
     "a.csv",
     "is learned from and judged by"},
    {"diagnose", {"--sim", "s.json", "--fit", "a.csv", "--out", "@b.csv"}, "b.csv", "is no folder"},
    {"train", {"--train", "@a.csv", "--out", "/dev/stdout"}, "a.csv", "is no file"},
    {"train", {"--train", "@a.csv", "--out", "-"}, "a.csv", "- is no file"},
    {"check", {"-"}, "a.csv", "a log is read twice"},
    {"check", {"@a.csv", "--out", "-"}, "a.csv", "- is standard output, which takes one file"},
    {"predict",
     {"m.dcnn", "--data", "@a.csv", "--out", "-", "--json"},
     "a.csv",
     "both go to standard output"},
    {"train", {"--train", "a.csv", "--out", "@m.dcnn"}, "m.run/checkpoint.safetensors", "--resume"},
    {"eval", {"m.dcnn", "--data", "a.csv", "--out", "@report"}, "report/report.html", kKept},
    {"bench", {"m.dcnn", "--out", "@bench"}, "bench/bench.json", kKept},
    {"diagnose",
     {"--sim", "@r/model.json", "--fit", "a.csv", "--out", "@r", "--force"},
     "r/model.json",
     kInput},
    {"diagnose", {"--sim", "s.json", "--fit", "a.csv", "--out", "@r"}, "r/report.json", kKept},
    {"calibrate", {"--static", "@s.csv", "--out", "@s.csv"}, "s.csv", kInput},
    {"calibrate", {"--static", "s.csv", "--out", "@c.json"}, "c.json", kKept},
    {"teleop", {"--out", "@t"}, "t/teleop.json", kKept},
    {"live", {"--role", "controller", "--key-file", "k", "--out", "@t"}, "t/report.html", kKept},
    {"rivals", {"--sim", "s", "--fit", "a", "--out", "@r"}, "r/lasso/report.json", kKept},
    {"conceal", {"--scenarios", "1", "--out", "@set", "--seal", "@s"}, "set/s0001/sim.json", kKept},
    {"conceal", {"--scenarios", "1", "--out", "@set", "--seal", "@seal"}, "seal", kKept},
    {"conceal",
     {"--inject", "bias", "--motion", "@d/a.csv", "--sim", "s", "--out", "@d", "--seal", "@s"},
     "d/a.csv",
     kInput},
    {"design",
     {"--report", "@r", "--limits", "l.json", "--out", "@r/report.json", "--force"},
     "r/report.json",
     kInput},
    {"design",
     {"--report", "@r", "--limits", "l.json", "--out", "@r/model.json", "--force"},
     "r/model.json",
     kInput},
    {"calibrate",
     {"--static", "s.csv", "--out", "@x", "--report", "@./new/../x", "--force"},
     "x",
     "--out and --report"},
    {"predict", {"m.dcnn", "--data", "@a.csv", "--out", "@x", "--onnx", "@x"}, "a.csv", kBoth},
    {"predict", {"m.dcnn", "--data", "@a.csv", "--out", "-", "--onnx", "-"}, "a.csv", kBoth},
    {"eval",
     {"m.dcnn", "--data", "@a.csv", "--out", "@r", "--trace", "@r/report.html"},
     "a.csv",
     kBoth},
    {"eval", {"m.dcnn", "--data", "@a.csv", "--out", "@r", "--trace", "@r/"}, "a.csv", kBoth},
    {"identify", {"@a.csv", "--out", "@r/identify.json", "--report", "@r"}, "a.csv", kBoth},
    {"sweep", {"--plan", "p", "--jobs", "1", "--merge", "@t.jsonl"}, "t.jsonl", kKept},
    {"run", {"--make-key", "-"}, "a.csv", "- is standard output; name a file"},
    {"predict", {"m.dcnn", "--data", "@a.csv", "--out", "@new/"}, "a.csv", "is a folder; name a"},
    {"predict", {"m.dcnn", "--data", "@a.csv", "--out", "@d"}, "d/a.csv", "is a folder; name a"},
    {"run", {"--make-key", "@key"}, "key", "never replaced"},
    {"run", {"--make-key", "@key", "--force"}, "key", "never replaced"},
};
INSTANTIATE_TEST_SUITE_P(Every, Outputs, ::testing::ValuesIn(kCases));

const std::string kShippedTool = DCNN_SOURCE_DIR "/data/sample/sim.json";
const std::string kLog = DCNN_SOURCE_DIR "/data/sample/test.csv";

TEST_F(Outputs, OfACommandThatIsJudgedByACopyOfWhatItLearnsFrom) {
  for (const char* name : {"a.csv", "b.csv"}) write_file(at(name), "t,fx\n0,1\n");
  const auto result = test::run("diagnose", {"--sim", at("s.json"), "--fit", at("a.csv"),
                                             "--holdout", at("b.csv"), "--out", at("r")});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_NE(result.err.find("b.csv: is a copy of"), std::string::npos) << result.err;
}

TEST_F(Outputs, OfAPredictionAreKeptLinksFollowedStreamsWritten) {
  std::filesystem::create_symlink("p.csv", at("link.csv"));
  Arguments again{kShippedTool, "--data", kLog, "--out", at("link.csv")};
  ASSERT_EQ(test::run("predict", again).exit_code, 0);
  const auto refused = test::run("predict", again);
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_NE(refused.err.find(kKept), std::string::npos) << refused.err;
  again.emplace_back("--force");
  EXPECT_EQ(test::run("predict", again).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(at("link.csv")));
  const std::string rows = test::slurp(at("p.csv"));
  const auto piped =
      test::Process("predict", {kShippedTool, "--data", "-", "--out", "-"}, {.input = kLog}).wait();
  EXPECT_EQ(piped.exit_code, 0) << piped.err;
  EXPECT_EQ(piped.out, rows);
  EXPECT_EQ(test::run("predict", {kShippedTool, "--data", kLog, "--out", "/dev/stdout"}).out, rows);
  EXPECT_EQ(test::run("predict", {kShippedTool, "--data", kLog, "--out", "/dev/null"}).exit_code,
            0);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(Outputs, OfALinkToAFolderThatIsStillToBeMadeGoWhereItPoints) {
  std::filesystem::create_symlink("named", at("link"));
  const auto result = test::run(
      "sim", {"--config", DCNN_SOURCE_DIR "/configs/sim/static.json", "--out", at("link")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(at("named/sim.json")));
  EXPECT_TRUE(std::filesystem::is_symlink(at("link")));
}

TEST_F(Outputs, OnAFullDeviceAreAFailureAlsoOfHelp) {
  for (const char* word : {"--help", "--version"}) {
    const auto full =
        test::Process("predict", {word}, {.wrapper = {"bash", "-c", R"("$0" "$@" > /dev/full)"}});
    const auto result = full.wait();
    EXPECT_EQ(result.exit_code, 1) << word;
    EXPECT_EQ(result.err, "dcnn-predict: standard output: cannot write\n");
  }
}

TEST_F(Outputs, OfACommandThatReadsStandardInputSeveralTimes) {
  const auto piped = [](const char* verb, const Arguments& arguments, const std::string& input) {
    const auto result = test::Process(verb, arguments, {.input = input}).wait();
    EXPECT_EQ(result.exit_code, 0) << verb << ": " << result.err;
    return result;
  };
  const std::string rows = piped("predict", {"-", "--data", kLog, "--out", "-"}, kShippedTool).out;
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 4001);
  piped("diagnose", {"-q", "--sim", "-", "--fit", kLog, "--out", at("by_description")},
        kShippedTool);
  piped("diagnose", {"-q", "--sim", kShippedTool, "--fit", "-", "--out", at("by_log")}, kLog);
  piped("train", {"-q", "--model", "cf", "--base", "-", "--train", kLog, "--out", at("m.dcnn")},
        kShippedTool);
  const auto identified = piped("identify", {"-", "--out", "-"}, kLog);
  EXPECT_NE(identified.err.find("Next: dcnn-diagnose --sim FOUND.json --fit LOG.csv"),
            std::string::npos)
      << identified.err;
}

TEST_F(Outputs, OnStandardOutputStandAlone) {
  const std::string log = DCNN_SOURCE_DIR "/data/sample/test.csv";
  for (const char* out : {"-", "/dev/stdout", "/dev/fd/1"}) {
    const auto identified = test::run("identify", {log, "--out", out});
    ASSERT_EQ(identified.exit_code, 0) << identified.err;
    EXPECT_TRUE(parse_json(identified.out, out, Exit::kFailure).contains("tool"));
    EXPECT_NE(identified.err.find("mass"), std::string::npos) << identified.err;
    const auto predicted = test::run(
        "predict", {DCNN_SOURCE_DIR "/data/sample/sim.json", "--data", log, "--out", out});
    ASSERT_EQ(predicted.exit_code, 0) << predicted.err;
    EXPECT_EQ(std::count(predicted.out.begin(), predicted.out.end(), '\n'), 4001) << out;
  }
}

TEST_F(Outputs, OfAFolderThatAnotherProcessWritesToAreRefused) {
  const FolderLock other(at("report"));
  const auto result =
      test::run("diagnose", {"--sim", kShippedTool, "--fit", kLog, "--out", at("report")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("another process is writing here"), std::string::npos) << result.err;
}

TEST_F(Outputs, OfASealThatAnotherProcessWritesAreRefused) {
  const NameLock other(at("seal.json"));
  const auto result = test::run(
      "conceal", {"--scenarios", "1", "--out", at("set"), "--seal", at("seal.json"), "--force"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("another process is writing this file"), std::string::npos)
      << result.err;
}

/// What stands under the name when the work is done was made by somebody who did not know of it.
TEST_F(Outputs, MadeBySomebodyElseDuringTheRunAreKept) {
  ASSERT_EQ(::mkfifo(at("log.csv").c_str(), 0600), 0);
  const test::Process train("predict", {kShippedTool, "--data", "-", "--out", at("p.csv")},
                            {.wrapper = {"bash", "-c", R"(exec "$@" < "$0")", at("log.csv")}});
  {
    std::ofstream rows(at("log.csv"));                     // opens once it is read
    std::this_thread::sleep_for(std::chrono::seconds(1));  // the command has claimed its output
    std::ofstream(at("p.csv")) << "precious";
    rows << test::slurp(kLog);
  }
  const auto result = train.wait();
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.err.find("p.csv: was made by somebody else meanwhile and is kept"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(test::slurp(at("p.csv")), "precious");
  EXPECT_NE(test::slurp(at("p.csv.2")).find("fz_hat"), std::string::npos);
}

TEST_F(Outputs, OfAnEarlierLargerSetAreGone) {
  const auto conceal = [&](const char* count) {
    return test::run("conceal", {"--scenarios", count, "--out", at("set"), "--seal",
                                 at("seal.json"), "--force", "-q"});
  };
  ASSERT_EQ(conceal("2").exit_code, 0);
  write_file(at("set/s0002/notes.txt"), "somebody's");
  ASSERT_TRUE(std::filesystem::exists(at("set/s0002/sim.json")));
  ASSERT_EQ(conceal("1").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(at("set/s0001/sim.json")));
  EXPECT_FALSE(std::filesystem::exists(at("set/s0002/sim.json")));
  EXPECT_TRUE(std::filesystem::exists(at("set/s0002/notes.txt")));
}

}  // namespace
}  // namespace dcnn
