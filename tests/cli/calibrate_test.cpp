// SPDX-License-Identifier: Apache-2.0
// dcnn-calibrate as a user runs it.
#include <gtest/gtest.h>

#include "data/testing.h"
#include "dcnn/calibration/calibration.h"
#include "dcnn/data/rotation.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;
using testing::contains;

TEST(CalibrateTool, StaticPosesOfTheSimulatorGiveTheirMountingBack) {
  const test::TemporaryFolder folder;
  const auto config = std::filesystem::path(DCNN_SOURCE_DIR) / "configs/sim/static.json";
  ASSERT_EQ(run("sim", {"--config", config.string(), "--out", folder.path().string()}).exit_code,
            0);
  const auto out = (folder / "c.json").string();
  const auto result =
      run("calibrate", {"--static", (folder / "static.csv").string(), "--with-bias", "--out", out,
                        "--json", "--nominal", "-0.0262", "0.0349", "-0.5236"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = parse_json(result.out, "calibrate", Exit::kFailure);
  EXPECT_LT(json["nominal_angle_rad"].get<double>(), 0.0087);  // half a degree
  EXPECT_NEAR(json["mass_kg"].get<double>(), 0.75, 0.01);
  EXPECT_EQ(json["pairs"], 24);
  EXPECT_EQ(json["convention"]["axes"], "+x +y +z");
  const Eigen::Vector3d bias =
      -read_calibration(out).R_ES.transpose() * read_calibration(out).offset;
  EXPECT_LT((bias - Eigen::Vector3d(0.6, -0.4, 1.1)).norm(), 0.06);
  const auto mirrored =
      run("calibrate", {"--static", (folder / "static.csv").string(), "--with-bias", "--force-sign",
                        "-1", "--force", "--out", out});
  EXPECT_EQ(mirrored.exit_code, 3);
  EXPECT_TRUE(contains(mirrored.err, "swapped sign")) << mirrored.err;
}

TEST(CalibrateTool, AHungMassIsTheDifferenceOfTwoLists) {
  const auto unloaded =
      testing::temporary_file("unloaded.csv",
                              "alpha,beta,gamma,fx,fy,fz\n0,0,0,1,1,1\n0,0,1.57079632679,1,1,1\n"
                              "0,1.57079632679,0,1,1,1\n");
  const auto loaded = testing::temporary_file(
      "loaded.csv",
      "alpha,beta,gamma,fx,fy,fz\n0,0,0,1,1,-3.905\n0,0,1.57079632679,1,-3.905,1\n"
      "0,1.57079632679,0,5.905,1,1\n");
  const test::TemporaryFolder folder;
  const auto out = (folder / "c.json").string();
  const auto result = run("calibrate", {"--loaded", loaded.string(), "--unloaded",
                                        unloaded.string(), "--mass-kg", "0.5", "--out", out});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LT(angle_between(read_calibration(out).R_ES, Eigen::Matrix3d::Identity()), 1e-6);
}

TEST(CalibrateTool, MistakesAreOneLineWithTheirExitCode) {
  const test::TemporaryFolder folder;
  const auto out = (folder / "c.json").string();
  const auto pairs = testing::temporary_file(
      "line.csv", "sx,sy,sz,rx,ry,rz\n0,0,1,0,0,1\n0,0,2,0,0,2\n0,0,3,0,0,3\n");
  EXPECT_EQ(run("calibrate", {"--pairs", pairs.string(), "--out", out}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(out));
  const auto missing = testing::temporary_file("missing.csv", "sx,sy,sz,rx,ry\n0,0,1,0,0\n");
  const auto result = run("calibrate", {"--pairs", missing.string(), "--out", out});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "'rz'")) << result.err;
  EXPECT_EQ(run("calibrate", {"--out", out}).exit_code, 2);
  EXPECT_EQ(run("calibrate", {"--pairs", pairs.string(), "--mass-kg", "1", "--out", out}).exit_code,
            2);
}

TEST(CalibrateTool, RowsOfAMotionAreNoPosesAtRest) {
  const test::TemporaryFolder folder;
  const auto result = run("calibrate", {"--static", DCNN_SOURCE_DIR "/data/sample/test.csv",
                                        "--out", (folder / "c.json").string()});
  EXPECT_EQ(result.exit_code, 3) << result.out;
  EXPECT_TRUE(contains(result.err, "no poses at rest")) << result.err;
}

}  // namespace
}  // namespace dcnn
