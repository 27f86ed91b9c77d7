// SPDX-License-Identifier: Apache-2.0
// An arm's log beside the description of its links.
#include <gtest/gtest.h>

#include "dcnn/check/check.h"
#include "dcnn/conceal/faulty.h"
#include "dcnn/core/error.h"

namespace dcnn {
namespace {

struct MadeArm {
  check::Log log;
  JointChain chain;
};

MadeArm made_arm(const std::string& kind, std::uint64_t seed) {
  const conceal::FaultyLog made = conceal::make_faulty(kind, seed);
  check::Declared declared;
  declared.system = parse_system(made.system, "system.json");
  return {check::make_log("arm.csv", made.table, declared),
          parse_chain(declared.system.arm, "system.json", Exit::kData)};
}

TEST(DescribedArms, JointsAreMatchedByTheirNamesInAnyOrder) {
  MadeArm arm = made_arm("clean_arm", 3);
  std::swap(arm.log.joints[1], arm.log.joints[2]);
  check::describe_arm(arm.log, arm.chain);
  EXPECT_EQ(arm.log.arm[1], 2U);
  EXPECT_EQ(arm.log.arm[2], 1U);
  const check::Report report = check::check(arm.log);
  EXPECT_TRUE(report.faults.empty()) << check::to_text(report);
}

// A gripper's finger, which has no torque.
TEST(DescribedArms, TheLogMayHaveMoreJointsThanTheArm) {
  MadeArm arm = made_arm("arm_sign", 3);
  check::Joint finger{"finger", arm.log.joints[0].position, "", ""};
  arm.log.joints.insert(arm.log.joints.begin(), finger);
  check::describe_arm(arm.log, arm.chain);
  EXPECT_EQ(arm.log.arm[0], 1U);
  const check::Report report = check::check(arm.log);
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "joint_sign") << check::to_text(report);
}

TEST(DescribedArms, OtherNamesCountInTheirOrder) {
  MadeArm arm = made_arm("arm_exchanged", 3);
  for (check::Joint& joint : arm.log.joints) joint.name += "_of_mine";
  check::describe_arm(arm.log, arm.chain);
  const check::Report report = check::check(arm.log);
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "joint_order") << check::to_text(report);
}

TEST(DescribedArms, WhatTheColumnsAreCountedInDoesNotMatter) {
  MadeArm arm = made_arm("arm_sign", 4);
  check::describe_arm(arm.log, arm.chain);
  const double before = check::check(arm.log).faults.at(0).probability;
  for (check::Joint& joint : arm.log.joints) {
    joint.scale = 1e-3;  // the log in mN·m, and said so
    const auto column =
        std::find(arm.log.table.columns.begin(), arm.log.table.columns.end(), joint.measured);
    arm.log.table.values.col(column - arm.log.table.columns.begin()) *= 1e3;
  }
  const check::Report report = check::check(arm.log);
  EXPECT_EQ(report.faults.at(0).id, "joint_sign") << check::to_text(report);
  EXPECT_NEAR(report.faults.at(0).probability, before, 1e-6);
}

TEST(DescribedArms, PosesAtRestTellSignsToo) {
  MadeArm arm = made_arm("arm_sign", 5);
  Table& table = arm.log.table;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index k = 0; k < 60; ++k) rows.push_back((k * 1009) % table.values.rows());
  Table poses{table.columns, table.values(rows, Eigen::all)};
  poses.columns.erase(poses.columns.begin());  // t
  poses.values = Eigen::MatrixXd(poses.values.rightCols(poses.values.cols() - 1));
  check::Declared declared = arm.log.declared;
  check::Log log = check::make_log("poses.csv", poses, declared);
  check::describe_arm(log, arm.chain);
  const check::Report report = check::check(log);
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "joint_sign") << check::to_text(report);
}

// Torques that no reading of this description explains: nothing is claimed about its joints.
TEST(DescribedArms, AnotherArmThanDescribedIsSaidAndNoJointIsBlamed) {
  MadeArm arm = made_arm("clean_arm", 6);
  for (const check::Joint& joint : arm.log.joints) {
    const auto k =
        std::find(arm.log.table.columns.begin(), arm.log.table.columns.end(), joint.measured) -
        arm.log.table.columns.begin();
    for (Eigen::Index i = 0; i < arm.log.table.values.rows(); ++i) {
      const double t = 0.004 * static_cast<double>(i);
      arm.log.table.values(i, k) += 300.0 * std::sin(7.0 * t + static_cast<double>(k));
    }
  }
  check::describe_arm(arm.log, arm.chain);
  const check::Report report = check::check(arm.log);
  ASSERT_FALSE(report.notes.empty());
  EXPECT_NE(report.notes[0].find("not the described arm's"), std::string::npos) << report.notes[0];
  for (const check::Fault& fault : report.faults) {
    EXPECT_FALSE(fault.id.starts_with("joint_") || fault.id == "torque_unit") << fault.words;
  }
}

TEST(DescribedArms, AnotherNumberOfJointsIsRefused) {
  MadeArm arm = made_arm("clean_arm", 7);
  arm.chain.joints.pop_back();
  for (check::Joint& joint : arm.log.joints) joint.name += "_of_mine";
  EXPECT_THROW(check::describe_arm(arm.log, arm.chain), Error);
}

// A joint that never moves has no rate to compare, and no probability that is no number.
TEST(DescribedArms, AJointAtRestHasNoRateThatIsWrong) {
  MadeArm arm = made_arm("clean_arm", 8);
  Table& table = arm.log.table;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    if (table.columns[k] == "q_5") table.values.col(column).setConstant(9.81e-7);
    if (table.columns[k] == "qd_5") table.values.col(column).setZero();
  }
  for (const check::Fault& fault : check::check(arm.log).faults) {
    EXPECT_NE(fault.id, "rates") << fault.words;
    EXPECT_TRUE(std::isfinite(fault.probability)) << fault.words;
  }
}

}  // namespace
}  // namespace dcnn
