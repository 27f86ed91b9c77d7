// SPDX-License-Identifier: Apache-2.0
// The block means that frame-tcn sees and the filters on them, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "models/frame_tcn/front.h"
#include "models/frame_tcn/pose_noise_moments.h"

namespace dcnn::frame_tcn {
namespace {

TEST(FrameTcnFilters, FiltersOfWhiteSignalsAreTheScalarWienerGain) {
  Rng rng(1);
  Eigen::MatrixXd x(20000, kChannels);
  for (Index i = 0; i < x.size(); ++i) x.data()[i] = rng.normal();
  const Moments m = moments(BlockMeans(x, {}), 3, 1);
  const Eigen::MatrixXd w = wiener(m, white_noise_moments(Eigen::Vector2d(0.25, 0.25)));
  EXPECT_NEAR(w(0, 0), 0.8, 0.02) << "1/(1 + 0.25) on the newest sample";
  EXPECT_NEAR(w(1, kBlocks), 0.8, 0.02);
  Eigen::MatrixXd rest = w;
  rest(0, 0) = rest(1, kBlocks) = 0.0;
  EXPECT_LT(rest.cwiseAbs().maxCoeff(), 0.15);
}

TEST(FrameTcnFilters, BlocksAreMeansOfTheRows) {
  Eigen::MatrixXd x(1200, 1);
  Rng rng(2);
  for (Index i = 0; i < x.rows(); ++i) x(i, 0) = rng.normal();
  const BlockMeans blocks(x, {{0, 600}, {600, 1200}});
  double out[kBlocks];
  for (const Index row : {0, 3, 25, 599, 600, 610, 700, 1199}) {
    const Index begin = row < 600 ? 0 : 600, padding = std::min<Index>(16, row + 1 - begin);
    const double before = x.col(0).segment(begin, padding).mean();
    blocks.write(row, 0, kBlocks, out);
    Index lag = 0, whole = 0;
    for (Index k = 0; k < kBlocks; ++k) {
      double sum = 0.0;
      for (Index i = 0; i < block_size(k); ++i, ++lag) {
        sum += row - lag < begin ? before : x(row - lag, 0);
      }
      EXPECT_NEAR(out[k], sum / static_cast<double>(block_size(k)), 1e-12);
      if (row - lag + 1 >= begin) whole = k + 1;
    }
    EXPECT_EQ(lag, kSpan);
    EXPECT_EQ(blocks.known(row), whole);
  }
}

TEST(FrameTcnFilters, BlocksAreHandedOnAndTheOldestHeld) {
  Eigen::MatrixXd x(700, kChannels);
  Rng rng(3);
  for (double& value : x.reshaped()) value = rng.normal();
  const BlockMeans blocks(x, {});
  Front front(kBlocks);
  front.hand_on_blocks();
  double means[kBlocks];
  for (const Index row : {2, 30, 699}) {
    const Eigen::MatrixXd handed = front.apply(blocks, row, 1);
    const Index known = kHistories[history_of(blocks.known(row))];
    for (Index c = 0; c < kChannels; ++c) {
      blocks.write(row, c, kBlocks, means);
      for (Index k = 0; k < kBlocks; ++k) {
        EXPECT_NEAR(handed(c * kBlocks + k, 0), means[std::min(k, known - 1)], 1e-12);
      }
    }
  }
}

/// Of a random walk in noise the best estimate is the steady state of a Kalman filter, from the
/// first row on: no filter whose history is made up reaches it.
TEST(FrameTcnFilters, YoungSegmentsGetTheBestEstimateOfTheBlocksTheyHave) {
  Moments walk;
  constexpr Index n = 8;  // single samples
  walk.blocks = Eigen::MatrixXd::Identity(2 * kBlocks, 2 * kBlocks);
  walk.newest = Eigen::MatrixXd::Zero(2 * kBlocks, 2);
  walk.power = Eigen::Vector2d::Constant(100.0);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      walk.blocks(i, j) = 100.0 - static_cast<double>(std::max(i, j));  // variance 100 - age
    }
    walk.newest(i, 0) = walk.blocks(0, i);
  }
  const Eigen::MatrixXd noise = 4.0 * Eigen::MatrixXd::Identity(2 * kBlocks, 2 * kBlocks);
  for (const Index known : {1, 2, 4, 8}) {
    double variance = 100.0 - static_cast<double>(known - 1), gain = 0.0;
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(known);
    for (Index i = known - 1; i >= 0; --i) {  // the scalar Kalman filter, oldest sample first
      gain = variance / (variance + 4.0);
      weights *= 1.0 - gain;
      weights[i] = gain;
      variance = (1.0 - gain) * variance + 1.0;
    }
    const Eigen::MatrixXd w = wiener(walk, noise, known);
    EXPECT_LT((w.row(0).head(known).transpose() - weights).norm(), 1e-5) << known << " samples";
  }
}

TEST(FrameTcnFilters, NoiseOnThePoseHasTheVarianceOfTheDerivativesWeights) {
  FeatureLayout layout;
  layout.dt = 0.002;
  layout.pose_deviation = Eigen::VectorXd::LinSpaced(6, 1.0, 6.0);  // alpha: 4
  const PoseNoiseMoments noise(layout);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(kChannels);
  const auto variance = [&](int derivative, double at) {
    const double w = savitzky_golay_weights(51, 3, derivative, at).norm();
    return 16.0 * std::pow(w / std::pow(0.002, derivative), 2.0);
  };
  const Eigen::MatrixXd old = noise.of(0, 0, one, one), young = noise.of(0, 1, one, one);
  EXPECT_NEAR(old(0, 0), 16.0, 1e-9);
  EXPECT_NEAR(old(8, 8), 8.0, 1e-9) << "two samples";
  EXPECT_NEAR(old(kBlocks, kBlocks) / variance(1, 25.0), 1.0, 1e-9);
  EXPECT_NEAR(old(2 * kBlocks, 2 * kBlocks) / variance(2, 25.0), 1.0, 1e-9);
  EXPECT_NEAR(young(2 * kBlocks, 2 * kBlocks) / variance(2, 0.0), 1.0, 1e-9) << "the first row";
  EXPECT_EQ(young(1, 1), 0.0) << "a block that it does not know";
}

}  // namespace
}  // namespace dcnn::frame_tcn
