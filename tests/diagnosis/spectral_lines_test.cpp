// SPDX-License-Identifier: Apache-2.0
// Lines in simulated noise: their frequency beside lost rows, and how often noise alone makes one.
#include "diagnosis/spectral_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/random.h"
#include "dcnn/data/filter.h"

namespace dcnn {
namespace {

constexpr double kStep = 0.002;
constexpr int kChannels = 3;

/// A recording of 40 s that lost this share of its rows.
Case recording_with(double lost, Rng& rng) {
  std::vector<double> times;
  for (int row = 0; row < 20'000; ++row) {
    if (row == 0 || rng.uniform() >= lost) times.push_back(kStep * row);
  }
  Case study;
  study.channels = {0, 1, 2};
  Log log;
  log.motion.dt = kStep;
  log.motion.t = Eigen::Map<Eigen::VectorXd>(times.data(), static_cast<Index>(times.size()));
  log.motion.segments = {{0, log.motion.t.size()}};
  log.motion.R_BS.resize(times.size());
  study.logs.push_back(std::move(log));
  return study;
}

std::vector<Floor> white_floors() {
  Floor floor;
  floor.white = 1.0;
  floor.dt = kStep;
  return std::vector<Floor>(kChannels, floor);
}

/// White noise of unit variance, of which the channels share a part of the variance.
Signals white_noise(const Case& study, double shared, Rng& rng) {
  Eigen::MatrixXd x(study.logs.front().motion.samples(), kChannels);
  for (Index i = 0; i < x.rows(); ++i) {
    const double common = std::sqrt(shared) * rng.normal();
    for (Index j = 0; j < kChannels; ++j) {
      x(i, j) = common + std::sqrt(1.0 - shared) * rng.normal();
    }
  }
  return {x};
}

TEST(SpectralLines, HaveTheirFrequencyBesideLostRows) {
  Rng rng({1});
  constexpr double kHz = 23.09, kBin = 1.0 / 40.0;
  for (const double lost : {0.0, 0.002, 0.01, 0.05}) {
    const Case study = recording_with(lost, rng);
    Signals left = white_noise(study, 0.0, rng);
    const Eigen::ArrayXd turn = 2.0 * std::numbers::pi * kHz * study.logs[0].motion.t.array();
    left[0].col(1).array() += 0.3 * turn.sin();
    const auto lines = common_lines(study, left, white_floors(), 1.0, 240.0, 1);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_TRUE(lines[0].stands_out()) << lost;
    EXPECT_NEAR(lines[0].hz, kHz, kBin) << lost;
    const auto peaks = spectral_lines(study, left, white_floors(), 1.0, 240.0, 1, 1);
    ASSERT_EQ(peaks.size(), 1u);
    EXPECT_NEAR(peaks[0].hz, kHz, kBin) << lost;
  }
}

// Where a filter of the pose ends, what the pose's noise makes of the force falls at once.
TEST(SpectralLines, AreNoneAtAnEdgeOfTheNoise) {
  Rng rng({4});
  for (int draw = 0; draw < 20; ++draw) {
    const Case study = recording_with(0.0, rng);
    Signals left = white_noise(study, 0.0, rng);
    const Signals more = white_noise(study, 0.0, rng);
    left[0] += 8.0 * low_pass(more[0], study.logs[0].motion.segments, kStep, 25.0);
    for (const auto& line : common_lines(study, left, white_floors(), 20.0, 240.0, 3)) {
      EXPECT_FALSE(line.stands_out()) << line.hz;
    }
  }
}

TEST(SpectralLines, AreNoneOfNoiseThatChannelsShare) {
  constexpr int kDraws = 40;
  Rng rng({2});
  for (const double shared : {0.0, 0.5, 0.9, 1.0}) {
    double terms = 0.0;
    int lines = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Case study = recording_with(0.0, rng);
      const auto found =
          common_lines(study, white_noise(study, shared, rng), white_floors(), 1.0, 240.0, 1);
      lines += found.front().stands_out();
      terms += found.front().terms / kDraws;
    }
    EXPECT_EQ(lines, 0) << shared;
    EXPECT_NEAR(terms, 9.0 / (3.0 + 6.0 * shared * shared), 0.02) << shared;
  }
}

}  // namespace
}  // namespace dcnn
