// SPDX-License-Identifier: Apache-2.0
// dcnn-teleop as a user runs it.
#include <gtest/gtest.h>

#include "data/testing.h"
#include "dcnn/core/json.h"
#include "support/page.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;
using testing::contains;

TEST(TeleopTool, AModelInTheLoopTakesMostOfTheWeightOffTheHand) {
  const test::TemporaryFolder folder;
  const auto configs = std::filesystem::path(DCNN_SOURCE_DIR) / "configs";
  const auto config =
      testing::temporary_file("sim.json",
                              R"({"seed": 3, "sample_rate_hz": 500, "force_noise": {"n": 0.04},
          "pose_noise": {"m": 5e-6, "rad": 5e-6},
          "simulator": {"tool": {"mass_kg": 0.75, "com_m": [0.004, -0.006, 0.16]},
            "sensor": {"bias_n": [0.6, -0.4, 1.1], "rotation_rpy": [-0.0262, 0.0349, -0.5236]}},
          "recordings": [{"name": "train", "samples": 6000, "t0_s": 0, "trajectory": {
            "kind": "multisine", "tones": 6, "hz": [0.05, 1], "position_m": [0.1, 0.1, 0.1],
            "angle_rad": [0.6, 0.5, 0.6], "angle_center_rad": [0, 0, 3.14159]}}]})");
  ASSERT_EQ(run("sim", {"--config", config.string(), "--out", folder.path().string()}).exit_code,
            0);
  const auto data = (folder / "train.csv").string();
  for (const bool online : {true, false}) {
    std::vector<std::string> arguments{"--model",
                                       "rigid",
                                       "--train",
                                       data,
                                       "--quiet",
                                       "--out",
                                       (folder / (online ? "on.dcnn" : "off.dcnn")).string()};
    if (online) arguments.push_back("--online");
    const auto trained = run("train", arguments);
    ASSERT_EQ(trained.exit_code, 0) << trained.err;
  }
  const auto linear =
      testing::temporary_file("linear.json", R"({"model": {"name": "dcnn-t", "body": "none"}})");
  const auto windowed = run("train", {"--config", linear.string(), "--train", data, "--online",
                                      "--quiet", "--out", (folder / "window.dcnn").string()});
  ASSERT_EQ(windowed.exit_code, 0) << windowed.err;
  const auto out = folder / "teleop";
  const auto result =
      run("teleop",
          {"--model", (folder / "on.dcnn").string(), "--model", (folder / "window.dcnn").string(),
           "--corrected", (folder / "sim.json").string(), "--config",
           (configs / "teleop.json").string(), "--out", out.string(), "--json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json rows = parse_json(result.out, "teleop", Exit::kFailure)["variants"];
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[3]["name"], "rigid");
  EXPECT_LT(rows[3]["handle_force_free_rms_n"].get<double>(),
            0.1 * rows[2]["handle_force_free_rms_n"].get<double>());
  EXPECT_EQ(rows[4]["name"], "dcnn-t");
  EXPECT_LT(rows[4]["handle_force_free_rms_n"].get<double>(),
            0.2 * rows[2]["handle_force_free_rms_n"].get<double>());
  EXPECT_EQ(rows[5]["name"], "corrected");
  EXPECT_LT(rows[5]["master_drift_m"].get<double>(), 1e-3);
  const std::string page = test::slurp(out / "report.html");
  EXPECT_TRUE(contains(page, "Fig. 6, with rigid") && contains(page, "robot base B"));
  EXPECT_TRUE(contains(page, "tool known: error norm")) << "names are words, no codes";
  EXPECT_FALSE(contains(page, ">ideal: ") || contains(page, ">ns: "));
  test::expect_usable_page(page);
  for (const char* file : {"teleop.json", "frames.svg", "comparison_0.svg", "rigid.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(out / file)) << file;
  }
  const auto refused = run(
      "teleop", {"--model", (folder / "off.dcnn").string(), "--out", (folder / "none").string()});
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_TRUE(contains(refused.err, "--online")) << refused.err;
  EXPECT_EQ(
      run("teleop", {"--config", "absent.json", "--out", (folder / "none").string()}).exit_code, 2);
  EXPECT_EQ(
      run("teleop", {"--corrected", "absent.json", "--out", (folder / "none").string()}).exit_code,
      3);
}

}  // namespace
}  // namespace dcnn
