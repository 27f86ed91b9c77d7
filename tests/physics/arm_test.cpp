// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "dcnn/physics/axis_machine.h"
#include "dcnn/physics/chain.h"

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
      const Eigen::Vector2d q = draw(), v = draw(), dd = draw(),
                            expected = closed_form(a, b, q, v, dd);
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
    const JointChain arm = parse_chain(
        {{"convention", convention},
         {"dh", {{0.1, 0.4, 0.3, 0.2}, {0.2, -1.1, 0.15, -0.3}, {0.05, 1.3, 0.1, 1.0}}}},
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

/// A payload at the flange is the same as that body in the last link.
TEST(Arm, APayloadIsPartOfTheLastLink) {
  Json system{{"kind", "axes"}, {"axes", Json::array()}};
  for (const char* k : {"1", "2"}) {
    system["axes"].push_back({{"name", k},
                              {"measured", std::string("tau") + k},
                              {"unit", "N*m"},
                              {"position", std::string("q") + k},
                              {"velocity", std::string("v") + k},
                              {"acceleration", std::string("a") + k}});
  }
  const Json link{{"mass_kg", 2.0},
                  {"moment_kgm", {0.2, 0.0, 0.1}},
                  {"inertia_kgm2", {0.1, 0, 0, 0.2, 0, 0.2}}};
  Json first{{"rpy_rad", {0.5, 0.0, 0.0}}, {"body", link}},
      second{{"xyz_m", {0.4, 0.0, 0.0}}, {"body", link}};
  system["arm"] = {{"joints", {first, second}},
                   {"flange", {{"xyz_m", {0.3, 0.1, 0.0}}, {"rpy_rad", {0.1, 0.2, 0.3}}}}};

  AxisMachine machine{parse_system(system, "test"), {}};
  const JointChain chain = chain_of(machine.system);
  const Eigen::VectorXd bodies = *chain.bodies();
  std::vector<Eigen::Index> all;
  for (Eigen::Index k = 0; k < 20; ++k) all.push_back(k);
  for (int k = 0; k < 2; ++k) machine.axes.push_back({all, bodies, {}, DerivativeSpec(), 1.0});
  BodyVector payload;
  payload << 1.5, 0.03, -0.06, 0.09, 0.02, 0.001, 0.0, 0.03, 0.002, 0.01;

  Rng rng({6u});
  Table table;
  table.columns = {"t", "q1", "v1", "a1", "q2", "v2", "a2", "tau1", "tau2"};
  table.values.resize(20, 9);
  for (double& x : table.values.reshaped()) x = rng.normal();
  for (Eigen::Index i = 0; i < 20; ++i) table.values(i, 0) = 0.01 * static_cast<double>(i);
  const Recording recording = make_recording({table, {}}, "log.csv", ReadOptions(), machine.system);

  machine.payload = payload;
  AxisMachine lumped = parse_axis_machine(to_json(machine), "model.json", Exit::kData);
  ASSERT_TRUE(lumped.payload.has_value());
  const Eigen::MatrixXd with = predict_axes(lumped, recording);
  lumped.payload.reset();
  for (CorrectedAxis& axis : lumped.axes)
    axis.coefficients.tail(10) += flange_to_link(chain) * payload;
  EXPECT_LT((with - predict_axes(lumped, recording)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(with.cwiseAbs().maxCoeff(), 1.0);
}

TEST(Arm, FindsTheColumnsThatSpanTheOthers) {
  Eigen::MatrixXd x = Eigen::MatrixXd::Random(50, 5);
  x.col(3) = 2.0 * x.col(0) - x.col(1);
  x.col(4).setZero();
  EXPECT_EQ(independent_columns(x, 1e-6).size(), 3U);
}

}  // namespace
}  // namespace dcnn
