// SPDX-License-Identifier: Apache-2.0
// Rows whose stamps jitter: taken when the stamps say, or evenly beside stamps that are noise.
#include "data/even_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace dcnn {
namespace {

constexpr Index kStamps = 6000;
constexpr double kTick = 0.002, kJitter = 0.05;  // s; of a step, its deviation

double place_at(double t) { return 0.2 * std::sin(1.3 * t) + 3e-4 * std::sin(61.0 * t); }

/// A position of 1 micrometre of noise, at 500 Hz, with every hundredth row lost; each row is taken
/// at its stamp, or `evenly`.
Recording stamped(bool evenly, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Recording recording;
  recording.name = "a.csv";
  recording.dt = kTick;
  std::vector<double> t, x;
  for (Index i = 0; i < kStamps; ++i) {
    const double tick = kTick * static_cast<double>(i),
                 stamp = tick + kJitter * kTick * normal(random);
    const double noise = 1e-6 * normal(random);
    if (i % 100 == 50) continue;
    t.push_back(stamp);
    x.push_back(place_at(evenly ? tick : stamp) + noise);
  }
  const auto count = static_cast<Index>(t.size());
  recording.table.values.resize(count, 0);
  recording.set("t", Eigen::Map<Eigen::VectorXd>(t.data(), count));
  recording.set("x", Eigen::Map<Eigen::VectorXd>(x.data(), count));
  recording.set("fx", Eigen::VectorXd::Ones(count));
  recording.segments = {{0, count}};
  return recording;
}

/// Rms distance from the motion at the recording's times, without its ends [m].
double error_of(const Recording& recording) {
  const Eigen::VectorXd t = recording.column("t"), x = recording.column("x");
  const Index end = 60, count = t.size() - 2 * end;
  double square = 0.0;
  for (Index i = end; i < end + count; ++i) square += std::pow(x[i] - place_at(t[i]), 2);
  return std::sqrt(square / static_cast<double>(count));
}

/// Rms of the time's own second differences where no row is lost [s].
double unevenness(const Recording& recording) {
  const Eigen::VectorXd t = recording.column("t");
  double square = 0.0, count = 0.0;
  for (Index i = 60; i + 61 < t.size(); ++i) {
    if (t[i + 1] - t[i - 1] > 2.5 * kTick) continue;
    square += std::pow(t[i + 1] - 2.0 * t[i] + t[i - 1], 2), count += 1.0;
  }
  return std::sqrt(square / count);
}

TEST(EvenClock, RowsTakenAtTheirStampsArePutOnOne) {
  Recording recording = stamped(false, 1);
  EXPECT_GT(unevenness(recording), 2.0 * kJitter * kTick);
  ASSERT_TRUE(put_on_even_clock(recording, {"x", "y"}));
  EXPECT_LT(unevenness(recording), 0.2 * kJitter * kTick);  // of 51 stamps the mean jitters too
  EXPECT_LT(error_of(recording), 1.1e-6);
  EXPECT_TRUE((recording.column("fx").array() == 1.0).all());
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find(" ms off an even clock, as their stamps say"),
            std::string::npos)
      << recording.notes[0];
}

// A log that stamps rows when they arrive: the rows are even, and stay.
TEST(EvenClock, EvenRowsWithStampsThatJitterStay) {
  Recording recording = stamped(true, 2);
  const Recording before = recording;
  EXPECT_FALSE(put_on_even_clock(recording, {"x"}));
  EXPECT_EQ(recording.table.values, before.table.values);
  EXPECT_LT(log_odds_of_stamps(recording, {"x"}), -100.0);
}

// The odds tell which of the two it was, in each of 200 recordings.
TEST(EvenClock, TheOddsAreRight) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    EXPECT_GT(log_odds_of_stamps(stamped(false, seed), {"x"}), 7.0) << seed;
    EXPECT_LT(log_odds_of_stamps(stamped(true, seed), {"x"}), -7.0) << seed;
  }
}

TEST(EvenClock, NoMotionAndNoClockTellNothing) {
  Recording still = stamped(true, 3);
  still.set("x", Eigen::VectorXd::Constant(still.samples(), 0.3));
  EXPECT_EQ(log_odds_of_stamps(still, {"x"}), 0.0);
  EXPECT_FALSE(put_on_even_clock(still, {"x"}));
  Recording poses = stamped(false, 4);
  poses.dt = 0.0;
  EXPECT_FALSE(put_on_even_clock(poses, {"x"}));
}

}  // namespace
}  // namespace dcnn
