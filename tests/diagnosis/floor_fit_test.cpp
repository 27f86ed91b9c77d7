// SPDX-License-Identifier: Apache-2.0
// The shape of a floor, from the density of its quiet band.
#include "diagnosis/floor_fit.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

constexpr double kSampleSeconds = 0.001;
constexpr int kWindows = 20;

/// Of noise with this floor, a mean over so many windows of exponential variables, 20 to 490 Hz.
QuietBand band_of(const Floor& floor, std::uint64_t seed) {
  Rng rng({seed});
  QuietBand band;
  band.windows = kWindows;
  band.hz = Eigen::VectorXd::LinSpaced(471, 20.0, 490.0);
  band.density = band.hz.unaryExpr([&](double hz) {
    double sum = 0.0;
    for (int k = 0; k < kWindows; ++k) sum -= std::log(1.0 - rng.uniform());
    return floor.density(hz) * sum / kWindows;
  });
  return band;
}

Floor filtered(double level) {
  return {.filtered = level, .filter_hz = 130.0, .dt = kSampleSeconds};
}

TEST(FloorFit, FindsAFilter) {
  const QuietBand band = band_of(filtered(0.03), 1);
  const Floor floor = fit_floor(band.density, band.hz, kSampleSeconds, kWindows, false,
                                [](const Floor&) { return false; });
  for (const double hz : {30.0, 100.0, 200.0, 400.0}) {
    EXPECT_NEAR(floor.density(hz) / filtered(0.03).density(hz), 1.0, 0.2)
        << hz;  // 10 % of a deviation
  }
}

TEST(FloorFit, AColourThatChanceRefutedIsThatOfAnotherChannel) {
  const Floor flat{.white = 0.01, .dt = kSampleSeconds};
  const std::vector<QuietBand> bands{band_of(filtered(0.03), 1), band_of(filtered(0.02), 2),
                                     band_of(flat, 3)};
  // The second was left white, at the mean of its band; the third is.
  std::vector<Floor> floors{filtered(0.03), flat, flat};
  floors[1].white = bands[1].density.mean();
  floors[1].lines = 1e-4;
  EXPECT_TRUE(share_colours(bands, floors));
  EXPECT_NEAR(floors[1].filtered, 0.02, 0.001);
  EXPECT_EQ(floors[1].filter_hz, 130.0);
  EXPECT_EQ(floors[1].white, 0.0);
  EXPECT_EQ(floors[1].lines, 1e-4);
  EXPECT_EQ(floors[2].filtered, 0.0);
  EXPECT_EQ(floors[0].filtered, 0.03);
  EXPECT_FALSE(share_colours(bands, floors));
}

}  // namespace
}  // namespace dcnn
