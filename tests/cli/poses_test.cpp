// SPDX-License-Identifier: Apache-2.0
// Lists of poses at rest, of a tool and of an arm's joints, as a user learns from them.
#include <gtest/gtest.h>

#include <cmath>

#include "data/testing.h"
#include "dcnn/core/file.h"
#include "dcnn/core/json.h"
#include "dcnn/core/random.h"
#include "dcnn/data/csv.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;
using testing::contains;

class Poses : public ::testing::Test {
 protected:
  /// 300 poses of a tool of 0.7 kg and of two joints that carry it.
  Poses() {
    Rng rng({7});
    Table tool{{"alpha", "beta", "gamma", "fx", "fy", "fz"}, Eigen::MatrixXd(300, 6)};
    Table arm{{"q1", "q2", "tau1", "tau2"}, Eigen::MatrixXd(300, 4)};
    for (Eigen::Index i = 0; i < 300; ++i) {
      const double b = 0.8 * rng.normal(), c = 3.0 + 0.8 * rng.normal();
      tool.values.row(i) << rng.normal(), b, c, 6.9 * std::sin(b), -6.9 * std::cos(b) * std::sin(c),
          -6.9 * std::cos(b) * std::cos(c);
      tool.values.row(i).tail(3) +=
          0.04 * Eigen::RowVector3d(rng.normal(), rng.normal(), rng.normal());
      const double q = rng.normal(), p = rng.normal(), outer = 3.0 * std::sin(q + p);
      arm.values.row(i) << q, p, 8.0 * std::sin(q) + outer + 0.02 * rng.normal(),
          outer + 0.02 * rng.normal();
    }
    write_csv(folder_ / "tool.csv", tool);
    write_csv(folder_ / "arm.csv", arm);
    write_file(folder_ / "arm.json", R"({"kind": "axes", "axes": [
      {"name": "joint1", "measured": "tau1", "unit": "N*m", "position": "q1", "base": ["position"]},
      {"name": "joint2", "measured": "tau2", "unit": "N*m", "position": "q2", "base": ["position"]}]})");
  }
  std::string at(const std::string& name) const { return folder_ / name; }
  test::Result train(const std::string& log, const std::string& model) const {
    std::vector<std::string> arguments{
        "-q",    "--train",           at(log),   "--model",  model,
        "--out", at(model + ".dcnn"), "--force", "--preset", "quick"};
    if (log == "arm.csv") arguments.insert(arguments.end(), {"--system", at("arm.json")});
    return run("train", arguments);
  }

  test::TemporaryFolder folder_;
};

/// Contract, section 4: cf, rigid, ffnn and mlp.
TEST_F(Poses, AreLearnedByModelsOfTheOrientation) {
  for (const char* log : {"tool.csv", "arm.csv"}) {
    for (const char* model : {"cf", "rigid", "ffnn-s", "mlp"}) {
      SCOPED_TRACE(std::string(log) + " " + model);
      const auto trained = train(log, model);
      EXPECT_EQ(trained.exit_code, 0) << trained.err;
      EXPECT_FALSE(contains(trained.out, "white noise")) << trained.out;  // none among poses
      const auto scored = run("eval", {at(std::string(model) + ".dcnn"), "--data", at(log), "--snr",
                                       "clean", "--json"});
      ASSERT_EQ(scored.exit_code, 0) << scored.err;
      const Json rows = parse_json(scored.out, "eval", Exit::kFailure)["rows"];
      if (model == std::string("cf") || model == std::string("rigid")) {  // the others: a few steps
        EXPECT_LT(rows[0]["rmse_overall"].get<double>(), 2.0);
      }
    }
  }
}

TEST_F(Poses, AreRefusedByModelsOfMotionWithTheNamesOfTheOthers) {
  for (const char* log : {"tool.csv", "arm.csv"}) {
    for (const char* model : {"dcnn", "lstm", "rls", "cfnn-s"}) {
      const auto refused = train(log, model);
      EXPECT_EQ(refused.exit_code, 3) << model;
      EXPECT_TRUE(contains(refused.err, std::string(model) + " learns from motion") &&
                  contains(refused.err, "--model ns, cf, rigid, ffnn-s, ffnn-m, mlp"))
          << refused.err;
    }
    const auto best = train(log, "auto");
    EXPECT_EQ(best.exit_code, 0) << best.err;
    EXPECT_TRUE(contains(best.out, "chosen: ")) << best.out;
  }
}

TEST_F(Poses, TooFewForANetworkAreLearnedByTheRigidTool) {
  Table few = read_csv(at("tool.csv"));
  few.values.conservativeResize(51, Eigen::NoChange);
  write_csv(at("few.csv"), few);
  const auto best = run("train", {"--train", at("few.csv"), "--model", "auto", "--preset", "quick",
                                  "--out", at("few.dcnn")});
  ASSERT_EQ(best.exit_code, 0) << best.err;
  EXPECT_TRUE(contains(best.out, "chosen: rigid")) << best.out;
  EXPECT_TRUE(contains(best.err, "mlp is left out: only ")) << best.err;
  const auto named = run("train", {"-q", "--train", at("few.csv"), "--model", "mlp", "--preset",
                                   "quick", "--out", at("mlp.dcnn")});
  EXPECT_EQ(named.exit_code, 3) << "what is asked for by its name is not left out";
}

TEST_F(Poses, OfAToolAreDiagnosedWithAndWithoutTimes) {
  write_file(
      folder_ / "sim.json",
      R"({"tool": {"mass_kg": 0.6, "com_m": [0, 0, 0.1], "inertia_kgm2": [0.01, 0.01, 0.01, 0, 0, 0]}})");
  Table timed = read_csv(folder_ / "tool.csv");
  timed.columns.insert(timed.columns.begin(), "t");
  Eigen::MatrixXd rows(timed.values.rows(), timed.values.cols() + 1);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {  // one every ten seconds, and not on a clock
    rows.row(i) << 10.0 * static_cast<double>(i) + 3.0 * std::sin(static_cast<double>(i)),
        timed.values.row(i);
  }
  timed.values = rows;
  write_csv(folder_ / "timed.csv", timed);
  for (const char* log : {"tool.csv", "timed.csv"}) {
    const auto diagnosed = run("diagnose", {"-q", "--sim", at("sim.json"), "--fit", at(log),
                                            "--out", at("report"), "--force"});
    EXPECT_EQ(diagnosed.exit_code, 0) << log << ": " << diagnosed.err;
    EXPECT_TRUE(contains(diagnosed.out, "mass")) << diagnosed.out;
  }
}

TEST_F(Poses, OfJointsAreDiagnosedWithoutTimes) {
  const auto diagnosed = run("diagnose", {"-q", "--system", at("arm.json"), "--fit", at("arm.csv"),
                                          "--out", at("report")});
  EXPECT_EQ(diagnosed.exit_code, 0) << diagnosed.err;
  // A sine of the position, of which the simulator has the line.
  EXPECT_TRUE(contains(diagnosed.out, "a load off its axis") ||
              contains(diagnosed.out, "A load off its axis"))
      << diagnosed.out;
  EXPECT_TRUE(contains(diagnosed.out, "do not tell the noise of their readings")) << diagnosed.out;
}

}  // namespace
}  // namespace dcnn
