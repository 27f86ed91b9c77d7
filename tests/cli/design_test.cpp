// SPDX-License-Identifier: Apache-2.0
#include "support/design.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dcnn/core/file.h"
#include "dcnn/data/csv.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;

class DesignTool : public testing::Test {
 protected:
  DesignTool() {
    const design::DesignRequest request = test::friction_request();
    std::filesystem::create_directories(folder_ / "report");
    write_file(folder_ / "report" / "report.json", request.report.dump(2));
    write_file(folder_ / "report" / "model.json", request.model.dump(2));
    write_file(folder_ / "limits.json", test::tool_limits_json().dump(2));
  }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  test::Result design(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{
        "--report",         path("report"), "--limits", path("limits.json"), "--out",
        path("motion.csv"), "--seconds",    "6",        "--evaluations",     "5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run("design", arguments);
  }
  test::TemporaryFolder folder_;
};

TEST_F(DesignTool, WritesTheMotionAndAddsItToTheReport) {
  const auto result = design();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("decides     with probability"), std::string::npos) << result.out;
  const Table motion = read_csv(path("motion.csv"));
  EXPECT_EQ(motion.columns,
            (std::vector<std::string>{"t", "x", "y", "z", "alpha", "beta", "gamma"}));
  EXPECT_EQ(motion.values.rows(), 3001);
  EXPECT_LT((motion.values.row(0) - motion.values.row(3000)).tail(6).norm(), 1e-12);
  const Json report = read_json(folder_ / "report" / "report.json", Exit::kData);
  EXPECT_EQ(report["next_motion"]["design"].get<std::string>(), path("motion.csv"));
  EXPECT_GT(report["next_motion"]["probability"].get<double>(), 0.0);
  EXPECT_EQ(design().exit_code, 2);  // what exists is kept
  EXPECT_EQ(design({"--force"}).exit_code, 0);
}

TEST_F(DesignTool, SaysInOneLineWhatIsWrong) {
  write_file(folder_ / "limits.json", "{\"speed_mps\": 0.2}");
  const auto limits = design();
  EXPECT_EQ(limits.exit_code, 2);
  EXPECT_NE(limits.err.find("'position_m' is missing"), std::string::npos) << limits.err;
  EXPECT_EQ(std::count(limits.err.begin(), limits.err.end(), '\n'), 1) << limits.err;
  std::filesystem::remove(folder_ / "report" / "model.json");
  write_file(folder_ / "limits.json", test::tool_limits_json().dump());
  EXPECT_EQ(design().exit_code, 3);
}

TEST_F(DesignTool, SaysWhichFolderHoldsAReport) {
  const auto refused = [&](const std::string& report, const std::string& words) {
    const auto result = run("design", {"--report", report, "--limits", path("limits.json"), "--out",
                                       path("motion.csv")});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.err.rfind("dcnn-design: " + report + ": " + words + "; --report takes", 0), 0U)
        << result.err;
    EXPECT_NE(result.err.find("dcnn-diagnose --sim"), std::string::npos) << result.err;
  };
  refused(path("nowhere"), "does not exist");
  refused(path("limits.json"), "is a file");
  refused(folder_.path().string(), "is a folder without report.json");
  std::filesystem::remove(folder_ / "report" / "model.json");
  refused(path("report"), "is a folder without model.json");
}

}  // namespace
}  // namespace dcnn
