// SPDX-License-Identifier: Apache-2.0
// The test that draws signs for blocks of a second: its power on short recordings, and its size.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "diagnosis/judgement.h"
#include "diagnosis/one_joint.h"

namespace dcnn {
namespace {

struct Flips {
  double p = 1.0, least = 1.0;
};

/// Of dry friction that is fitted to an axis with `fc` of it, in N·m, beside noise of 0.5 N·m that
/// lasts for a quarter of a second.
Flips flips_of(double seconds, double fc, std::uint64_t seed) {
  constexpr double kStep = 0.005, kKept = 0.98;  // of the noise from row to row
  Rng rng({seed});
  Table table = test::joint_table(static_cast<Index>(seconds / kStep));
  double slow = 0.5 * rng.normal();
  for (Index i = 0; i < table.values.rows(); ++i) {
    const double t = kStep * static_cast<double>(i), phase = static_cast<double>(seed);
    const double v = 2.3 * std::cos(4.6 * t + phase) + 1.2 * std::cos(9.1 * t);
    slow = kKept * slow + 0.5 * std::sqrt(1.0 - kKept * kKept) * rng.normal();
    table.values.row(i) << t, 0.5 * std::sin(4.6 * t + phase) + 0.132 * std::sin(9.1 * t),
        fc * std::tanh(v / 0.1) + slow + 0.01 * rng.normal();
  }
  Search search = test::search_of_joint({table});
  const EffectKind& dry = *find_effect("coulomb_friction");
  search.settle(
      {make_member(search.study(), dry, dry.fits[0], "base_x", Eigen::VectorXd::Constant(1, 0.1))});
  return {flip_p_value(search.setting(), search.fit(), 0), least_flip_p_value(search.setting())};
}

TEST(Flips, SevenSecondsShowALaw) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    EXPECT_LE(flips_of(7.0, 1.0, seed).p, 0.05) << "seed " << seed;
  }
}

// 60 logs without friction: more than 8 below 0.05 are less probable than 1 in 500.
TEST(Flips, NoiseRarelyPasses) {
  int passed = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) passed += flips_of(12.0, 0.0, seed).p <= 0.05;
  EXPECT_LE(passed, 8);
}

TEST(Flips, ThreeBlocksShowNothing) {
  EXPECT_GT(flips_of(2.5, 1.0, 1).least, 0.05);
  EXPECT_LE(flips_of(7.0, 1.0, 1).least, 0.05);
}

}  // namespace
}  // namespace dcnn
