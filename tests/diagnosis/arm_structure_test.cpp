// SPDX-License-Identifier: Apache-2.0
// What a given arm leaves: one body or terms of single joints, whichever is likelier.
#include "diagnosis/arm_structure.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

constexpr std::size_t kArmJoints = 6;
constexpr Index kArmPieces = 12, kRowsOfPiece = 20;

/// Rows of noise of 1, with columns of random numbers; the given torque and what a body of 1 kg
/// adds on each joint differ by a tenth of noise alone.
std::vector<JointRows> arm_noise(std::uint64_t seed) {
  Rng rng({seed});
  const auto random = [&](Index rows, Index columns) {
    return Eigen::MatrixXd(
        Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return rng.normal(); }));
  };
  std::vector<JointRows> joints;
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    JointRows rows;
    rows.arm = random(kArmPieces * kRowsOfPiece, 10 * static_cast<Index>(kArmJoints));
    rows.own = random(kArmPieces * kRowsOfPiece, kOwnFriction + kOwnAliases);
    rows.arm.col(0) = rows.own.col(kOwnFriction + 3) + 0.03 * random(kArmPieces * kRowsOfPiece, 1);
    rows.target = random(kArmPieces * kRowsOfPiece, 1);
    for (Index i = 0; i < kArmPieces * kRowsOfPiece; ++i) rows.piece.push_back(i / kRowsOfPiece);
    joints.push_back(std::move(rows));
  }
  return joints;
}

ArmStructure structure_of(const std::vector<JointRows>& joints) {
  const Index columns = joints.front().arm.cols();
  Eigen::MatrixXd body = Eigen::MatrixXd::Zero(columns, 1);
  body(0) = 1.0;
  const ArmSums sums(joints);
  return ArmStructureSearch(sums, {Eigen::MatrixXd(columns, 0), body}).run();
}

Index terms_of(const ArmStructure& structure) {
  Index sum = 0;
  for (const auto& more : structure.more) sum += static_cast<Index>(more.size());
  return sum;
}

// Each joint's scale explains it as well.
TEST(ArmStructure, OneBodyIsLikelierThanScalesOfAllJoints) {
  Index terms = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    std::vector<JointRows> joints = arm_noise(seed);
    for (JointRows& rows : joints) rows.target += rows.arm.col(0);
    const ArmStructure found = structure_of(joints);
    EXPECT_EQ(found.shared, 1U) << seed;
    terms += terms_of(found);
  }
  EXPECT_LE(terms, 1);  // of 108 that noise may hold
}

TEST(ArmStructure, TheScaleOfOneJointIsNoBody) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    std::vector<JointRows> joints = arm_noise(seed);
    joints[2].target += joints[2].arm.col(0);
    const ArmStructure found = structure_of(joints);
    EXPECT_EQ(found.shared, 0U) << seed;
    EXPECT_EQ(found.more[2], std::vector<Index>{kOwnFriction + 3}) << seed;
    EXPECT_EQ(terms_of(found), 1) << seed;
  }
}

// A spring in one joint and a body: both are found, a weak spring and a strong one.
TEST(ArmStructure, ABodyStandsBesideATermOfOneJoint) {
  for (const double size : {0.5, 5.0}) {
    std::vector<JointRows> joints = arm_noise(4);
    for (JointRows& rows : joints) rows.target += rows.arm.col(0);
    joints[4].target += size * joints[4].own.col(kOwnFriction);
    const ArmStructure found = structure_of(joints);
    EXPECT_EQ(found.shared, 1U) << size;
    EXPECT_EQ(found.more[4], std::vector<Index>{kOwnFriction}) << size;
    EXPECT_EQ(terms_of(found), 1) << size;
  }
}

// A body that is loud in a few pieces of one joint is not sure of itself, and all joints' changes
// are one statistic: that it asks for a term in another joint, which it does not move as it should,
// must not tip the scales against it.
TEST(ArmStructure, ATermThatABodyAsksForDoesNotHideIt) {
  std::vector<JointRows> joints = arm_noise(1);
  for (JointRows& rows : joints) rows.arm.col(0) *= 0.01;
  for (Index i = 0; i < kArmPieces * kRowsOfPiece; ++i) {
    const Index piece = i / kRowsOfPiece;
    const double loud = piece == 3 ? 15.0 : piece == 8 ? 1.0 : 0.1;
    joints[1].arm(i, 0) = loud * joints[1].own(i, kOwnFriction + 4);
  }
  joints[4].arm.col(0) = -0.2 * joints[4].own.col(kOwnFriction);
  for (JointRows& rows : joints) rows.target += rows.arm.col(0);
  joints[4].target -= joints[4].arm.col(0);
  EXPECT_EQ(structure_of(joints).shared, 1U);
}

// The other pieces do not tell the friction of a joint that moves in one piece alone: that does not
// hide a body on all of them.
TEST(ArmStructure, FrictionInOnePieceHidesNoBody) {
  for (const double mass : {0.0, 0.2}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      std::vector<JointRows> joints = arm_noise(seed);
      for (std::size_t j = 0; j < kArmJoints; ++j) {
        JointRows& rows = joints[j];
        rows.own.col(0).setOnes();
        for (Index i = 0; i < rows.own.rows(); ++i) {
          if (rows.piece[static_cast<std::size_t>(i)] != static_cast<Index>(j)) {
            rows.own.row(i).segment(1, kOwnFriction - 1).setZero();
          }
        }
        rows.target += mass * rows.arm.col(0) + 30.0 * rows.own.col(2);
      }
      EXPECT_EQ(structure_of(joints).shared, mass > 0.0 ? 1U : 0U) << mass << ", " << seed;
    }
  }
}

