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
  for (const std::uint64_t seed : {1, 2, 3}) {
    std::vector<JointRows> joints = arm_noise(seed);
    for (JointRows& rows : joints) rows.target += rows.arm.col(0);
    const ArmStructure found = structure_of(joints);
    EXPECT_EQ(found.shared, 1U) << seed;
    EXPECT_EQ(terms_of(found), 0) << seed;
  }
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

TEST(ArmStructure, NoiseHoldsNothing) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ArmStructure structure = structure_of(arm_noise(seed));
    found += structure.shared > 0 || terms_of(structure) > 0;
  }
  EXPECT_LE(found, 2);  // of 20, where one in 25 is a name's prior
}

}  // namespace
}  // namespace dcnn
