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

/// The probability that poses of a tool of 1 kg, its centre at `lever`, in m, with 0.1 m described,
/// have torques in another unit than N·m, of which one is `unit` in the log.
double probability_of_unit(double lever, double unit) {
  Table table{{"t", "alpha", "beta", "gamma", "fx", "fy", "fz", "tx", "ty", "tz"},
              Eigen::MatrixXd(60, 10)};
  std::mt19937 random(5);
  std::normal_distribution<double> noise;
  const auto noisy = [&](const Eigen::Vector3d& v, double size) {
    return Eigen::Vector3d(v + size * Eigen::Vector3d(noise(random), noise(random), noise(random)));
  };
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    const auto k = static_cast<double>(i);
    const Eigen::Vector3d angles(1.2 * std::sin(0.9 * k), std::sin(1.7 * k + 1.0),
                                 1.5 * std::cos(k));
    const Eigen::Vector3d weight =
        rotation_from_euler(angles).transpose() * Eigen::Vector3d(0.0, 0.0, -9.81);
    const Eigen::Vector3d torque = Eigen::Vector3d(0.0, 0.0, lever).cross(weight);
    table.values.row(i) << 2.0 * k, angles.transpose(), noisy(weight, 0.02).transpose(),
        unit * noisy(torque, 0.002).transpose();
  }
  check::Declared declared;
  declared.model = ToolModel();
  declared.model->mass = 1.0;
  declared.model->com = {0.0, 0.0, 0.1};
  const check::Report report =
      check::check(check::make_log("poses.csv", std::move(table), declared));
  for (const check::Fault& fault : report.faults) {
    if (fault.id == "torque_unit") return fault.probability;
  }
  return 0.0;
}

// A controller that takes the weight off the force and not off the torque, or another tool.
TEST(PosesOfATool, ALeverThatIsLongIsNotCertainlyAUnit) {
  EXPECT_LT(probability_of_unit(0.55, 1.0), check::kCertain);
  EXPECT_GE(probability_of_unit(0.1, 1e3), check::kCertain);
  EXPECT_LT(probability_of_unit(0.1, 1.0), check::kLikely);
}

}  // namespace
}  // namespace dcnn
