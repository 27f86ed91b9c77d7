// SPDX-License-Identifier: Apache-2.0
// The ready configurations on real recordings, which are not part of the repository: skipped
// without them.
#include <gtest/gtest.h>

#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;

const std::filesystem::path kData = std::filesystem::path(DCNN_SOURCE_DIR) / "../shared/data";

std::string config(const std::string& name) {
  return (std::filesystem::path(DCNN_SOURCE_DIR) / "configs" / name).string();
}

/// Overall clean RMSE of a model trained on some files and scored on others.
double overall_rmse(const std::string& configuration, std::vector<std::string> training,
                    std::vector<std::string> held_out) {
  const test::TemporaryFolder folder;
  const std::string model = (folder / "m.dcnn").string();
  std::vector<std::string> fit{"--config", configuration, "--out", model, "--quiet", "--train"};
  fit.insert(fit.end(), training.begin(), training.end());
  const auto fitted = run("train", fit);
  EXPECT_EQ(fitted.exit_code, 0) << fitted.err;
  std::vector<std::string> score{model, "--snr", "clean", "--json", "--quiet", "--data"};
  score.insert(score.end(), held_out.begin(), held_out.end());
  const auto result = run("eval", score);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return parse_json(result.out, "eval", Exit::kFailure)["summary"][0]["rmse_overall_mean"];
}

TEST(RealRecordings, SpindleOfASurgicalToolComesBelowAHandBuiltRegression) {
  if (!std::filesystem::exists(kData / "davinci_tool")) GTEST_SKIP() << "no " << kData;
  std::vector<std::string> training, held_out;
  for (const auto& entry : std::filesystem::directory_iterator(kData / "davinci_tool")) {
    const auto name = entry.path().filename().string();
    (name.rfind("run_1", 0) == 0 ? held_out : training).push_back(entry.path().string());
  }
  std::sort(training.begin(), training.end());
  std::sort(held_out.begin(), held_out.end());
  ASSERT_EQ(held_out.size(), 4u);
  EXPECT_LT(overall_rmse(config("davinci_tool.json"), training, held_out), 0.0110);
}

TEST(RealRecordings, SensorFrameFeaturesWorkWhereEulerAnglesAreSingular) {
  if (!std::filesystem::exists(kData / "ntnu_wrist")) GTEST_SKIP() << "no " << kData;
  const auto first = (kData / "ntnu_wrist/free_1.csv").string();
  const auto second = (kData / "ntnu_wrist/free_2.csv").string();
  const double body = overall_rmse(config("ntnu_wrist.json"), {first}, {second});
  const double pose = overall_rmse(config("ntnu_wrist_pose.json"), {first}, {second});
  EXPECT_LT(body, 1.6) << "the vibration in this recording alone is about 0.9 N";
  EXPECT_GT(pose, 2.0 * body);
}

}  // namespace
}  // namespace dcnn
