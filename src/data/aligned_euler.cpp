// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/elementary.h"
#include "data/feature_blocks.h"
#include "dcnn/data/rotation.h"

namespace dcnn {

Eigen::Vector3d circular_mean(const std::vector<Recording>& recordings) {
  Eigen::RowVector3d sine = Eigen::RowVector3d::Zero(), cosine = sine;
  for (const Recording& recording : recordings) {
    const Eigen::ArrayXXd euler = euler_angles(recording).array();
    sine += elementary::sin(euler).colwise().sum().matrix();
    cosine += elementary::cos(euler).colwise().sum().matrix();
  }
  const auto angle = [](double y, double x) { return elementary::atan2(y, x); };
  return sine.binaryExpr(cosine, angle).transpose();
}

Eigen::MatrixXd aligned_euler(const Recording& recording, const Eigen::Vector3d& branch) {
  Eigen::MatrixXd euler = euler_angles(recording);
  for (const Segment& segment : recording.segments) {
    for (Index k = 0; k < 3; ++k) {
      auto angle = euler.col(k).segment(segment.begin, segment.size());
      angle.array() += nearest_turn(angle[0], branch[k]) - angle[0];
    }
  }
  return euler;
}

}  // namespace dcnn
