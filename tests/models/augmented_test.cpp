// SPDX-License-Identifier: Apache-2.0
#include "models/augmented.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dcnn {
namespace {

Samples waves(Index rows) {
  Samples samples;
  samples.x.resize(rows, 2);
  for (Index i = 0; i < rows; ++i) {
    samples.x.row(i) << std::sin(0.01 * double(i)), 5.0 + 3.0 * std::cos(0.02 * double(i));
  }
  samples.y = samples.x.col(0);
  samples.segments = {{0, rows / 2}, {rows / 2, rows}};
  return samples;
}

NoiseSpec noise(const Json& levels) {
  return parse_noise(Options({{"levels_db", levels}}, "test", Exit::kUsage));
}

TEST(Augmented, CleanTrainingIsTheSamplesThemselves) {
  const Samples samples = waves(100);
  const InputMap map(samples.x, {});
  EXPECT_EQ(augmented(samples, noise({nullptr}), map, 1).x, samples.x);
}

TEST(Augmented, EveryLevelHasItsShareWithItsPower) {
  const Samples samples = waves(20000);
  const InputMap map(samples.x, {});
  const Samples result = augmented(samples, noise({nullptr, 60, 20}), map, 1);
  EXPECT_EQ(result.y, samples.y);
  ASSERT_EQ(result.segments.size(), 2u);
  const Eigen::ArrayXXd error =
      (result.x - samples.x).array().rowwise() / map.deviation().transpose().array();
  Index clean = 0, weak = 0, strong = 0;
  double strong_power = 0.0;
  for (Index i = 0; i < samples.rows(); ++i) {
    const double size = error.row(i).abs().maxCoeff();
    if (size == 0.0) ++clean;
    // The levels are 40 dB apart: a row between them would take a draw of five deviations.
    else if (size < 0.005)
      ++weak;
    else
      ++strong, strong_power += error.row(i).square().mean();
  }
  EXPECT_NEAR(double(clean), 20000 / 3.0, 1.0);
  EXPECT_NEAR(double(weak), 20000 / 3.0, 10.0);
  EXPECT_NEAR(strong_power / double(strong), 0.01, 0.0005);
}

TEST(Augmented, NoStridePrefersALevel) {
  const Samples samples = waves(20000);
  const InputMap map(samples.x, {});
  const Samples result = augmented(samples, noise({nullptr, 40, 30, 20, 10}), map, 1);
  for (const Index stride : {2, 5, 8}) {
    Index clean = 0, seen = 0;
    for (Index i = 0; i < samples.rows(); i += stride, ++seen) {
      clean += result.x.row(i) == samples.x.row(i) ? 1 : 0;
    }
    EXPECT_NEAR(double(clean) / double(seen), 0.2, 0.03) << "every " << stride << "th row";
  }
}

TEST(Augmented, DependsOnTheSeedAlone) {
  const Samples samples = waves(500);
  const InputMap map(samples.x, {});
  const NoiseSpec spec = noise({nullptr, 20});
  EXPECT_EQ(augmented(samples, spec, map, 1).x, augmented(samples, spec, map, 1).x);
  EXPECT_NE(augmented(samples, spec, map, 1).x, augmented(samples, spec, map, 2).x);
}

TEST(Augmented, NoiseOnThePoseKeepsItsOwnDraws) {
  Samples samples = waves(100);
  samples.pose_noise.assign(3, Eigen::MatrixXd::Ones(100, 2));
  const InputMap map(samples.x, {});
  NoiseSpec spec = noise({20});
  spec.on = NoiseSpec::Signal::kPose;
  const Samples result = augmented(samples, spec, map, 1);
  EXPECT_TRUE((result.x - samples.x).isApproxToConstant(0.1, 1e-12));
}

}  // namespace
}  // namespace dcnn
