// SPDX-License-Identifier: Apache-2.0
// Numbers at a bound of their range, against the integral over what is left of the likelihood.
#include "diagnosis/evidence/bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "dcnn/physics/effect.h"

namespace dcnn::evidence {
namespace {

/// Dry friction whose v0 stands at `v0` of 0.001 to 0.1 m/s; the recordings would move it by
/// `wanted` deviations of its own.
JointFit friction_at(double v0, double wanted) {
  const EffectKind& kind = *find_effect("coulomb_friction");
  Member member;
  member.kind = &kind;
  member.form = &kind.fits[0];
  member.axis = "base_x";
  member.amplitudes = Eigen::VectorXd::Ones(1);
  member.shapes = Eigen::VectorXd::Constant(1, v0);
  member.least_shapes = Eigen::VectorXd::Constant(1, 0.001);
  member.most_shapes = Eigen::VectorXd::Constant(1, 0.1);
  Rng rng({4});
  JointFit fit;
  fit.members = {member};
  fit.tangent.resize(50, 2);
  for (double& x : fit.tangent.reshaped()) x = rng.normal();
  const Eigen::VectorXd shape = fit.tangent.col(1);
  fit.residual = wanted / shape.norm() / shape.norm() * shape;
  return fit;
}

// A shape of one sign vanishes at its least, one of either sign points as far as it can.
TEST(Bounds, OfASignedShapeAreBothItsEnds) {
  Member member = friction_at(0.1, 0.0).members[0];
  EXPECT_TRUE(is_at_bound(member, 0));
  EXPECT_TRUE(is_degenerate(member));
  member.shapes(0) = 0.001;
  EXPECT_FALSE(is_at_bound(member, 0));
  member.least_shapes(0) = -0.1;
  EXPECT_FALSE(is_at_bound(member, 0));
  member.shapes(0) = -0.1;
  EXPECT_TRUE(is_at_bound(member, 0));
  EXPECT_TRUE(is_degenerate(member));
}

TEST(Bounds, HoldWhatWouldPassThem) {
  for (const double wanted : {0.3, 2.0, 8.0, 60.0}) {
    const JointFit fit = friction_at(0.1, wanted);
    Eigen::VectorXd precision = Eigen::VectorXd::Zero(2);
    const double got = hold_at_bounds(fit, precision);
    EXPECT_EQ(precision(0), 0.0);
    EXPECT_GT(precision(1), 1e6 * fit.tangent.col(1).squaredNorm());
    // exp of the change of -|r - T d|^2/2 from d = 0 down.
    constexpr double kStep = 1e-5;
    const double slope = fit.tangent.col(1).dot(fit.residual),
                 curvature = fit.tangent.col(1).squaredNorm();
    double sum = 0.0;
    for (double d = 0.5 * kStep; d < 4.0; d += kStep) {
      sum += kStep * std::exp(-slope * d - 0.5 * curvature * d * d);
    }
    EXPECT_NEAR(got, std::log(sum), 0.1) << wanted;
  }
}

TEST(Bounds, HoldNothingWithinThemNorWhatTurnsBack) {
  for (const auto& [v0, wanted] : {std::pair{0.05, 8.0}, {0.1, -8.0}, {0.001, 8.0}}) {
    Eigen::VectorXd precision = Eigen::VectorXd::Zero(2);
    EXPECT_EQ(hold_at_bounds(friction_at(v0, wanted), precision), 0.0) << v0;
    EXPECT_EQ(precision.norm(), 0.0) << v0;
  }
}

}  // namespace
}  // namespace dcnn::evidence
