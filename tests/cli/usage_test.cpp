// SPDX-License-Identifier: Apache-2.0
// What the programs say to a file of the wrong kind, a number out of range, and --json.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <sstream>

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

void expect_words(const std::string& text, std::initializer_list<std::string> words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), text.npos) << word << " in: " << text;
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

TEST(FileOfAnotherKind, IsCalledByItsNameByEveryProgram) {
  const test::TemporaryFolder folder;
  const std::string sim = kSampleFolder + "sim.json", csv = kSampleFolder + "test.csv",
                    out = folder / "out";
  expect_words(refusal("forward", {sim, "--data", csv}, 4),
               {"sim.json: is a simulator of a tool on a wrist sensor", "dcnn-predict",
                "dcnn-forward needs a corrected simulator of a machine", "dcnn-diagnose --system"});
  expect_words(refusal("forward", {kConfigs + "systems/panda.json", "--data", csv}, 4),
               {"is a description of a machine", "dcnn-forward needs a corrected simulator"});
  expect_words(refusal("bench", {sim}, 4), {"is a simulator", "dcnn-train writes it"});
  expect_words(refusal("teleop", {"--model", csv, "--out", out}, 4), {"--model needs a trained"});
  expect_words(refusal("teleop", {"--config", sim, "--out", out}), {"configs/teleop.json"});
  expect_words(refusal("train", {"--config", sim, "--train", csv, "--out", out}),
               {"--config needs a configuration of a training"});
  expect_words(refusal("train", {"--train", sim, "--out", out}, 3), {"--train needs a recording"});
  expect_words(refusal("check", {csv, "--sim", csv}, 3), {"--sim needs a simulator"});
  expect_words(refusal("identify", {sim, "--out", out}, 3), {"dcnn-identify needs a recording"});
  expect_words(refusal("identify", {"--from", csv, "--export", "ur", "--export-to", out}, 3),
               {"--from needs a simulator"});
  expect_words(refusal("reproduce", {"--scene", sim, "--plan"}), {"--scene needs a scene"});
  expect_words(refusal("calibrate", {"--static", sim, "--out", out}, 3), {"--static needs a rec"});
  expect_words(refusal("sweep", {sim, "--plan", out}),
               {"sim.json: is a simulator", "dcnn-sweep needs a description of cells"});
  expect_words(refusal("design", {"--report", out, "--limits", sim, "--out", out}),
               {"--limits needs the limits of a robot", "configs/limits/wrist.json"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(FileOfAnotherKind, IsCalledByItsNameBeforeWhatIsMissing) {
  const std::string sim = kSampleFolder + "sim.json", csv = kSampleFolder + "test.csv";
  expect_words(refusal("sim", {"--config", sim}),
               {"sim.json: is a simulator", "--config needs a scene to simulate"});
  expect_words(refusal("eval", {sim}, 4), {"is a simulator", "dcnn-eval needs a trained model"});
  expect_words(refusal("diagnose", {csv}), {"unexpected argument", "did you mean --fit " + csv});
  expect_words(refusal("train", {"log.csv"}), {"did you mean --train log.csv?"});
  expect_words(refusal("sim", {"--out", "o", csv}), {"did you mean --motion"});
  expect_words(refusal("train", {"--train", csv, "--out"}), {"--out needs a value"});
}

TEST(FileThatIsNone, IsRefusedWithWhatIsWanted) {
  const test::TemporaryFolder folder;
  const std::string csv = kSampleFolder + "test.csv", out = folder / "out",
                    empty = folder / "empty.json", list = folder / "list.json";
  std::ofstream{empty};
  std::ofstream(list) << "[1, 2\n";
  expect_words(refusal("diagnose", {"--sim", folder / "none.json", "--fit", csv, "--out", out}, 3),
               {"does not exist; --sim needs a simulator", "dcnn-identify"});
  expect_words(refusal("eval", {folder.path().string(), "--data", csv}, 4),
               {"is a folder; dcnn-eval needs a trained model"});
  expect_words(refusal("check", {csv, "--sim", empty}, 3), {"empty.json: is empty"});
  expect_words(refusal("check", {list}, 3), {"list.json: is JSON", "needs a recording"});
  expect_words(refusal("bench", {empty}, 4), {"empty.json: too short for a model file"});
  const std::string urdf = refusal(
      "identify",
      {csv, "--system", kConfigs + "systems/panda.json", "--urdf", csv, "--out", folder / "o.json"},
      3);
  if (urdf.find("reads no URDF") == urdf.npos) expect_words(urdf, {"test.csv: is no URDF"});
}

TEST(SealOfNothing, IsNotMadeWhereItShouldBeRead) {
  const test::TemporaryFolder folder;
  const std::string set = folder / "set";
  expect_words(refusal("conceal", {"--score", "--out", set, "--seal", folder / "seal.json"}, 3),
               {"holds no seal.sha256; --score takes the folder that dcnn-conceal --out wrote"});
  EXPECT_FALSE(std::filesystem::exists(set));
}

TEST(RefusedCommand, LeavesNoFolder) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "out/below", seal = folder / "seal.json",
                    log = folder / "short.csv";
  for (const char* count : {"0", "-3", "99999999"}) {
    for (const char* what : {"--scenarios", "--arms", "--axes", "--laws", "--rates"}) {
      expect_words(refusal("conceal", {what, count, "--out", out, "--seal", seal}),
                   {what, std::string(count) + " is not between 1 and 9999"});
    }
  }
  expect_words(refusal("import", {"-", "--out", out}), {"a log is read twice"});
  std::istringstream rows(test::slurp(kSampleFolder + "train.csv"));
  std::ofstream few(log);
  std::string line;
  for (int k = 0; k < 300 && std::getline(rows, line); ++k) few << line << "\n";
  few.close();
  expect_words(
      refusal("rivals", {"--sim", kSampleFolder + "sim.json", "--fit", log, "--out", out}, 3),
      {"shorter than 5 s"});
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(WrongCountOfValues, IsToldInWords) {
  expect_words(refusal("reproduce", {"--data", "a.csv"}),
               {"--data takes 2 recordings, one to train on and one to test on, and got 1"});
  expect_words(refusal("reproduce", {"--data", "a.csv", "b.csv", "c.csv"}), {"and got 3"});
  expect_words(refusal("identify", {"a.csv", "--out", "o", "--mounting", "1", "2"}),
               {"--mounting takes 3 numbers rx ry rz [rad], and got 2"});
  expect_words(refusal("sim", {"--out", "o", "--config"}),
               {"--config needs a value: --config FILE"});
  expect_words(refusal("sim", {"--config", "a", "--config", "b", "--out", "o"}),
               {"--config is given 2 times, and takes one value"});
  expect_words(refusal("train", {"--train", "a", "--out", "o", "--seed", "1.5"}),
               {"--seed: '1.5' is not a whole number"});
  expect_words(refusal("sim", {"--config", "a", "--sim", "b", "--motion", "c", "--out", "o"}),
               {"--config and --sim exclude one another"});
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
  expect_words(refusal("run", {"--model", sim, "--listen", "5301", "--peer", "127.0.0.1:5301",
                               "--key-file", key}),
               {"'5301' and '127.0.0.1:5301' are one address"});
  for (const char* port : {"70000", "0"}) {  // at once, though nobody answers as dcnn-run
    expect_words(refusal("live", {"--role", "sensor", "--key-file", key, "--sensor", port}),
                 {std::string("port ") + port + " is not between 1 and 65535"});
    expect_words(refusal("live", {"--role", "controller", "--key-file", key, "--out", folder / "o",
                                  "--controller", port}),
                 {std::string("port ") + port + " is not between 1 and 65535"});
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "o"));
  expect_words(refusal("run", {"--model", sim, "--stdin", "--plot", "65536"}),
               {"port 65536 is not between 1 and 65535"});
  expect_words(refusal("run", {"--model", sim, "--stdin", "--average", "17"}),
               {"--average", "17 is not between 1 and 16"});
  expect_words(refusal("sim", {"--config", kConfigs + "sim/sample.json", "--out", folder / "o",
                               "--seed", "-1"}),
               {"--seed", "-1"});
  expect_words(refusal("predict", {sim, "--data", kSampleFolder + "test.csv", "--out",
                                   folder / "o.csv", "--resample", "1e12"}),
               {"--resample", "1e12 is not between 0 and 1000000"});
}

TEST(NumberOutOfRange, IsRefusedWhereItHasNoEnd) {
  const std::string sim = kSampleFolder + "sim.json", csv = kSampleFolder + "test.csv";
  expect_words(refusal("run", {"--model", sim, "--stdin", "--limit", "inf"}),
               {"--limit: inf is not greater than 0"});
  expect_words(refusal("run", {"--model", sim, "--rehearse", csv, "--hours", "1e300"}),
               {"--hours: 1e300 is not greater than 0 and at most 10000"});
  expect_words(refusal("train", {"--train", csv, "--out", "m.dcnn", "--epochs", "1000001"}),
               {"--epochs: 1000001 is not", "at most 1000000"});
  expect_words(refusal("bench", {"--samples", "99999999999"}), {"--samples", "at most 10000000"});
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
      {"predict", {model, "--data", csv, "--out", folder / "p.csv", "--force"}},
      {"identify", {"--from", sim, "--export", "ur", "urdf", "--export-to", folder / "payload"}},
      {"conceal", {"--list-faults"}},
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
