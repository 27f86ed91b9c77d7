// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/pose_noise.h"

#include <cmath>

#include "data/feature_blocks.h"
#include "dcnn/core/random.h"
#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void set_columns(Recording& recording, const std::vector<std::string>& names,
                 const MatrixXd& values) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    recording.set(names[k], values.col(static_cast<Index>(k)));
  }
}

MatrixXd quaternions_from_euler(const MatrixXd& euler) {
  MatrixXd q(euler.rows(), 4);
  for (Index i = 0; i < euler.rows(); ++i) {
    q.row(i) = quaternion_from_euler(euler.row(i).transpose());
  }
  return q;
}

}  // namespace

VectorXd pose_deviation(const std::vector<Recording>& recordings) {
  Index rows = 0;
  VectorXd sum = VectorXd::Zero(6);
  std::vector<MatrixXd> poses;
  const Eigen::Vector3d branch = circular_mean(recordings);
  for (const Recording& recording : recordings) {
    MatrixXd pose = MatrixXd::Zero(recording.samples(), 6);
    if (recording.has_all(kPosition)) pose.leftCols<3>() = recording.block(kPosition);
    pose.rightCols<3>() = aligned_euler(recording, branch);
    sum += pose.colwise().sum().transpose();
    rows += pose.rows();
    poses.push_back(std::move(pose));
  }
  const VectorXd mean = sum / static_cast<double>(rows);
  VectorXd squares = VectorXd::Zero(6);
  for (const MatrixXd& pose : poses) {
    squares += (pose.rowwise() - mean.transpose()).array().square().colwise().sum().matrix();
  }
  return (squares / static_cast<double>(std::max<Index>(1, rows - 1))).array().sqrt();
}

MatrixXd pose_draw(const Recording& recording, const FeatureLayout& layout, std::uint64_t key) {
  require(
      layout.spec.set != FeatureSpec::Set::kAxes, Exit::kUsage,
      "noise on the pose needs a pose, and a system of axes has none; use noise on the features");
  require(layout.pose_deviation.size() == 6, Exit::kModel,
          "the model file does not say how far the pose moved in training, so noise on it has no "
          "power; train again or use noise on the features");
  MatrixXd draw(recording.samples(), 6);
  for (Index i = 0; i < draw.rows(); ++i) {
    Rng rng({key, static_cast<std::uint64_t>(i)});
    for (Index k = 0; k < 6; ++k) draw(i, k) = layout.pose_deviation[k] * rng.normal();
  }
  return draw;
}

MatrixXd pose_noise(const Recording& recording, const FeatureLayout& layout, std::uint64_t key) {
  require(layout.spec.set == FeatureSpec::Set::kPose, Exit::kUsage,
          "noise on the pose is a sum of draws for the feature set 'pose' alone; use that set, or "
          "noise on the features");
  const MatrixXd draw = pose_draw(recording, layout, key);
  Derivatives rates;
  if (recording.dt > 0.0) rates = differentiate(draw, recording, layout.spec.derivative);
  const auto blocks = used_blocks(layout, recording.name, Exit::kData);
  MatrixXd noise = MatrixXd::Zero(draw.rows(), static_cast<Index>(3 * blocks.size()));
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    auto columns = noise.middleCols<3>(static_cast<Index>(3 * k));
    if (is_logged(blocks[k], recording)) continue;
    switch (blocks[k].quantity) {
      case Quantity::kOrientation:
        columns = draw.rightCols<3>();
        break;
      case Quantity::kVelocity:
        columns = rates.first.leftCols<3>();
        break;
      case Quantity::kAngularVelocity:
        columns = rates.first.rightCols<3>();
        break;
      case Quantity::kAcceleration:
        columns = rates.second.leftCols<3>();
        break;
      default:
        columns = rates.second.rightCols<3>();
    }
  }
  return noise;
}

Recording with_pose_noise(Recording recording, const FeatureLayout& layout, double scale,
                          std::uint64_t key) {
  const MatrixXd noise = scale * pose_draw(recording, layout, key);
  if (recording.has_all(kPosition)) {
    set_columns(recording, kPosition, recording.block(kPosition) + noise.leftCols<3>());
  }
  const MatrixXd euler = euler_angles(recording) + noise.rightCols<3>();
  if (recording.has_all(kQuaternion)) {
    set_columns(recording, kQuaternion, quaternions_from_euler(euler));
  } else {
    set_columns(recording, kEuler, euler);
  }
  return recording;
}

}  // namespace dcnn
