// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/filter.h"

#include <gtest/gtest.h>

#include <numbers>

#include "data/sample_recording.h"
#include "data/testing.h"

namespace dcnn {
namespace {

Eigen::VectorXd tone(const Recording& recording, double hz) {
  return (2.0 * std::numbers::pi * hz * recording.column("t").array()).sin();
}

/// Gain of the filter on a tone, away from the ends.
double gain(double hz, double cutoff) {
  const Recording recording = testing::sine_recording(4000);
  const Eigen::VectorXd x = tone(recording, hz), y = low_pass(x, recording, cutoff);
  const auto middle = [](const Eigen::VectorXd& v) { return v.segment(1000, 2000); };
  return middle(x).dot(middle(y)) / middle(x).squaredNorm();
}

// The tone's own frequency after the bilinear transform: |H|^2 = 1/(1 + (tan(pi f dt)/tan(pi fc
// dt))^8).
TEST(LowPass, HasTheSquaredButterworthGainWithoutPhase) {
  for (const double hz : {5.0, 20.0, 30.0, 40.0}) {
    const double ratio =
        std::tan(std::numbers::pi * hz * 0.002) / std::tan(std::numbers::pi * 30 * 0.002);
    EXPECT_NEAR(gain(hz, 30.0), 1.0 / (1.0 + std::pow(ratio, 8)), 1e-6) << hz;
  }
}

TEST(LowPass, PassesConstantsAndRampsToTheVeryEnds) {
  const Recording recording = testing::sine_recording(500);
  Eigen::MatrixXd x(500, 2);
  x.col(0).setConstant(7.5);
  x.col(1) = recording.column("t");
  EXPECT_LT((low_pass(x, recording, 20.0) - x).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(LowPass, KeepsSegmentsApart) {
  Recording recording = testing::sine_recording(1000);
  recording.segments = {{0, 400}, {400, 1000}};
  Eigen::MatrixXd x = tone(recording, 3.0);
  const Eigen::MatrixXd before = low_pass(x, recording, 10.0);
  x.topRows(400).array() += 100.0;
  const Eigen::MatrixXd after = low_pass(x, recording, 10.0);
  EXPECT_EQ(before.bottomRows(600), after.bottomRows(600));
}

TEST(LowPass, RejectsACutoffAboveHalfTheRate) {
  const Recording recording = testing::sine_recording(100);
  const auto message =
      testing::error_of([&] { low_pass(recording.table.values, recording, 250.0); }, Exit::kData);
  EXPECT_TRUE(testing::contains(message, "lowpass_hz")) << message;
}

}  // namespace
}  // namespace dcnn
