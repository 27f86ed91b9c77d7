// SPDX-License-Identifier: Apache-2.0
// Single rows that are no reading: found, mended, and told from noise and from impacts.
#include "data/spikes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dcnn {
namespace {

constexpr Index kReadings = 5000;

/// A slow force of 2 N and noise of 20 mN, with the tails of Student's t of five degrees.
Eigen::VectorXd noisy_force(unsigned seed) {
  std::mt19937 random(seed);
  std::student_t_distribution<double> noise(5.0);
  Eigen::VectorXd x(kReadings);
  for (Index i = 0; i < kReadings; ++i) {
    x[i] = 2.0 * std::sin(0.004 * static_cast<double>(i)) + 0.02 * noise(random);
  }
  return x;
}

Recording force_log(const Eigen::VectorXd& fx, double dt) {
  Recording recording;
  recording.name = "a.csv";
  recording.dt = dt;
  recording.table.values.resize(kReadings, 0);
  recording.set("fx", fx);
  return recording;
}

TEST(Spikes, AreThoseThatWerePutThere) {
  Eigen::VectorXd x = noisy_force(1);
  for (const Index row : {700, 2500, 4321}) x[row] += 3.0;
  const Spikes spikes = spikes_of(x);
  EXPECT_EQ(spikes.rows, (std::vector<Index>{700, 2500, 4321}));
  EXPECT_LT(spikes.p, 1e-6);
  EXPECT_EQ(spikes.words("fx").find("3 outliers in fx, up to "), 0U) << spikes.words("fx");
}

TEST(Spikes, TheMiddleOfTheirNeighboursStandsThere) {
  const Eigen::VectorXd clean = noisy_force(2);
  Eigen::VectorXd x = clean;
  x[1234] -= 5.0;
  Recording recording = force_log(x, 0.01);
  mend_spikes(recording, {"fx", "fy"});
  const Eigen::VectorXd mended = recording.column("fx");
  EXPECT_LT(std::abs(mended[1234] - clean[1234]), 0.2);
  EXPECT_EQ((mended - x).cwiseAbs().count(), 1) << "other rows are untouched";
  ASSERT_EQ(recording.notes.size(), 1U);
}

// A log that was put on a faster clock by lines: between the readings nothing is off its
// neighbours.
TEST(Spikes, ReadingsBetweenRowsFilledInByLinesAreNone) {
  const Eigen::VectorXd clean = noisy_force(3);
  constexpr Index kEach = 12;
  Eigen::VectorXd x(kReadings);
  for (Index i = 0; i < kReadings; ++i) {
    const double part = static_cast<double>(i % kEach) / kEach;
    x[i] = (1.0 - part) * clean[i / kEach] + part * clean[i / kEach + 1];
    x[i] = 1e-6 * std::round(1e6 * x[i]);
  }
  EXPECT_GT(spikes_of(x).p, 0.01);
  x[1234] += 3.0;
  EXPECT_EQ(spikes_of(x).rows, (std::vector<Index>{1234}));
}

// Heavy-tailed noise (2 % of the samples with seven times the deviation) is no lost reading.
TEST(Spikes, ThatAreManyStay) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  Eigen::VectorXd x(kReadings);
  for (Index i = 0; i < x.size(); ++i) x[i] = (i % 50 == 0 ? 0.3 : 0.04) * normal(random);
  Recording recording = force_log(x, 0.002);
  EXPECT_LT(spikes_of(x).p, 1e-6);
  mend_spikes(recording, {"fx"});
  EXPECT_EQ(recording.column("fx"), x);
}

// Poses in a list have no neighbours.
TEST(Spikes, OfAListWithoutAClockStay) {
  Eigen::VectorXd x = noisy_force(2);
  x[1234] -= 5.0;
  Recording recording = force_log(x, 0.0);
  mend_spikes(recording, {"fx"});
  EXPECT_EQ(recording.column("fx"), x);
  EXPECT_TRUE(recording.notes.empty());
}

// Of 300 recordings of heavy-tailed noise fewer than one in a hundred loses a row.
TEST(Spikes, HeavyTailsAreReadings) {
  int mended = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    Recording recording = force_log(noisy_force(seed), 0.01);
    mend_spikes(recording, {"fx"});
    mended += recording.notes.empty() ? 0 : 1;
  }
  EXPECT_LE(mended, 3);
}

// An impact rings for some rows, and a constant channel has none.
TEST(Spikes, ImpactsAndConstantsHaveNone) {
  Eigen::VectorXd x = noisy_force(4);
  for (Index i = 0; i < 12; ++i) {
    const double s = static_cast<double>(i);
    x[3000 + i] += 3.0 * std::exp(-s / 4.0) * std::cos(1.2 * s);
  }
  EXPECT_GE(spikes_of(x).p, 0.001);
  EXPECT_TRUE(spikes_of(Eigen::VectorXd::Constant(kReadings, 3.0)).rows.empty());
  EXPECT_TRUE(spikes_of(Eigen::VectorXd::Zero(3)).rows.empty());
}

}  // namespace
}  // namespace dcnn
