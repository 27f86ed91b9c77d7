// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/motion_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/parallel.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

/// 30 s at 500 Hz: equal velocities at these frequencies, and white noise.
Eigen::VectorXd position(const std::vector<double>& hz, double noise, double unit = 1.0) {
  Rng rng({7});
  Eigen::VectorXd q(15000);
  for (Index i = 0; i < q.size(); ++i) {
    const double t = 0.002 * double(i);
    q(i) = noise * rng.normal();
    for (const double f : hz) q(i) += 0.1 / f * std::sin(2.0 * std::numbers::pi * f * t + f);
    q(i) *= unit;
  }
  return q;
}

TEST(MotionBand, EndsAboveTheFastestMotion) {
  std::vector<double> hz;
  for (double f = 5.0; f < 81.0; f += 2.5) hz.push_back(f);
  const double band = motion_band({position(hz, 0.0)}, 0.002);
  EXPECT_NEAR(band, 3.0 * 0.9 * 80.0, 15.0);
  EXPECT_EQ(motion_band({position(hz, 0.0, 1000.0)}, 0.002), band);  // whatever the unit
}

// Noise of the sensor is no motion, though its velocity would be 40 times that of the motion.
TEST(MotionBand, NoiseIsNoMotion) {
  EXPECT_LT(motion_band({position({0.3, 1.1}, 1e-3)}, 0.002), 10.0);
  EXPECT_EQ(motion_band({Eigen::VectorXd::Constant(3000, 0.2)}, 0.002), 0.0);
}

}  // namespace
}  // namespace dcnn
