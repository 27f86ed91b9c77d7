// SPDX-License-Identifier: Apache-2.0
// dcnn-bench as a user runs it, on a model small enough to be quick.
#include "dcnn/experiment/bench.h"

#include <gtest/gtest.h>

#include "dcnn/core/json.h"
#include "dcnn/data/csv.h"
#include "support/page.h"
#include "support/process.h"

namespace dcnn {
namespace {

TEST(Bench, CallCountsAreThoseOfTheTable) {
  EXPECT_EQ(call_count(kPaperTestSamples, 1), 32045);
  EXPECT_EQ(call_count(kPaperTestSamples, 5), 6409);
  EXPECT_EQ(call_count(kPaperTestSamples, 10), 3205);  // the last one holds 5
}

TEST(Bench, TimesEveryLengthFromFeaturesAndFromThePose) {
  const test::TemporaryFolder folder;
  const std::string model = (folder / "m.dcnn").string();
  const std::string sample = std::string(DCNN_SOURCE_DIR) + "/data/sample/";
  ASSERT_EQ(test::run("train", {"--train", sample + "train.csv", "--preset", "quick", "--epochs",
                                "1", "--out", model, "--quiet"})
                .exit_code,
            0);
  Table few = read_csv(sample + "test.csv");
  few.values.conservativeResize(400, Eigen::NoChange);
  write_csv(folder / "few.csv", few);
  const auto out = folder / "timing";
  const auto result =
      test::run("bench", {model, "--data", (folder / "few.csv").string(), "--lengths", "1,3",
                          "--repetitions", "2", "--json", "--out", out.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = parse_json(result.out, "bench", Exit::kFailure);
  EXPECT_EQ(json["threads"], 1);
  ASSERT_EQ(json["rows"].size(), 4u);
  for (const Json& row : json["rows"]) {
    EXPECT_EQ(row["model"], "dcnn");
    EXPECT_GT(row["mean_s"].get<double>(), 0.0);
    EXPECT_LE(row["p50_s"].get<double>(), row["p99_s"].get<double>());
    EXPECT_LE(row["p99_s"].get<double>(), row["max_s"].get<double>());
    EXPECT_GE(row["total_s"].get<double>(),
              row["mean_s"].get<double>() * row["calls"].get<double>());
  }
  EXPECT_EQ(json["rows"][0]["features_included"], false);
  EXPECT_EQ(json["rows"][1]["features_included"], true);
  const std::string page = test::slurp(out / "bench.html");
  test::expect_usable_page(page);
  for (const char* words : {"<nav>", "samples a call", "m.dcnn, from the features"}) {
    EXPECT_NE(page.find(words), page.npos) << words;
  }
  EXPECT_EQ(test::run("bench", {model, "--lengths", "0"}).exit_code, 2);
  EXPECT_EQ(test::run("bench", {(folder / "none.dcnn").string()}).exit_code, 4);
}

}  // namespace
}  // namespace dcnn
