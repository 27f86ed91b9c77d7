// SPDX-License-Identifier: Apache-2.0
// Laws without a short formula: tables, switches, delays, products of three.
#include <gtest/gtest.h>

#include "discovery/dictionary.h"
#include "discovery/judge.h"
#include "discovery/refine.h"
#include "discovery/support.h"

namespace dcnn::discovery {
namespace {

constexpr double kSigma = 0.01;  // N, deviation of a block's noise

/// A force in S at every sample of a scene.
using Forces = std::function<MatrixXd(const Scene&)>;

Eigen::Vector3d axis_of(const Motion& m, Index k, Index axis) {
  return m.R_BS[static_cast<std::size_t>(k)].row(axis);
}

/// Finds laws in one motion and expects their error in another to be a third of the noise at most,
/// by which the hold-out error rises by 5 %.
std::vector<Discovered> expect_predicted(const Forces& forces, std::uint64_t seed) {
  const Scene at = scene(3, 2500), other = scene(77, 2500);
  const auto laws = discover(problem_of(at, forces(at) + white(2500, kSigma, seed), kSigma));
  EXPECT_FALSE(laws.empty());
  const MatrixXd error = prediction(other, laws) - forces(other);
  std::string told;
  for (const Discovered& found : laws) told += law::expression(found.law) + "\n";
  EXPECT_LE(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.32 * kSigma)
      << told;
  return laws;
}

TEST(DiscoverCurves, ACamOfFlatsAndRampsIsATable) {
  const auto cam = [](const Scene& at) {
    MatrixXd force(at.motion.samples(), 3);
    for (Index k = 0; k < force.rows(); ++k) {
      const double u = at.motion.euler(k, 0) / 0.3;
      const double rise = std::clamp(u, 0.0, 1.0);
      force.row(k) << 0.0, 0.0,
          0.15 * (3.0 * rise * rise - 2.0 * rise * rise * rise) +
              0.1 * std::clamp(-1.0 - u, 0.0, 1.0);
    }
    return force;
  };
  const auto laws = expect_predicted(cam, 31);
  ASSERT_FALSE(laws.empty());
  EXPECT_NE(law::expression(laws[0].law).find("alpha"), std::string::npos);
}

TEST(DiscoverCurves, DragThatALatchSwitches) {
  // On above y = 8 mm, off below -8 mm.
  const auto latched = [](const Scene& at) {
    MatrixXd force(at.motion.samples(), 3);
    bool on = at.motion.p_B(0, 1) > 0.0;
    for (Index k = 0; k < force.rows(); ++k) {
      const double y = at.motion.p_B(k, 1);
      on = y > 0.008 || (on && y >= -0.008);
      force.row(k) = (on ? -2.0 * at.motion.v_B(k, 0) : 0.0) * axis_of(at.motion, k, 0);
    }
    return force;
  };
  expect_predicted(latched, 32);
}

TEST(DiscoverCurves, DragOfTheMotionAsItWas) {
  const auto delayed = [](const Scene& at) {
    MatrixXd force = MatrixXd::Zero(at.motion.samples(), 3);
    for (Index k = 0; k < force.rows(); ++k) {
      const Index before = std::max<Index>(0, k - 12);  // 0.24 s
      force.row(k) = -2.0 * at.motion.v_B(before, 2) * axis_of(at.motion, k, 2);
    }
    return force;
  };
  const auto laws = expect_predicted(delayed, 33);
  ASSERT_FALSE(laws.empty());
  EXPECT_NE(law::expression(laws[0].law).find("delay(v_base_z, 0.24"), std::string::npos)
      << law::expression(laws[0].law);
}

TEST(DiscoverCurves, ThreeFactorsOfWhichNoneShowsAlone) {
  const auto product = [](const Scene& at) {
    MatrixXd force(at.motion.samples(), 3);
    for (Index k = 0; k < force.rows(); ++k) {
      const Motion& m = at.motion;
      force.row(k) = 200.0 * m.v_B(k, 2) * m.p_B(k, 1) * m.euler(k, 1) * axis_of(m, k, 2);
    }
    return force;
  };
  const auto laws = expect_predicted(product, 34);
  ASSERT_FALSE(laws.empty());
  EXPECT_EQ(laws[0].law.structure.factors.size(), 3U);
}

TEST(DiscoverCurves, ACurveGoesOnStraightWhereLittleIsKnown) {
  const Scene at = scene(3, 2500);
  MatrixXd force(2500, 3);
  VectorXd weight = VectorXd::Constant(2500, 1.0 / kSigma);
  for (Index k = 0; k < 2500; ++k) {
    const double x = at.motion.p_B(k, 0);
    force.row(k) = 0.3 * x * axis_of(at.motion, k, 0).transpose();
    if (std::abs(x) > 0.04) weight(k) *= 0.02;
  }
  force += weight.cwiseInverse().asDiagonal() * white(2500, 1.0, 36);
  Problem problem = problem_of(at, force, kSigma);
  problem.whiten = [weight](const std::vector<MatrixXd>& f) {
    return VectorXd((weight.asDiagonal() * f[0]).reshaped());
  };
  problem.residual = problem.whiten({force});
  const Data data(problem);
  Sketch law;
  law.direction = direction_named("base_x");
  law.pieces = {as_curves(data, linear_in(data, coordinate_named("x"))).back()};
  const Sketch fitted = refined(data, law, 15).sketch;
  const Piece& curve = fitted.pieces[0];
  ASSERT_EQ(curve.values.size(), 25U);
  for (std::size_t k = 1; k + 1 < 25; ++k) {
    const double x = curve.centre + curve.scale * (static_cast<double>(k) / 12.0 - 1.0);
    if (std::abs(x) < 0.05) continue;
    const double bend = curve.values[k - 1] - 2.0 * curve.values[k] + curve.values[k + 1];
    EXPECT_LT(std::abs(fitted.amplitude * bend), 0.5 * kSigma) << k;
  }
}

TEST(DiscoverCurves, ALoopOfOneCurveForthAndAnotherBack) {
  const auto loop = [](const Scene& at) {
    MatrixXd force(at.motion.samples(), 3);
    double s = 0.0;
    for (Index k = 0; k < force.rows(); ++k) {
      const double x = at.motion.p_B(k, 0), dx = k == 0 ? 0.0 : x - at.motion.p_B(k - 1, 0);
      const double end = dx < 0.0 ? -1.0 : 1.0;
      s = end + (s - end) * std::exp(-std::abs(dx) / 2e-3);
      const double u = x / 0.02;
      const double forth = 0.10 * std::exp(-u * u), back = -0.08 + 0.05 * std::tanh(u);
      force.row(k) = -0.5 * ((1.0 + s) * forth + (1.0 - s) * back) * axis_of(at.motion, k, 0);
    }
    return force;
  };
  expect_predicted(loop, 35);
}

// Ends of a table that are reached for moments: their values follow from those beside them, in the
// folds that judge the table as in its fit.
TEST(DiscoverCurves, ATableIsJudgedByFoldsAsStiffAsItsFit) {
  Scene at = scene(3, 2500);
  for (Index k = 0; k < 2500; ++k) {
    const double t = 0.02 * static_cast<double>(k);
    at.motion.p_B(k, 2) = 0.05 * std::sin(1.9 * t) * (0.4 + 0.012 * t);
  }
  const auto felt = [](double z) { return 0.05 * std::sin(60.0 * z) + 0.5 * z; };
  MatrixXd force(2500, 3);
  for (Index k = 0; k < 2500; ++k) {
    force.row(k) = felt(at.motion.p_B(k, 2)) * axis_of(at.motion, k, 2);
  }
  const Problem problem = problem_of(at, force + white(2500, kSigma, 53), kSigma);
  const Data data(problem);
  Sketch sketch;
  sketch.direction = direction_named("base_z");
  Piece table = centred(piece("curve", coordinate_named("z"), 0.05), 0.0);
  table.factor.nodes = law::kMostNodes;
  table.factor.peak = law::kMostNodes - 1;
  for (std::size_t k = 0; k < law::kMostNodes; ++k) {
    const double u = 2.0 * static_cast<double>(k) / (law::kMostNodes - 1.0) - 1.0;
    table.values.push_back(felt(0.05 * u) / felt(0.05));
  }
  sketch.pieces = {table};
  const Discovered found = judged(data, refined(data, sketch, 10));
  EXPECT_GT(found.held_out_gain, 0.9 * found.gain);
}

}  // namespace
}  // namespace dcnn::discovery
