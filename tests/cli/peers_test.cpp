// SPDX-License-Identifier: Apache-2.0
// dcnn-bench --peers, with no library beside it and with those that are here.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "dcnn/core/file.h"
#include "dcnn/data/csv.h"
#include "dcnn/data/features.h"
#include "dcnn/models/onnx.h"
#include "experiment/peers/cases.h"
#include "experiment/peers/helpers.h"
#include "support/process.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kQuick{"--peers", "--lengths", "1,20", "--rounds",
                                      "1",       "--epochs",  "0",    "--quiet"};

std::string sample(const char* name) {
  return std::string(DCNN_SOURCE_DIR) + "/data/sample/" + name;
}

/// dcnn-bench in a folder where no helper is but those that a test puts there.
struct Lonely {
  test::TemporaryFolder folder;
  Lonely() { fs::copy_file(fs::path(DCNN_BIN_DIR) / "dcnn-bench", folder / "dcnn-bench"); }

  /// A shell script in the place of oneDNN's helper.
  void put_helper(const std::string& script) const {
    const auto path = folder / "dcnn-peer-onednn";
    write_file(path, "#!/bin/sh\necho '{\"name\": \"oneDNN\", \"version\": \"0\"}'\n" + script);
    fs::permissions(path, fs::perms::owner_all);
  }

  int run() const {
    const std::string command = (folder / "dcnn-bench").string() +
                                " --peers --lengths 1 --rounds 1 --epochs 0 --quiet > " +
                                (folder / "out").string() + " 2> " + (folder / "err").string();
    return WEXITSTATUS(std::system(command.c_str()));
  }
  std::string out() const { return test::slurp(folder / "out"); }
  std::string err() const { return test::slurp(folder / "err"); }
};

TEST(Peers, WithoutAnyHelperSaysWhatIsMissing) {
  const Lonely bench;
  ASSERT_EQ(bench.run(), 0) << bench.err();
  for (const char* name : {"ONNX Runtime", "oneDNN", "libtorch"}) {
    EXPECT_NE(bench.out().find(std::string(name) + " is left out: "), std::string::npos)
        << bench.out();
  }
  EXPECT_NE(bench.out().find("tools/install-deps --peers"), std::string::npos);
  EXPECT_NE(bench.out().find("dcnn-valid"), std::string::npos) << "our own rows are there";
}

TEST(Peers, AHelperThatEndsIsLeftOutFromThereOn) {
  const Lonely bench;
  bench.put_helper("read line\n");
  ASSERT_EQ(bench.run(), 0) << bench.err();
  EXPECT_NE(bench.out().find("dcnn-peer-onednn: ended before it answered; left out"),
            std::string::npos)
      << bench.out();
  EXPECT_NE(bench.out().find("ffnn-m"), std::string::npos);
}

TEST(Peers, AHelperThatFailsSaysWhy) {
  const Lonely bench;
  bench.put_helper("while read line; do echo '{\"error\": \"no such primitive\"}'; done\n");
  ASSERT_EQ(bench.run(), 0) << bench.err();
  EXPECT_NE(bench.out().find("dcnn-peer-onednn: no such primitive; left out"), std::string::npos)
      << bench.out();
}

TEST(Peers, OutputsThatDifferAreAFailure) {
  const Lonely bench;
  bench.put_helper(
      "zeros=$(head -c 2999 /dev/zero | tr '\\0' 0 | sed 's/0/0,/g')0\n"
      "while read verb rest; do case $verb in\n"
      "  outputs) echo \"{\\\"values\\\": [$zeros]}\" ;;\n"
      "  each) echo '{\"seconds\": [0.01, 0.01]}' ;;\n"
      "  *) echo '{\"seconds\": 0.01}' ;;\n"
      "esac; done\n");
  EXPECT_EQ(bench.run(), 1) << bench.out();
  EXPECT_NE(bench.out().find("1.0e+00 (too much)"), std::string::npos) << bench.out();
  EXPECT_NE(bench.err().find("outputs differ"), std::string::npos) << bench.err();
}

