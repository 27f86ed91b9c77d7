// SPDX-License-Identifier: Apache-2.0
// Claims judged from made-up tables in which the answer is known.
#include "experiment/reproduction/claims.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

using Verdict = Claim::Verdict;

const std::vector<std::string> kModels{"ns",     "cf",     "ffnn-s", "cfnn-s",
                                       "ffnn-m", "cfnn-m", "lstm",   "dcnn"};

/// A table in which every claim of the paper is true.
Scores as_the_paper_says() {
  Scores scores{{"fx", "fy", "fz"}, {"N", "N", "N"}, 100, {}};
  for (std::size_t m = 0; m < kModels.size(); ++m) {
    ModelScores model{kModels[m], {}, {}};
    const bool none = kModels[m] == "ns";
    const double rmse = none ? 3.0 : 1.0 - 0.1 * static_cast<double>(m);
    for (const SnrLevel& level : {SnrLevel(), SnrLevel(20.0), SnrLevel(10.0)}) {
      const Spread s{rmse, none ? 0.0 : 0.01 * rmse};
      model.levels.push_back({level, none ? 1 : 20, {s, s, s}, s});
    }
    scores.models.push_back(model);
  }
  return scores;
}

std::vector<Timing> times_of_the_paper() {
  return {{"cf", 1, 10, 1, 0, 10, 0},     {"ffnn-s", 1, 10, 4, 0, 40, 0},
          {"cfnn-s", 1, 10, 6, 0, 60, 0}, {"ffnn-m", 1, 10, 6.7, 0, 67, 0},
          {"cfnn-m", 1, 10, 7, 0, 70, 0}, {"lstm", 1, 10, 11, 0, 110, 0},
          {"dcnn", 1, 10, 3, 0, 30, 0},   {"ffnn-m", 10, 1, 0.1, 0, 0.1, 0}};
}

ModelScores& model(Scores& scores, const std::string& name) {
  return *std::find_if(scores.models.begin(), scores.models.end(),
                       [&](const ModelScores& m) { return m.entry == name; });
}

std::string verdicts(const Scores& scores, const std::vector<Timing>& timings) {
  std::string text;
  for (const Claim& claim : judge_claims(scores, timings)) {
    text += claim.verdict == Verdict::kHolds ? '+' : claim.verdict == Verdict::kFails ? '-' : '?';
  }
  return text;
}

TEST(Claims, AllHoldWhereTheNumbersAreThoseThePaperDescribes) {
  EXPECT_EQ(verdicts(as_the_paper_says(), times_of_the_paper()), "+++++");
}

TEST(Claims, EachFailsAloneWhenItsOwnNumberIsWrong) {
  const auto times = times_of_the_paper();
  auto scores = as_the_paper_says();
  for (auto& level : model(scores, "lstm").levels) level.rmse[1].mean = 0.65;  // fy above ffnn-m
  EXPECT_EQ(verdicts(scores, times), "-++++");

  scores = as_the_paper_says();
  for (auto& level : model(scores, "cf").levels) level.rmse[0].mean = 0.1;
  EXPECT_EQ(verdicts(scores, times), "+-+++");

  scores = as_the_paper_says();
  for (auto& level : model(scores, "lstm").levels) level.overall->deviation = 1e-4;
  EXPECT_EQ(verdicts(scores, times), "++-++");

  scores = as_the_paper_says();
  for (auto& level : model(scores, "cf").levels) level.overall->mean = 0.75;  // below ffnn-s
  EXPECT_EQ(verdicts(scores, times), "+++-+");

  scores = as_the_paper_says();
  for (auto& level : model(scores, "ffnn-s").levels) level.overall->mean = 3.1;  // above ns
  EXPECT_EQ(verdicts(scores, times), "+++-+");

  auto slow = times_of_the_paper();
  slow.back() = {"dcnn", 5, 2, 9, 0, 18, 0};  // another length says nothing
  EXPECT_EQ(verdicts(as_the_paper_says(), slow), "+++++");
  slow[6].mean_s = 6.9;  // above ffnn-m
  EXPECT_EQ(verdicts(as_the_paper_says(), slow), "++++-");
}

TEST(Claims, TheCleanLevelDoesNotCount) {
  auto scores = as_the_paper_says();
  model(scores, "dcnn").levels[0].rmse.assign(3, {9.0, 9.0});
  model(scores, "dcnn").levels[0].overall = Spread{9.0, 9.0};
  EXPECT_EQ(verdicts(scores, times_of_the_paper()), "+++++");
}

TEST(Claims, AreNotTestedWithoutTheirNumbers) {
  auto scores = as_the_paper_says();
  EXPECT_EQ(verdicts(scores, {}), "+++??");
  for (auto& m : scores.models) {
    for (auto& level : m.levels) level.runs = 1;
  }
  EXPECT_EQ(verdicts(scores, {}), "++???") << "one draw has no standard deviation";
  scores.targets = {"tau1", "tau2", "tau3"};
  EXPECT_EQ(verdicts(scores, {}), "?????");
  scores = as_the_paper_says();
  std::erase_if(scores.models, [](const ModelScores& m) { return m.entry == "lstm"; });
  EXPECT_EQ(verdicts(scores, times_of_the_paper()), "????+");
}

TEST(Claims, TimesThatIncludeMakingTheFeaturesDoNotCount) {
  auto times = times_of_the_paper();
  Timing slow{"dcnn", 1, 10, 50, 0, 500, 0};
  slow.from_pose = true;
  times.insert(times.begin(), slow);
  EXPECT_EQ(verdicts(as_the_paper_says(), times), "+++++");
}

TEST(Claims, OneAugmentedModelIsTakenFromTheOtherTable) {
  const Scores with = as_the_paper_says();
  Scores without = as_the_paper_says();
  for (auto& m : without.models) {
    for (auto& level : m.levels) level.overall->mean += 1.0;
  }
  const Scores mixed = only_one_augmented(with, without, "dcnn");
  EXPECT_NEAR(mixed.find("dcnn")->levels[1].overall->mean, 0.3, 1e-12);
  EXPECT_NEAR(mixed.find("cf")->levels[1].overall->mean, 1.9, 1e-12);
}

}  // namespace
}  // namespace dcnn
