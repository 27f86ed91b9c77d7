// SPDX-License-Identifier: Apache-2.0
// dcnn-identify as a user runs it.
#include <gtest/gtest.h>

#include "data/testing.h"
#include "dcnn/physics/simulator.h"
#include "identification/support.h"

namespace dcnn {
namespace {

using test::run;
using testing::contains;

TEST(IdentifyTool, WritesASimulatorAPayloadAndTheNextCommand) {
  const test::TemporaryFolder folder;
  identification_tests::Setting setting;
  setting.samples = 8000;
  write_csv(folder / "log.csv", identification_tests::simulated(setting).recordings[0].noisy.table);
  const auto out = (folder / "sim.json").string();
  const auto result = run("identify", {(folder / "log.csv").string(), "--out", out, "--report",
                                       (folder / "report").string(), "--export", "urdf", "kuka",
                                       "--export-to", (folder / "payload").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "\n  mass  ")) << result.out;
  EXPECT_TRUE(contains(result.out, "Next: dcnn-diagnose --sim " + out)) << result.out;
  EXPECT_NEAR(read_simulator(out).model.mass, 0.75, 0.01);
  EXPECT_TRUE(std::filesystem::exists(folder / "payload" / "payload.urdf"));
  EXPECT_TRUE(std::filesystem::exists(folder / "payload" / "payload.kuka.src"));
  const Json report = read_json(folder / "report" / "identify.json", Exit::kData);
  EXPECT_TRUE(report["parameters"].contains("inertia_xx_kgm2"));
  // A result that exists is kept.
  EXPECT_EQ(run("identify", {(folder / "log.csv").string(), "--out", out}).exit_code, 2);
  const auto again =
      run("identify", {"--from", out, "--export", "ur", "--export-to", (folder / "ur").string()});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "ur" / "payload.script"));
}

/// An inertia that the motion does not show is a guess: the files for others say so, also those
/// that are made of sim.json.
TEST(IdentifyTool, MarksWhatItExportsAndDidNotIdentify) {
  const test::TemporaryFolder folder;
  identification_tests::Setting setting;
  setting.path = identification_tests::trajectory(0.1);  // hardly any acceleration
  setting.noise_nm = 0.02;
  write_csv(folder / "log.csv", identification_tests::simulated(setting).recordings[0].noisy.table);
  const auto out = (folder / "sim.json").string();
  const std::string caution = "NOT IDENTIFIED: the recordings do not show the inertia;";
  const auto found = run("identify", {(folder / "log.csv").string(), "--out", out, "--export", "ur",
                                      "--export-to", (folder / "a").string()});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_TRUE(contains(found.out, caution)) << found.out;
  EXPECT_TRUE(contains(test::slurp(folder / "a/payload.script"), caution));
  const auto again =
      run("identify", {"--from", out, "--export", "ur", "--export-to", (folder / "b").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(contains(again.out, caution)) << again.out;
  EXPECT_EQ(test::slurp(folder / "a/payload.script"), test::slurp(folder / "b/payload.script"));
}

TEST(IdentifyTool, MistakesAreOneLineWithTheirExitCode) {
  const test::TemporaryFolder folder;
  const auto out = (folder / "sim.json").string();
  const auto torque = testing::temporary_file(
      "torque.csv", "t,alpha,beta,gamma,tx,ty,tz\n0,0,0,0,1,1,1\n0.01,0,0,0,1,1,1\n");
  const auto missing = run("identify", {torque.string(), "--out", out});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_TRUE(contains(missing.err, "fx,fy,fz")) << missing.err;
  EXPECT_EQ(run("identify", {"nowhere.csv", "--out", out}).exit_code, 3);
  EXPECT_EQ(run("identify", {torque.string()}).exit_code, 2);
  EXPECT_EQ(run("identify", {torque.string(), "--out", out, "--export", "urdf"}).exit_code, 2);
  EXPECT_EQ(run("identify", {torque.string(), "--out", out, "--export", "step"}).exit_code, 2);
}

}  // namespace
}  // namespace dcnn
