// SPDX-License-Identifier: Apache-2.0
// Delays of the force beside physics that acts along one axis.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "check/moving_tool.h"

namespace dcnn {
namespace {

using namespace moving_tool;

/// The probability of a delay of a force that is `rows` late, after `change`.
double delay_after(Eigen::Index rows, const std::function<void(Eigen::MatrixXd&)>& change) {
  Table table = moving_tool::log();
  change(table.values);
  const Eigen::MatrixXd force = table.values.rightCols(3);
  for (Eigen::Index i = 0; i < force.rows(); ++i) {
    table.values.row(i).tail(3) = force.row(std::max<Eigen::Index>(0, i - rows));
  }
  double most = 0.0;
  for (const check::Fault& fault : moving_tool::report_of(std::move(table)).faults) {
    if (fault.id == "delay") most = std::max(most, fault.probability);
  }
  return most;
}

/// A force along x that follows alpha's turns with a dead zone: a cable that drags.
void drag_along_x(Eigen::MatrixXd& values) {
  double drag = 0.0;
  for (Eigen::Index i = 1; i < values.rows(); ++i) {
    drag = std::clamp(drag + (values(i, kAlpha) - values(i - 1, kAlpha)) / 0.1, -1.0, 1.0);
    values(i, kFx) += 0.6 * drag;
  }
}

/// A cable that pulls along x as a spring does, and teeth that pull along y.
void pull_along_x(Eigen::MatrixXd& values) { values.col(kFx) += 1.2 * values.col(kAlpha); }
void cog_along_y(Eigen::MatrixXd& values) {
  values.col(kFy).array() += 0.5 * (11.0 * values.col(kGamma).array()).sin();
}

TEST(Delays, AreFoundBesidePhysicsOfOneAxis) {
  for (const auto& change : {drag_along_x, pull_along_x, cog_along_y}) {
    EXPECT_GE(delay_after(6, change), 0.9);
    EXPECT_LT(delay_after(0, change), check::kLikely);
  }
}

// Values of 5 rows are older by 2 in the mean; 20 ms are more than that.
TEST(Delays, AreFoundWhereForcesAreHeld) {
  const auto hold = [](Eigen::MatrixXd& values) {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      values.row(i).tail(3) = values.row(i - i % 5).tail(3).eval();
    }
  };
  EXPECT_GE(delay_after(6, hold), 0.9);
  EXPECT_LT(delay_after(0, hold), check::kLikely);
}

}  // namespace
}  // namespace dcnn
