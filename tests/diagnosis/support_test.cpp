// SPDX-License-Identifier: Apache-2.0
// What held-out data say of two models, against the likelihood ratio and against simulation.
#include "diagnosis/evidence/support.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"

namespace dcnn::evidence {
namespace {

constexpr int kBlocks = 24, kRows = 50;

/// Blocks of a model that adds `size` times a wave to one that adds nothing, in noise of unit
/// variance and correlation rho from row to row; the wave acts `truth` times as large.
std::vector<BlockChange> held_out(double size, double truth, double rho, Rng& rng,
                                  int count = kBlocks) {
  std::vector<BlockChange> blocks(static_cast<std::size_t>(count));
  double noise = rng.normal();
  for (int i = 0; i < count * kRows; ++i) {
    noise = rho * noise + std::sqrt(1.0 - rho * rho) * rng.normal();
    const double wave = size * std::sin(0.05 * i), y = truth * wave + noise;
    BlockChange& block = blocks[static_cast<std::size_t>(i / kRows)];
    block.fall += y * y - (y - wave) * (y - wave);
    block.apart += wave * wave;
  }
  return blocks;
}

TEST(Support, InWhiteNoiseIsTheLogarithmOfTheLikelihoodRatio) {
  Rng rng({1});
  double got = 0.0, exact = 0.0;
  for (int trial = 0; trial < 200; ++trial) {
    const auto blocks = held_out(0.2, 1.0, 0.0, rng);
    for (const BlockChange& block : blocks) exact += 0.5 * block.fall;
    got += log_support(blocks);
  }
  EXPECT_GT(got, 0.8 * exact);  // never above, below where chance makes the blocks differ more
  EXPECT_LE(got, exact);
}

// P(likelihood ratio > a) <= 1/a where the added wave does not act, also in coloured noise.
TEST(Support, SeldomSpeaksForWhatDoesNotAct) {
  for (const double rho : {0.0, 0.6, 0.9}) {
    Rng rng({2});
    int loud = 0;
    constexpr int kTrials = 1000;
    for (int trial = 0; trial < kTrials; ++trial) {
      loud += log_support(held_out(0.15, 0.0, rho, rng)) > std::log(20.0);
    }
    EXPECT_LE(loud, kTrials / 20) << rho;
  }
}

// P(likelihood ratio < 1/a) <= 1/a where the added wave acts, also of blocks so few that they do
// not tell how much they vary: a normal ratio of the deviation that they show has 6 % for 1/20.
TEST(Support, OfFewBlocksSeldomSpeaksAgainstWhatActs) {
  Rng rng({5});
  int loud = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    loud += log_support(held_out(0.3, 1.0, 0.9, rng, 3)) < -std::log(20.0);
  }
  EXPECT_LE(loud, kTrials / 20);
}

TEST(Support, SpeaksAgainstWhatActsTheOtherWay) {
  Rng rng({3});
  int for_it = 0, against = 0;
  for (int trial = 0; trial < 200; ++trial) {
    against += log_support(held_out(0.3, -1.0, 0.6, rng)) < -3.0;
    for_it += log_support(held_out(0.3, 1.0, 0.6, rng)) > 3.0;
  }
  EXPECT_EQ(against, 200);
  // Expected: half of 0.3^2/2 a row, less by (1 + 0.6)/(1 - 0.6): 6.8, deviation 3.7.
  EXPECT_GE(for_it, 150);
}

TEST(Support, OfNothingIsNone) {
  EXPECT_EQ(log_support({}), 0.0);
  EXPECT_EQ(log_support({{5.0, 5.0}}), 0.0);
  EXPECT_EQ(log_support({{0.0, 0.0}, {0.0, 0.0}}), 0.0);
}

// Against a search over the size that was fitted, s times d with s ~ N(1, 1/gained).
TEST(Support, OfAnEstimateIsThatOfTheSizeThatBothBearOut) {
  for (const double gained : {0.5, 6.0, 400.0}) {
    for (const double along : {-3.0, 0.0, 2.5, 8.0}) {  // of what was measured, along d
      const double d = 4.0, fall = 2.0 * along * d - d * d;
      double most = -1e9;
      for (double s = -20.0; s <= 20.0; s += 1e-4) {
        const double off = s - 1.0;
        most = std::max(most, s * along * d - 0.5 * s * s * d * d - 0.5 * gained * off * off);
      }
      const std::vector<BlockChange> blocks(4, {0.25 * fall, 0.25 * d * d});
      EXPECT_NEAR(log_support(blocks, gained), most, 1e-4) << gained << " " << along;
      EXPECT_GE(log_support(blocks, gained), log_support(blocks));
    }
  }
  const std::vector<BlockChange> against(4, {-10.0, 10.0});
  EXPECT_NEAR(log_support(against, 1e9), log_support(against), 1e-3);  // as good as known
  EXPECT_GE(log_support(against, 0.0), 0.0);  // nothing was known of it: nothing is refuted
}

// A force of variance a, one without a name of variance u, which the model with the name leaves,
// and unit noise: a/(a + u), whatever the unit, in the channels in which the name acts.
TEST(Support, TheShareOfAForceIsOfAllThatIsNoNoise) {
  constexpr int kMany = 20000;
  const std::pair<double, double> forces[] = {{4.0, 1.0}, {1.0, 4.0}, {1.0, 0.0}};
  for (const auto& [a, u] : forces) {
    for (const double unit : {1.0, 1e-3}) {
      Rng rng({4});
      std::vector<MeanSquares> channels(2);  // in the second the name makes no force
      for (int i = 0; i < kMany; ++i) {
        const double named = std::sqrt(2.0 * a) * std::sin(0.013 * i),
                     unnamed = std::sqrt(2.0 * u) * std::sin(0.0077 * i + 1.0);
        const double left = unnamed + rng.normal(), other = 10.0 * rng.normal();
        channels[0].add(unit * left, unit * (left + named), unit);
        channels[1].add(other, other, 1.0);
      }
      EXPECT_NEAR(share_explained(channels, kMany), a / (a + u), 0.02) << a << ' ' << u;
    }
  }
}

// Of a name that the held-out data do not show they say nothing.
TEST(Support, AForceThatDoesNotActThereHasItsWholeShare) {
  Rng rng({5});
  std::vector<MeanSquares> channels(1);
  for (int i = 0; i < 100; ++i) {
    const double left = 3.0 * rng.normal();
    channels[0].add(left, left + 1e-3, 1.0);
  }
  EXPECT_EQ(share_explained(channels, 100.0), 1.0);
}

}  // namespace
}  // namespace dcnn::evidence
