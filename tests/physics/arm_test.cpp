#include "dcnn/physics/chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

constexpr double kL1 = 0.4, kL2 = 0.3, kG = 9.81;  // m, m, m/s²

/// Two links in a vertical plane: the first joint's axis is horizontal.
JointChain planar(bool modified) {
  const Json dh = modified ? Json{{0.0, 0.0, 0.0, 0.0}, {kL1, 0.0, 0.0, 0.0}}
                           : Json{{kL1, 0.0, 0.0, 0.0}, {kL2, 0.0, 0.0, 0.0}};
  return parse_chain({{"convention", modified ? "modified" : "standard"},
                      {"dh", dh},
                      {"gravity_mps2", {0.0, -kG, 0.0}}},
                     "test", Exit::kData);
}

struct Link {
  double m, c, izz;  // kg; m of the centre of mass from the joint; kg·m² about the joint
};

/// Inertial parameters in the link's frame, whose origin is its joint.
Eigen::VectorXd parameters(const Link& link) {
  Eigen::VectorXd p = Eigen::VectorXd::Zero(10);
  p(0) = link.m;
  p(1) = link.m * link.c;
  p(9) = link.izz;
  return p;
}

/// Spong, Hutchinson and Vidyasagar, the two-link elbow arm.
Eigen::Vector2d closed_form(const Link& a, const Link& b, const Eigen::Vector2d& q,
                            const Eigen::Vector2d& v, const Eigen::Vector2d& dd) {
  const double h = b.m * kL1 * b.c, c2 = std::cos(q(1)), s2 = std::sin(q(1));
  const double m11 = a.izz + b.m * kL1 * kL1 + b.izz + 2 * h * c2, m12 = b.izz + h * c2;
  const double g2 = b.m * b.c * kG * std::cos(q(0) + q(1));
  const double g1 = (a.m * a.c + b.m * kL1) * kG * std::cos(q(0)) + g2;
  return {m11 * dd(0) + m12 * dd(1) - h * s2 * (2 * v(0) * v(1) + v(1) * v(1)) + g1,
          m12 * dd(0) + b.izz * dd(1) + h * s2 * v(0) * v(0) + g2};
}

TEST(Arm, IsTheTwoLinkArmOfTheTextbook) {
  const Link a{2.0, 0.15, 0.07}, b{1.2, 0.11, 0.03};
  Rng rng({3u});
  const auto draw = [&] { return Eigen::Vector2d(rng.normal(), rng.normal()); };
  for (const bool modified : {true, false}) {
    Eigen::VectorXd p(20);
    p << parameters(a), parameters(b);
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Vector2d q = draw(), v = draw(), dd = draw(), expected = closed_form(a, b, q, v, dd);
      for (std::size_t joint = 0; joint < 2; ++joint) {
        const Eigen::MatrixXd row =
            chain_regressor(planar(modified), q.transpose(), v.transpose(), dd.transpose(), joint);
        EXPECT_NEAR((row * p)(0), expected(static_cast<Eigen::Index>(joint)), 1e-12);
      }
    }
  }
}

/// Power of the drives is the change of energy: any arm, both conventions, all parameters.
TEST(Arm, DrivesOnlyPutInWhatTheEnergyGains) {
  for (const char* convention : {"modified", "standard"}) {
    const JointChain arm = parse_chain({{"convention", convention},
                               {"dh",
                                {{0.1, 0.4, 0.3, 0.2}, {0.2, -1.1, 0.15, -0.3}, {0.05, 1.3, 0.1, 1.0}}}},
                              "test", Exit::kData);
    Eigen::VectorXd p(30);
    Rng rng({4u});
    for (double& x : p) x = rng.normal();
    // A closed path with an even number of samples: the work over a period is zero.
    constexpr int kSamples = 400;
    double work = 0.0, size = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      const double s = 2.0 * std::acos(-1.0) * k / kSamples;
      Eigen::RowVector3d q, v, a;
      for (int j = 0; j < 3; ++j) {
        q(j) = 0.8 * std::sin(s * (j + 1) + j);
        v(j) = 0.8 * (j + 1) * std::cos(s * (j + 1) + j);
        a(j) = -0.8 * (j + 1) * (j + 1) * std::sin(s * (j + 1) + j);
      }
      for (std::size_t j = 0; j < 3; ++j) {
        const double power =
            (chain_regressor(arm, q, v, a, j) * p)(0) * v(static_cast<Eigen::Index>(j));
        work += power;
        size += std::abs(power);
      }
    }
    EXPECT_LT(std::abs(work), 1e-9 * size) << convention;
  }
}

TEST(Arm, FindsTheColumnsThatSpanTheOthers) {
  Eigen::MatrixXd x = Eigen::MatrixXd::Random(50, 5);
  x.col(3) = 2.0 * x.col(0) - x.col(1);
  x.col(4).setZero();
  EXPECT_EQ(independent_columns(x, 1e-6).size(), 3U);
}

}  // namespace
}  // namespace dcnn
