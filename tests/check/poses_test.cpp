// SPDX-License-Identifier: Apache-2.0
// Poses that are those of something else.
#include <gtest/gtest.h>

#include "check/moving_tool.h"

namespace dcnn {
namespace {

using namespace moving_tool;

// The base in the tool's frame: its position is turned as well, and seems to hold no acceleration.
TEST(InvertedPoses, AnInvertedPoseHasItsPositionInMetres) {
  Table table = moving_tool::log();
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    auto row = table.values.row(i);
    const Eigen::Matrix3d R = rotation_from_euler(row.segment<3>(kAlpha).transpose());
    row.segment<3>(kX) = -(R.transpose() * row.segment<3>(kX).transpose()).transpose();
    row.segment<3>(kAlpha) = euler_from_rotation(R.transpose()).transpose();
  }
  const check::Report report = moving_tool::report_of(std::move(table));
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].id, "inverse_pose") << check::to_text(report);
  EXPECT_GE(report.faults[0].probability, check::kCertain);
  for (const check::Fault& fault : report.faults) {
    EXPECT_FALSE(fault.id != "inverse_pose" && fault.probability >= check::kLikely) << fault.words;
  }
}

}  // namespace
}  // namespace dcnn
