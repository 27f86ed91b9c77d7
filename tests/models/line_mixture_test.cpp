// SPDX-License-Identifier: Apache-2.0
// Line fits mixed by the level of noise, against what is known of white noise and of single lines.
#include "models/line_mixture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "dcnn/data/line_filter.h"

namespace dcnn {
namespace {

constexpr Index kMixtureRows = 6000;
const std::vector<Index> kLengths{8, 24, 64, 128};

/// Three sines of unit spread, of 0.4 to 0.7 Hz at 500 Hz.
Samples sines(double phase) {
  Samples s;
  s.x.resize(kMixtureRows, 3);
  for (Index i = 0; i < kMixtureRows; ++i) {
    for (Index j = 0; j < 3; ++j) {
      const double w = 0.005 + 0.002 * static_cast<double>(j);
      s.x(i, j) = std::sqrt(2.0) * std::sin(w * static_cast<double>(i) + phase);
    }
  }
  s.segments = {{0, kMixtureRows}};
  return s;
}

Eigen::MatrixXd with_white(Eigen::MatrixXd x, double deviation, std::uint64_t seed) {
  Rng rng(seed);
  for (double& value : x.reshaped()) value += deviation * rng.normal();
  return x;
}

double rms(const Eigen::MatrixXd& x) { return std::sqrt(x.array().square().mean()); }

TEST(NoiseLevel, IsThatOfTheSecondDifferencesOfWhiteNoise) {
  const double deviation = 0.05;
  const Eigen::MatrixXd x = with_white(Eigen::MatrixXd::Constant(4000, 2, 3.0), deviation, 1);
  NoiseLevel level(Eigen::Vector2d(1.0, 10.0));
  double sum = 0.0;
  for (Index i = 0; i < x.rows(); ++i) {
    const double now = level.push(x.row(i));
    EXPECT_EQ(now == NoiseLevel::kUnknown, i < 9) << "row " << i;
    if (i >= 200) sum += now;
  }
  const double second = std::sqrt(6.0) * deviation;  // 1, -2, 1
  const double wanted = 0.5 * (std::log10(second) + std::log10(second / 10.0));
  EXPECT_NEAR(sum / 3800.0, wanted, 0.01);
}

TEST(NoiseLevel, ForgetsTheSegmentBefore) {
  NoiseLevel used(Eigen::VectorXd::Ones(1)), fresh(Eigen::VectorXd::Ones(1));
  for (int i = 0; i < 50; ++i) used.push(Eigen::RowVectorXd::Constant(1, 1e3 * i * i));
  used.restart();
  for (int i = 0; i < 50; ++i) {
    const Eigen::RowVectorXd row = Eigen::RowVectorXd::Constant(1, std::sin(i));
    EXPECT_EQ(used.push(row), fresh.push(row)) << i;
  }
}

/// No single window is good at every level; the mixture is to be as good as the best one of each.
TEST(LineMixture, IsAtEveryLevelAsGoodAsTheBestWindow) {
  const Samples training = sines(0.3), test = sines(1.7);
  const LineMixture mixture =
      LineMixture::learn(training, {}, InputMap(training.x, {}), kLengths, 3);
  for (const double snr : {10.0, 20.0, 40.0, 55.0}) {
    const Eigen::MatrixXd noisy = with_white(test.x, std::pow(10.0, -snr / 20.0), 5);
    const auto begins = test.segment_begins();
    std::vector<Eigen::MatrixXd> lines;
    double best = 1e9;
    for (const Index length : kLengths) {
      lines.push_back(line_filtered(noisy, begins, length));
      best = std::min(best, rms((lines.back() - test.x).bottomRows(kMixtureRows - 200)));
    }
    const Eigen::MatrixXd mixed = mixture.of(noisy, begins, lines);
    EXPECT_LT(rms((mixed - test.x).bottomRows(kMixtureRows - 200)), 1.02 * best) << snr << " dB";
  }
}

TEST(LineMixture, FromItsTextIsTheSame) {
  const Samples training = sines(0.3);
  const LineMixture mixture =
      LineMixture::learn(training, {}, InputMap(training.x, {}), kLengths, 3);
  const LineMixture copy = LineMixture::parse(mixture.to_json(), 3, 4, "m");
  Eigen::MatrixXd lines = with_white(Eigen::MatrixXd::Zero(4, 3), 1.0, 2);
  Eigen::RowVectorXd one(3), other(3);
  for (const double level : {-9.0, -3.0, -2.2, -1.0, NoiseLevel::kUnknown}) {
    mixture.mix(lines, level, one);
    copy.mix(lines, level, other);
    EXPECT_EQ(one, other) << level;
  }
  EXPECT_THROW(LineMixture::parse(mixture.to_json(), 4, 4, "m"), Error);
  Json falling = mixture.to_json();
  std::swap(falling["levels"][0], falling["levels"][1]);
  EXPECT_THROW(LineMixture::parse(falling, 3, 4, "m"), Error);
}

}  // namespace
}  // namespace dcnn
