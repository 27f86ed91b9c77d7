// SPDX-License-Identifier: Apache-2.0
// The hidden arms' own mechanics, against closed forms and against the recursion of the physics
// room.
#include "conceal/arm_engine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/conceal/arm.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/physics/chain.h"
#include "support/process.h"

namespace dcnn {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kFine = 1e-4;  // s, between rows
const Vector3d kDown{0.0, 0.0, -9.81};

TEST(ArmEngine, OneLimbIsAPendulum) {
  conceal::Limb limb;  // turns about a horizontal axis
  limb.turned << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  limb.masses = conceal::solid(2.0, {0.3, 0.0, 0.0}, {0.05, 0.06, 0.07}, Matrix3d::Identity());
  MatrixXd q(2001, 1);
  const auto angle = [](double t) { return 0.8 * std::sin(3.0 * t); };
  for (Index i = 0; i < q.rows(); ++i) q(i, 0) = angle(kFine * static_cast<double>(i));
  const MatrixXd torque = conceal::drive_torques({limb}, q, kFine, kDown);
  // About z: m (rx² + ry² + c²), and gravity on the centre at c cos(q) from the axis.
  const double inertia = 2.0 * (0.05 * 0.05 + 0.06 * 0.06 + 0.09);
  for (const Index i : {500, 1000, 1500}) {
    const double t = kFine * static_cast<double>(i), a = -9.0 * angle(t);
    EXPECT_NEAR(torque(i, 0), inertia * a + 2.0 * 9.81 * 0.3 * std::cos(angle(t)), 1e-6);
  }
}

TEST(ArmEngine, AgreesWithTheRecursionOfNewtonAndEulerWithWhichItSharesNothing) {
  Rng rng({11u});
  std::vector<conceal::Limb> limbs;
  JointChain chain;
  for (int k = 0; k < 4; ++k) {
    conceal::Limb limb;
    limb.origin = 0.3 * Vector3d(rng.normal(), rng.normal(), rng.normal());
    limb.turned = Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal())
                      .normalized()
                      .toRotationMatrix();
    limb.masses = conceal::solid(1.0 + rng.uniform(),
                                 0.1 * Vector3d(rng.normal(), rng.normal(), rng.normal()),
                                 {0.05, 0.08, 0.03}, limb.turned.transpose());
    BodyVector body = BodyVector::Zero();
    for (const conceal::PointMass& m : limb.masses) {
      const Matrix3d I =
          m.mass * (m.at.squaredNorm() * Matrix3d::Identity() - m.at * m.at.transpose());
      BodyVector point;
      point << m.mass, m.mass * m.at, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2);
      body += point;
    }
    ChainJoint joint;
    joint.R = limb.turned;
    joint.p = limb.origin;
    joint.body = body;
    limbs.push_back(limb);
    chain.joints.push_back(joint);
  }
  MatrixXd q(1001, 4), v(1001, 4), a(1001, 4);
  for (Index j = 0; j < 4; ++j) {
    const double w = 2.0 + static_cast<double>(j), p = rng.uniform(0.0, 6.0);
    for (Index i = 0; i < q.rows(); ++i) {
      const double s = w * kFine * static_cast<double>(i) + p;
      q(i, j) = std::sin(s), v(i, j) = w * std::cos(s), a(i, j) = -w * w * std::sin(s);
    }
  }
  const MatrixXd torque = conceal::drive_torques(limbs, q, kFine, chain.gravity);
  for (std::size_t j = 0; j < 4; ++j) {
    const VectorXd recursion = chain_regressor(chain, q, v, a, j) * *chain.bodies();
    const VectorXd error = torque.col(static_cast<Index>(j)) - recursion;
    EXPECT_LT(error.segment(1, 999).cwiseAbs().maxCoeff(), 1e-5) << j;
  }
}

TEST(ArmEngine, TheSameSeedSealsTheSameBytesAndAnotherOthers) {
  test::TemporaryFolder folder;
  const auto sealed = [&](const std::string& name, std::uint64_t seed) {
    return conceal::conceal_arms({"single:1/coulomb_friction/3"}, seed, folder / name,
                                 folder / (name + ".json"), [](int, int) {});
  };
  const std::string first = sealed("a", 1);
  EXPECT_EQ(first, sealed("b", 1));
  EXPECT_NE(first, sealed("c", 2));
  EXPECT_THROW(conceal::conceal_arms({"single:1/mass/0"}, 1, folder / "d", folder / "d.json",
                                     [](int, int) {}),
               Error);
}

/// Joints share the names of their effects: each finding is held against the one on its joint.
TEST(ArmEngine, FindingsAreScoredByJoint) {
  const auto effect = [](const char* joint) {
    return Json{{"effect", "coulomb_friction"},
                {"axis", joint},
                {"interval_s", nullptr},
                {"amplitude", 1.0},
                {"parameters", Json::object()},
                {"listed", true},
                {"foreign", false},
                {"alternatives", Json::array()}};
  };
  Json answer{{"id", "s0001"}, {"drawn", "x"}, {"group", "loaded"},
              {"motion", ""},  {"noise", ""},  {"oracle_rmse", nullptr}};
  answer["hidden"] = {effect("joint1"), effect("joint2"), effect("joint3")};
  Json report{{"verdict", "explained"}};
  report["findings"] = {effect("joint3"), effect("joint1"), effect("joint4")};
  const Json scores = conceal::score(answer, report)["effects"];
  EXPECT_TRUE(scores[0]["axis_right"].get<bool>());
  EXPECT_FALSE(scores[1]["axis_right"].get<bool>());
  EXPECT_TRUE(scores[2]["axis_right"].get<bool>());
}

TEST(ArmEngine, EachOfSevenJointsCountsInUnitsOfItsOwnLaw) {
  Json answer{{"id", "s0001"}, {"drawn", "x"}, {"group", "null"}, {"motion", ""}, {"noise", ""}};
  answer["hidden"] = Json::array();
  answer["oracle_rmse"] = std::vector<double>{1.0, 2.0, 4.0, 1.0, 2.0, 4.0, 8.0};
  Json report{{"verdict", "consistent"}, {"findings", Json::array()}};
  report["fit"]["holdout_rmse_after"] = std::vector<double>{2.0, 4.0, 8.0, 2.0, 4.0, 8.0, 16.0};
  const Json holdout = conceal::score(answer, report)["holdout"];
  EXPECT_DOUBLE_EQ(holdout["after"].get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(holdout["oracle"].get<double>(), 1.0);
}

TEST(ArmEngine, APlanHasEveryGroup) {
  const auto ids = conceal::arm_plan(24, 5);
  for (const std::string group : {"null:", "single:", "payload:", "loaded:"}) {
    EXPECT_TRUE(std::any_of(ids.begin(), ids.end(), [&](const auto& id) {
      return id.starts_with(group);
    })) << group;
  }
}

}  // namespace
}  // namespace dcnn
