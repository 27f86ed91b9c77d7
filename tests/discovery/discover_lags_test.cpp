// SPDX-License-Identifier: Apache-2.0
// Laws with a memory, and the parts that a law loses.
#include <gtest/gtest.h>

#include "discovery/dictionary.h"
#include "discovery/mutate.h"
#include "discovery/support.h"

namespace dcnn::discovery {
namespace {

constexpr double kBlockNoise = 0.01;  // N, deviation of a block's noise

TEST(Discover, LiquidWhoseWeightTurnsLate) {
  // 0.3 N of the weight follow with 0.7 s; the rest turns with the tool.
  const auto lagged = [](const Scene& at) {
    MatrixXd s(at.motion.samples(), 3);
    for (Index k = 0; k < s.rows(); ++k) {
      const Eigen::RowVector3d g = -0.3 * at.motion.R_BS[static_cast<std::size_t>(k)].row(2);
      s.row(k) = k == 0 ? g : s.row(k - 1) + (1.0 - std::exp(-0.02 / 0.7)) * (g - s.row(k - 1));
    }
    return s;
  };
  const Scene at = scene(3, 2000), other = scene(77, 2000);
  const auto laws =
      discover(problem_of(at, lagged(at) + white(2000, kBlockNoise, 20), kBlockNoise));
  ASSERT_FALSE(laws.empty());
  const MatrixXd error = prediction(other, laws) - lagged(other);
  EXPECT_LE(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.32 * kBlockNoise)
      << law::expression(laws[0].law);
  EXPECT_NE(law::expression(laws[0].law).find("lag(base_z"), std::string::npos)
      << law::expression(laws[0].law);
}

TEST(Discover, ForceBehindALag) {
  // A polymer pad: 4 % of the load follows with 0.8 s.
  const auto lagged = [](const Scene& at) {
    MatrixXd s = at.load;
    for (Index k = 1; k < s.rows(); ++k) {
      s.row(k) = s.row(k - 1) + (1.0 - std::exp(-0.02 / 0.8)) *
                                    (0.5 * (at.load.row(k) + at.load.row(k - 1)) - s.row(k - 1));
    }
    return MatrixXd(0.02 * s);
  };
  const Scene at = scene(3, 2000), other = scene(77, 2000);
  const auto laws =
      discover(problem_of(at, lagged(at) + white(2000, kBlockNoise, 14), kBlockNoise));
  ASSERT_FALSE(laws.empty());
  const MatrixXd error = prediction(other, laws) - lagged(other);
  EXPECT_LE(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.32 * kBlockNoise);
  EXPECT_NE(law::expression(laws[0].law).find("lag(load"), std::string::npos);
}

TEST(Discover, LiquidThatSwings) {
  // 40 g on a spring of 0.9 Hz along the base's x, damping ratio 0.12, by semi-implicit Euler
  // steps of 0.1 ms: another integrator than the law's.
  const auto swung = [](const Scene& at) {
    MatrixXd force = MatrixXd::Zero(at.motion.samples(), 3);
    const double w = 2.0 * M_PI * 0.9;
    double s = 0.0, rate = 0.0;
    for (Index k = 1; k < force.rows(); ++k) {
      for (int i = 0; i < 200; ++i) {
        const double part = i / 200.0;
        const double a = (1.0 - part) * at.motion.a_B(k - 1, 0) + part * at.motion.a_B(k, 0);
        rate += 1e-4 * (w * w * (a - s) - 2.0 * 0.12 * w * rate);
        s += 1e-4 * rate;
      }
      const Eigen::Vector3d e = at.motion.R_BS[static_cast<std::size_t>(k)].row(0);
      force.row(k) = -0.04 * s * e.transpose();
    }
    return force;
  };
  const Scene at = scene(3, 2000), other = scene(77, 2000);
  const auto laws = discover(problem_of(at, swung(at) + white(2000, kBlockNoise, 20), kBlockNoise));
  ASSERT_EQ(laws.size(), 1U);
  EXPECT_TRUE(laws[0].established);
  const MatrixXd error = prediction(other, laws) - swung(other);
  EXPECT_LE(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.32 * kBlockNoise)
      << law::expression(laws[0].law);
  EXPECT_NE(law::expression(laws[0].law).find("second_order(a_base_x"), std::string::npos)
      << law::expression(laws[0].law);
}

// "Stronger by 10^6 % where the speed is near 0" is "where the speed is near 0": one number fewer.
TEST(Discover, DragThatMotionBreaksDownAndRestRebuilds) {
  const auto gel = [](const Scene& at) {
    MatrixXd force(at.motion.samples(), 3);
    double built = 1.0 / (1.0 + 4.0 * std::abs(at.motion.v_B(0, 1)) / 0.03);
    for (Index k = 0; k < force.rows(); ++k) {
      const double v = at.motion.v_B(k, 1), before = at.motion.v_B(std::max<Index>(0, k - 1), 1);
      for (int part = 0; part < 100; ++part) {  // Euler's steps of 0.2 ms
        const double speed = std::abs(before + 0.01 * part * (v - before));
        built += 0.01 * at.motion.dt * ((1.0 - built) / 4.0 - speed * built / 0.03);
      }
      force.row(k) =
          -0.4 * v * (1.0 + 5.0 * built) * at.motion.R_BS[static_cast<std::size_t>(k)].row(1);
    }
    return force;
  };
  const double sigma = 0.01;
  const Scene at = scene(3, 2500), other = scene(77, 2500);
  const auto laws = discover(problem_of(at, gel(at) + white(2500, sigma, 41), sigma));
  ASSERT_FALSE(laws.empty());
  EXPECT_NE(law::expression(laws[0].law).find("thixotropic"), std::string::npos)
      << law::expression(laws[0].law);
  const MatrixXd error = prediction(other, laws) - gel(other);
  EXPECT_LE(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.32 * sigma)
      << law::expression(laws[0].law);
}

TEST(Discover, ATetherThatIsTautBeyondItsLength) {
  const Scene at = scene(3, 2000);
  const Eigen::Vector3d hook =
      at.motion.p_B.colwise().mean().transpose() + Eigen::Vector3d(-0.1, 0.06, 0.12);
  double shortest = 1.0, longest = 0.0;
  for (Index k = 0; k < 2000; ++k) {
    const double r = (hook - at.motion.p_B.row(k).transpose()).norm();
    shortest = std::min(shortest, r), longest = std::max(longest, r);
  }
  const double length = 0.5 * (shortest + longest);
  const Truth tether = [&](const Motion& m, const MatrixXd&, Index k) {
    const Eigen::Vector3d d = hook - m.p_B.row(k).transpose();
    return Eigen::Vector3d(m.R_BS[static_cast<std::size_t>(k)].transpose() * d.normalized() *
                           (5.0 * std::max(0.0, d.norm() - length)));
  };
  const auto laws = discover(problem_of(at, force_of(at, tether) + white(2000, 0.01, 42), 0.01));
  ASSERT_FALSE(laws.empty());
  EXPECT_NE(law::expression(laws[0].law).find("from_point("), std::string::npos)
      << law::expression(laws[0].law);
  const Scene other = scene(77, 2000);
  const MatrixXd error = prediction(other, laws) - force_of(other, tether);
  EXPECT_LE(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.0032);
}

TEST(Discover, AModulatorOfWhichOnlyOneIsNoPartLosesIt) {
  static const Scene at = scene(3, 500);
  const Problem problem = problem_of(at, white(500, kBlockNoise, 4), kBlockNoise);
  const Data data(problem);
  for (const auto& [shape, coordinate] :
       {std::pair{"falling", "v_base_x"}, {"affine", "gamma"}, {"wavy", "alpha"}}) {
    const std::size_t c = coordinate_named(coordinate);
    const Piece from = centred(piece(shape, c, 0.5 * data.half_range(c), 1e4), data.middle(c));
    const VectorXd whole = data.product({from}, Sketch{});
    double least = 1.0;  // of the form that differs least, as a share
    for (const Piece& other : other_shapes(data, from)) {
      EXPECT_NE(other.factor.shape, from.factor.shape);
      const VectorXd x = data.product({other}, Sketch{});
      const VectorXd left = whole - x * (x.dot(whole) / x.squaredNorm());
      least = std::min(least, left.norm() / whole.norm());
    }
    EXPECT_LT(least, 1e-3) << shape;
    Piece slight = from;
    slight.extra = 0.3;
    EXPECT_LT(other_shapes(data, slight).size(), other_shapes(data, from).size());
  }
}

// As a whole law it keeps its force, where that was -0.1 mN stronger by 10^6 %.
TEST(Discover, APlainerLawPushesAsTheOneWithANeedlessConstant) {
  static const Scene at = scene(3, 500);
  const Problem problem = problem_of(at, white(500, kBlockNoise, 4), kBlockNoise);
  const Data data(problem);
  Sketch law;
  law.direction = direction_named("base_x");
  law.amplitude = -1e-4;
  const std::size_t c = coordinate_named("gamma");
  law.pieces = {linear_in(data, coordinate_named("v_base_x")),
                centred(piece("affine", c, data.half_range(c), 1e4), data.middle(c))};
  const VectorXd whole = law.amplitude * data.column(law);
  double least = 1.0;
  for (const Sketch& other : plainer(data, law)) {
    EXPECT_LE(free_numbers(other), free_numbers(law));
    const VectorXd left = whole - other.amplitude * data.column(other);
    least = std::min(least, left.norm() / whole.norm());
  }
  EXPECT_LT(least, 1e-3);
}

}  // namespace
}  // namespace dcnn::discovery