TEST(Peers, AgreeWithOursWhereTheyAreHere) {
  const test::TemporaryFolder folder;
  std::vector<std::string> arguments = kQuick;
  arguments.insert(arguments.end(), {"--json", "--out", (folder / "out").string()});
  const auto result = test::run("bench", arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json peers = parse_json(result.out, "bench", Exit::kFailure)["peers"];
  EXPECT_EQ(peers["agree"], true);
  EXPECT_EQ(peers["peers"].size(), 3U);
  ASSERT_EQ(peers["rows"].size(), 14U);
  std::size_t here = 0;
  for (const Json& peer : peers["peers"]) here += peer["missing"].is_null();
  for (const Json& row : peers["rows"]) {
    EXPECT_EQ(row["peers"].size(), here) << row["network"].dump();
    EXPECT_GT(row["share_of_peak"].get<double>(), 0.0);
    for (const Json& peer : row["peers"]) {
      EXPECT_LE(peer["difference"].get<double>(), 1e-6);
      EXPECT_GT(peer["ratio"].get<double>(), 0.0);
    }
  }
  const std::string page = test::slurp(folder / "out" / "bench.html");
  EXPECT_NE(page.find("Beside other libraries"), std::string::npos);
  if (here == 0) GTEST_SKIP() << "no library is here (tools/install-deps --peers)";
}

TEST(Peers, CtrlCLeavesNoFolder) {
  const test::TemporaryFolder folder;
  const auto is_there = [&] {  // others leave files of their own
    return std::ranges::any_of(fs::directory_iterator(folder.path()), [](const auto& entry) {
      return entry.path().filename().string().starts_with("dcnn-peers-");
    });
  };
  const test::Process bench("bench", {"--peers", "--lengths", "1", "--epochs", "0", "--quiet"},
                            {.environment = {"TMPDIR=" + folder.path().string()}});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!is_there() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_TRUE(is_there());
  bench.signal(SIGINT);
  EXPECT_EQ(bench.wait().exit_code, 128 + SIGINT);
  EXPECT_FALSE(is_there());
}

TEST(Peers, CountProductsThatMeetTheImageAlone) {
  std::vector<std::string> notes;
  std::map<std::string, double> found;
  for (const PeerCase& what : peer_cases({}, notes)) {
    found[what.name] = products(what.network, what.succession == Succession::kCarries);
  }
  EXPECT_EQ(found["dcnn-valid"], 117024);
  EXPECT_EQ(found["dcnn-same"], 443592);
  EXPECT_EQ(found["lstm-1"], 9450);
  EXPECT_EQ(found["lstm-step"], 99450);
  EXPECT_EQ(found["ffnn-s"], 360);
}

/// A model of this kind trained for a moment, and the sample's features as float.
struct Exported {
  Identifier identifier;
  Tensor features;
};

Exported trained(const std::string& kind, const test::TemporaryFolder& folder) {
  const auto model = folder / (kind + ".dcnn");
  std::vector<std::string> arguments{"--train", sample("train.csv"), "--preset", "quick", "--model",
                                     kind,      "--epochs",          "1",        "--out", model,
                                     "--quiet"};
  const auto result = test::run("train", arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  Identifier identifier = read_identifier(model);
  const Recording recording = read_recording(sample("test.csv"), {}, identifier.layout.system);
  const auto x = make_features(recording, identifier.layout).x;
  Tensor features({x.rows(), x.cols()});
  for (Index i = 0; i < x.rows(); ++i) {
    for (Index j = 0; j < x.cols(); ++j) features.data()[i * x.cols() + j] = Real(x(i, j));
  }
  return {std::move(identifier), std::move(features)};
}

TEST(Peers, OnnxRuntimePredictsWhatAnExportedModelPredicts) {
  const test::TemporaryFolder folder;
  std::vector<Peer> missing;
  const std::vector<Helper> helpers = open_helpers(DCNN_BIN_DIR, folder.path(), missing);
  const auto onnx = std::ranges::find(helpers, true, &Helper::reads_onnx);
  if (onnx == helpers.end()) GTEST_SKIP() << "no ONNX Runtime (tools/install-deps --peers)";
  for (const char* kind : {"dcnn", "lstm", "mlp", "ffnn-s", "ffnn-m"}) {
    const Exported model = trained(kind, folder);
    Eigen::MatrixXd x(200, model.features.dim(1));
    for (Index i = 0; i < x.size(); ++i) {
      x(i / x.cols(), i % x.cols()) = static_cast<double>(model.features.data()[i]);
    }
    const Eigen::MatrixXd wanted = model.identifier.model->predict({x, {{0, 200}}});
    write_file(folder / kSamplesFile,
               {reinterpret_cast<const char*>(model.features.data()),
                static_cast<std::size_t>(model.features.size()) * sizeof(float)});
    const auto file = folder / kOnnxFile;
    ASSERT_EQ(
        test::run("predict", {(folder / (std::string(kind) + ".dcnn")).string(), "--onnx", file})
            .exit_code,
        0);
    onnx->load(1, 1);
    const auto found = onnx->outputs(200);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(wanted.size()));
    const double scale = wanted.cwiseAbs().maxCoeff();
    for (Index i = 0; i < wanted.size(); ++i) {
      EXPECT_NEAR(found[static_cast<std::size_t>(i)], wanted(i / wanted.cols(), i % wanted.cols()),
                  1e-5 * scale)
          << kind << " " << i;
    }
  }
}

TEST(Peers, ACascadeIsNoOnnx) {
  const test::TemporaryFolder folder;
  trained("cfnn-s", folder);
  const auto result = test::run(
      "predict", {(folder / "cfnn-s.dcnn").string(), "--onnx", (folder / "m.onnx").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("cannot be written as ONNX"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace dcnn
