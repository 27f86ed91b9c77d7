// SPDX-License-Identifier: Apache-2.0
// Noise that channels share: its estimate against simulation, and the whitening beside it.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "diagnosis/whitener.h"

namespace dcnn {
namespace {

constexpr double kSharedStep = 0.002;
constexpr Index kSharedRows = 8000;

Case recording_of(Index channels) {
  Case study;
  for (Index j = 0; j < channels; ++j) study.channels.push_back(static_cast<int>(j));
  study.motion_hz = 20.0;
  Log log;
  log.motion.dt = kSharedStep;
  log.motion.t = Eigen::VectorXd::LinSpaced(kSharedRows, 0.0, kSharedStep * (kSharedRows - 1));
  log.motion.segments = {{0, kSharedRows}};
  log.motion.R_BS.resize(kSharedRows);
  log.measured = Eigen::MatrixXd::Zero(kSharedRows, channels);
  study.logs.push_back(std::move(log));
  return study;
}

Eigen::Matrix3d shared() {
  Eigen::Matrix3d R;
  R << 1.0, 0.8, 0.0, 0.8, 1.0, -0.5, 0.0, -0.5, 1.0;
  return R;
}

/// White noise of unit variance and this correlation.
Eigen::MatrixXd correlated_noise(const Eigen::MatrixXd& correlation, Rng& rng) {
  Eigen::MatrixXd x(kSharedRows, correlation.cols());
  for (double& e : x.reshaped()) e = rng.normal();
  return x * Eigen::MatrixXd(correlation.llt().matrixL()).transpose();
}

TEST(NoiseCorrelation, IsThatOfTheNoiseWhateverItsBurstsAndOutliersAre) {
  const Case study = recording_of(3);
  Rng rng({3});
  Eigen::MatrixXd x = correlated_noise(shared(), rng);
  for (Index i = 0; i < kSharedRows; i += 200) x(i, i % 3) *= 30.0;
  x.middleRows(1000, 1500) *= 4.0;
  // Something slow that no model explains is no noise.
  for (Index i = 0; i < kSharedRows; ++i) x.row(i).array() += 20.0 * std::sin(0.002 * double(i));
  const Eigen::MatrixXd R = noise_correlation(study, {x}, {Eigen::MatrixXd::Ones(kSharedRows, 3)});
  EXPECT_LT((R - shared()).cwiseAbs().maxCoeff(), 0.06) << R;
  EXPECT_EQ(R(2, 0), 0.0);  // no more than chance
}

TEST(NoiseCorrelation, OfIndependentChannelsIsNone) {
  const Case study = recording_of(6);
  Rng rng({4});
  int others = 0;
  for (int k = 0; k < 100; ++k) {
    const Eigen::MatrixXd R =
        noise_correlation(study, {correlated_noise(Eigen::MatrixXd::Identity(6, 6), rng)},
                          {Eigen::MatrixXd::Ones(kSharedRows, 6)});
    if (!R.isIdentity(0.0)) ++others;
  }
  EXPECT_LE(others, 2);  // 1,500 pairs, of which chance exceeds the bound in one of 16,000
}

class SharedNoise : public ::testing::Test {
 protected:
  SharedNoise() : study_(recording_of(3)) {
    for (int j = 0; j < 3; ++j) {
      Floor floor;
      floor.white = 0.01 * (j + 1);
      floor.dt = kSharedStep;
      floors_.push_back(floor);
    }
  }
  Signals ones() const { return {Eigen::MatrixXd::Ones(kSharedRows, 3)}; }
  Eigen::MatrixXd noise(Rng& rng) const {
    Eigen::MatrixXd x = correlated_noise(shared(), rng);
    for (Index j = 0; j < 3; ++j) x.col(j) *= std::sqrt(floors_[std::size_t(j)].white);
    return x;
  }
  Case study_;
  std::vector<Floor> floors_;
};

TEST_F(SharedNoise, IsWhitenedAcrossChannels) {
  const Whitener whitener(study_, floors_, ones(), shared());
  Rng rng({5});
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  constexpr int kTimes = 40;
  for (int k = 0; k < kTimes; ++k) {
    const Eigen::VectorXd rows = whitener({noise(rng)});
    const auto by_channel = rows.reshaped(rows.size() / 3, 3);
    covariance += by_channel.transpose() * by_channel / double(by_channel.rows() * kTimes);
  }
  EXPECT_LT((covariance - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.04) << covariance;
}

TEST_F(SharedNoise, HasTheTransposeOfItsMap) {
  const Whitener whitener(study_, floors_, ones(), shared());
  Rng rng({6});
  const Eigen::MatrixXd signal = noise(rng);
  Eigen::VectorXd rows(whitener.rows());
  for (double& e : rows) e = rng.normal();
  const double there = whitener({signal}).dot(rows),
               back = signal.cwiseProduct(whitener.transposed(rows, {kSharedRows})[0]).sum();
  EXPECT_NEAR(there, back, 1e-9 * std::abs(there));
}

// Twice the likelihood's logarithm differs by that of the correlation's determinant a block.
TEST_F(SharedNoise, CountsInTheLikelihood) {
  const Whitener with(study_, floors_, ones(), shared()), without(study_, floors_, ones());
  const double blocks = double(with.rows() / 3);
  EXPECT_NEAR(with.log_determinant() - without.log_determinant(),
              blocks * std::log(shared().determinant()), 1e-6 * blocks);
}

}  // namespace
}  // namespace dcnn
