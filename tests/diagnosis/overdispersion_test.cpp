// SPDX-License-Identifier: Apache-2.0
// The overdispersion of surrogate scores, by simulation.
#include <gtest/gtest.h>

#include <vector>

#include "dcnn/core/random.h"
#include "diagnosis/judgement.h"

namespace dcnn {
namespace {

/// Scores of twelve shifts: chi-square of `freedom` degrees, so many times as loud as noise.
std::vector<double> shifted_scores(double loud, int freedom, Rng& rng) {
  std::vector<double> scores(12, 0.0);
  for (double& score : scores) {
    for (int k = 0; k < freedom; ++k) {
      const double z = rng.normal();
      score += loud * z * z;
    }
  }
  return scores;
}

TEST(Overdispersion, OfNoiseIsOne) {
  Rng rng({3});
  constexpr int kDraws = 1000, kFreedom = 8;
  int above = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const double loud = overdispersion(shifted_scores(1.0, kFreedom, rng), kFreedom);
    EXPECT_GE(loud, 1.0);
    above += loud > 1.0;
  }
  EXPECT_LT(above, kDraws / 20) << "a law in noise alone keeps the power of its test";
}

TEST(Overdispersion, OfWhatIsLouderIsNeverMuchMore) {
  Rng rng({4});
  constexpr int kDraws = 1000, kFreedom = 8;
  double sum = 0.0;
  int above = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const double loud = overdispersion(shifted_scores(50.0, kFreedom, rng), kFreedom);
    sum += loud / kDraws;
    above += loud > 60.0;
  }
  EXPECT_NEAR(sum, 50.0 * 0.698, 1.0);  // mean of the fourth least of twelve, over the freedom
  EXPECT_LT(above, kDraws / 20);
}

// A motion that repeats itself is at half of its shifts where it was, and a law that it refutes is
// refuted all the same.
TEST(Overdispersion, IsNotThatOfShiftsAtWhichAMotionRepeatsItself) {
  Rng rng({5});
  std::vector<double> scores = shifted_scores(1.0, 8, rng);
  for (std::size_t k = 0; k < scores.size(); k += 2) scores[k] *= 1e4;
  EXPECT_LT(overdispersion(scores, 8.0), 2.0);
}

}  // namespace
}  // namespace dcnn