// A law of friction is wrong by a thousandth or more: what a body adds must exceed that.
TEST(ArmStructure, WithinTheErrorOfALawThereIsNoBody) {
  for (const double mass : {0.02, 0.5}) {
    std::vector<JointRows> joints = arm_noise(4);
    for (JointRows& rows : joints) {
      rows.target *= 1e-3;
      rows.target += mass * rows.arm.col(0) + 30.0 * rows.own.col(2);
    }
    EXPECT_EQ(structure_of(joints).shared, mass > 0.1 ? 1U : 0U) << mass;
  }
}

// One row in twenty is far off, as beside a rest.
TEST(ArmStructure, RowsFarOffHideNoBody) {
  for (const bool weighed : {false, true}) {
    std::vector<JointRows> joints = arm_noise(5);
    Rng rng({6});
    for (JointRows& rows : joints) {
      rows.target += 0.3 * rows.arm.col(0);
      for (Index i = 0; i < rows.target.size(); i += 20) rows.target(i) += 50.0 * rng.normal();
      if (weighed) weigh_by_tails(rows);
    }
    EXPECT_EQ(structure_of(joints).shared, weighed ? 1U : 0U);
  }
}

TEST(ArmStructure, NoiseHoldsNothing) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ArmStructure structure = structure_of(arm_noise(seed));
    found += structure.shared > 0 || terms_of(structure) > 0;
  }
  EXPECT_LE(found, 2);  // of 20, where one in 25 is a name's prior
}

/// A regression of two shared columns, told well and hardly, over `joints`.
ArmModel two_shared(const std::vector<JointRows>& joints) {
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(joints.front().arm.cols(), 2);
  shared(10, 0) = shared(11, 1) = 1.0;
  return {shared, std::vector<std::vector<Index>>(joints.size(), std::vector<Index>{0}),
          Eigen::VectorXd::Ones(static_cast<Index>(joints.size()))};
}

// Of a regression in white noise the jackknife of blocks has the covariance of least squares, which
// the estimates show over seeds.
TEST(ArmRegressionOf, DeviationsAreThoseOfTheEstimates) {
  constexpr int kSeeds = 60;
  Eigen::MatrixXd stated = Eigen::MatrixXd::Zero(2, 2), seen = stated;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    std::vector<JointRows> joints = arm_noise(static_cast<std::uint64_t>(seed));
    for (JointRows& rows : joints) rows.arm.col(11) = 0.9 * rows.arm.col(10) + rows.arm.col(12);
    const ArmSums sums(joints);
    const ArmRegression regression(sums, two_shared(joints));
    const Eigen::MatrixXd deviations = regression.deviations();
    const Eigen::VectorXd estimate = regression.shared(-1);
    stated += deviations * deviations.transpose() / kSeeds;
    seen += estimate * estimate.transpose() / kSeeds;
  }
  for (Index k = 0; k < 2; ++k) EXPECT_NEAR(stated(k, k) / seen(k, k), 1.0, 0.5) << k;
  EXPECT_LT(stated(0, 1), 0.0);
  EXPECT_LT(seen(0, 1), 0.0);
}

// Forty numbers of noise are shrunk, what the rows tell stays.
TEST(ArmRegressionOf, ShrinksWhatIsNotTold) {
  constexpr Index kShared = 40;
  for (const double size : {0.0, 2.0}) {
    double raw = 0.0, shrunk = 0.0;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      std::vector<JointRows> joints = arm_noise(seed);
      Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(joints.front().arm.cols(), kShared);
      shared.middleRows(10, kShared).setIdentity();
      for (JointRows& rows : joints) {
        rows.target += size * rows.arm.middleCols(10, kShared).rowwise().sum();
      }
      const ArmSums sums(joints);
      ArmModel model = two_shared(joints);
      model.shared = shared;
      ArmRegression regression(sums, model);
      raw += regression.shared(-1).norm();
      regression.shrink();
      shrunk += regression.shared(-1).norm();
    }
    EXPECT_LT(shrunk, (size > 0.0 ? 1.0 : 0.6) * raw) << size;
    EXPECT_GT(shrunk, (size > 0.0 ? 0.99 : 0.0) * raw) << size;
  }
}

// Parameters of its own predict a joint better where its scale is another, and not where all share
// theirs.
TEST(ArmRegressionOf, AJointOfAnotherScaleIsLikelierAlone) {
  std::vector<JointRows> joints = arm_noise(9);
  for (JointRows& rows : joints) rows.target += 2.0 * rows.arm.col(10) - rows.arm.col(11);
  joints[3].target *= 1.5;
  const ArmSums sums(joints);
  ArmRegression regression(sums, two_shared(joints));
  regression.reweight();
  EXPECT_GT(regression.log_support_alone(3), 10.0);
  EXPECT_LT(regression.log_support_alone(1), 3.0);
}

}  // namespace
}  // namespace dcnn
