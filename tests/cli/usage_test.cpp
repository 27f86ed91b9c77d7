// What the programs say to a file of the wrong kind, a number out of range, and --json.
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn {
namespace {

const std::string kSampleFolder = DCNN_SOURCE_DIR "/data/sample/",
                  kConfigs = DCNN_SOURCE_DIR "/configs/";

/// The one line that a refused command prints.
std::string refusal(const std::string& verb, std::vector<std::string> arguments, int exit = 2) {
  const auto result = test::run(verb, std::move(arguments));
  EXPECT_EQ(result.exit_code, exit) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  return result.err;
}

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), text.npos) << word << " in: " << text;
}

TEST(FileOfAnotherKind, IsCalledByItsName) {
  const test::TemporaryFolder folder;
  const std::string sim = kSampleFolder + "sim.json", csv = kSampleFolder + "test.csv",
                    out = folder / "out";
  expect_words(
      refusal("sim", {"--config", sim, "--out", out}),
      {"sim.json: is a simulator", "--config needs a scene to simulate", "--sim with --motion"});
  expect_words(
      refusal("sim", {"--sim", kConfigs + "sim/sample.json", "--motion", csv, "--out", out}, 3),
      {"is a scene to simulate", "dcnn-sim --config takes it"});
  expect_words(refusal("eval", {sim, "--data", csv}, 4),
               {"is a simulator", "dcnn-eval needs a trained model"});
  expect_words(refusal("eval", {csv, "--data", csv}, 4), {"test.csv: is a recording"});
  expect_words(refusal("predict", {kConfigs + "teleop.json", "--data", csv, "--out", out}, 4),
               {"is a configuration of the teleoperation"});
  expect_words(refusal("diagnose",
                       {"--sim", kConfigs + "systems/panda.json", "--fit", csv, "--out", out}, 3),
               {"is a description of a machine", "--system"});
  expect_words(refusal("diagnose", {"--sim", sim, "--fit", sim, "--out", out}, 3),
               {"--fit needs a recording"});
  expect_words(refusal("run", {"--model", sim, "--calibration", sim, "--stdin"}, 3),
               {"--calibration needs a calibration"});
  expect_words(refusal("predict", {sim, "--onnx", out}, 4),
               {"is a simulator", "--onnx needs a trained model"});
  expect_words(refusal("rivals", {"--sim", csv, "--fit", csv, "--out", out}, 3),
               {"is a recording", "--sim needs a simulator"});
  expect_words(refusal("rivals", {"--sim", sim, "--fit", sim, "--out", out}, 3),
               {"--fit needs a recording"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(NumberOutOfRange, IsRefusedWithItsBounds) {
  const test::TemporaryFolder folder;
  const std::string sim = kSampleFolder + "sim.json", key = folder / "key";
  ASSERT_EQ(test::run("run", {"--make-key", key}).exit_code, 0);
  expect_words(
      refusal("run", {"--model", sim, "--listen", "99999", "--peer", "5302", "--key-file", key}),
      {"port 99999 is not between 1 and 65535"});
  expect_words(refusal("run", {"--model", sim, "--listen", "5301", "--peer", "127.0.0.1:0",
                               "--key-file", key}),
               {"port 0 is not between 1 and 65535"});
  expect_words(refusal("run", {"--model", sim, "--stdin", "--plot", "65536"}),
               {"port 65536 is not between 1 and 65535"});
  expect_words(refusal("run", {"--model", sim, "--stdin", "--average", "17"}),
               {"--average", "17 is not between 1 and 16"});
  expect_words(refusal("predict", {sim, "--data", kSampleFolder + "test.csv", "--out",
                                   folder / "o.csv", "--seed", "-1"}),
               {"--seed", "-1"});
  expect_words(refusal("predict", {sim, "--data", kSampleFolder + "test.csv", "--out",
                                   folder / "o.csv", "--resample", "1e12"}),
               {"--resample", "1e12 is not between 0 and 1000000"});
}

TEST(MistypedOption, IsNamedBeforeAnythingElse) {
  expect_words(refusal("diagnose", {"--smi", "none.json", "--fit", "none.csv"}),
               {"--smi is no option; did you mean --sim?"});
  expect_words(refusal("run", {"--modle", "none.dcnn", "--average", "99"}),
               {"--modle is no option; did you mean --model?"});
}

TEST(MistypedWord, IsToldFromTheWordsThatThereAre) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files{"--sim", kSampleFolder + "sim.json",
                                       "--fit", kSampleFolder + "train.csv",
                                       "--out", folder / "out"};
  for (const auto& [option, word, meant] :
       {std::array{"--preset", "quik", "'quick'"}, std::array{"--networks", "mpl", "'mlp'"}}) {
    std::vector<std::string> arguments = files;
    arguments.insert(arguments.end(), {option, word});
    expect_words(refusal("rivals", arguments), {option, word, "is none of", "did you mean", meant});
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(JsonAlone, IsOneDocumentOnStandardOutput) {
  const test::TemporaryFolder folder;
  const std::string sim = kSampleFolder + "sim.json", csv = kSampleFolder + "test.csv",
                    model = folder / "m.dcnn";
  const std::vector<std::pair<std::string, std::vector<std::string>>> commands{
      {"sim", {"--config", kConfigs + "sim/static.json", "--out", folder / "static"}},
      {"train", {"--model", "rigid", "--train", csv, "--out", model}},
      {"eval", {model, "--data", csv, "--snr", "clean"}},
      {"predict", {model, "--data", csv, "--out", folder / "p.csv"}},
      {"predict", {model, "--data", csv, "--out", folder / "p.csv"}},
      {"run", {"--make-key", folder / "key"}}};
  for (auto [verb, arguments] : commands) {
    SCOPED_TRACE(verb);
    arguments.emplace_back("--json");
    const auto result = test::run(verb, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NO_THROW(parse_json(result.out, "stdout", Exit::kData)) << result.out;
  }
}

}  // namespace
}  // namespace dcnn
