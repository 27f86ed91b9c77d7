// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/sensor_frame.h"

#include <algorithm>
#include <cmath>

#include "dcnn/data/rotation.h"

namespace dcnn {

SensorFrame::SensorFrame(const FeatureLayout& layout) {
  if (layout.spec.set != FeatureSpec::Set::kPose) return;
  const std::array<const char*, 5> names{"alpha", "vx", "dalpha", "ax", "ddalpha"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto found = std::ranges::find(layout.names, names[k]);
    if (found != layout.names.end()) first_[k] = found - layout.names.begin();
  }
  if (first_[kOrientation] < 0) return;
  identity_ = false;
  mount(layout.spec.sensor_rotation_rpy);
}

void SensorFrame::mount(const Eigen::Vector3d& rpy) {
  rpy_ = rpy;
  R_SE_ = rotation_from_euler(rpy.reverse()).transpose();
}

void SensorFrame::turn(Eigen::RowVectorXd& x) const {
  if (identity_) return;
  const auto block = [&](Block b) { return x.segment<3>(first_[b]).transpose(); };
  const Eigen::Vector3d euler = block(kOrientation);
  const Eigen::Matrix3d R_SB = R_SE_ * rotation_from_euler(euler).transpose();
  if (first_[kAngularVelocity] >= 0) {
    const Eigen::Matrix3d W = euler_rate_matrix(euler);
    const Eigen::Vector3d rates = block(kAngularVelocity);
    if (first_[kAngularAcceleration] >= 0) {
      const Eigen::Vector3d alpha =
          W * block(kAngularAcceleration) + euler_rate_matrix_derivative(euler, rates) * rates;
      block(kAngularAcceleration) = R_SE_ * alpha;
    }
    block(kAngularVelocity) = R_SE_ * (W * rates);
  }
  for (const Block b : {kVelocity, kAcceleration}) {
    if (first_[b] >= 0) block(b) = (R_SB * block(b)).eval();
  }
  block(kOrientation) = R_SB.col(2);
}

Eigen::MatrixXd SensorFrame::of(Eigen::MatrixXd x) const {
  if (identity_) return x;
  Eigen::RowVectorXd row(x.cols());
  for (Index i = 0; i < x.rows(); ++i) {
    row = x.row(i);
    turn(row);
    x.row(i) = row;
  }
  return x;
}

Json SensorFrame::to_json() const {
  if (identity_) return nullptr;
  return {{"rotation_rpy", {rpy_[0], rpy_[1], rpy_[2]}}, {"blocks", first_}};
}

SensorFrame SensorFrame::parse(const Json& json, Index features, const std::string& where,
                               Exit exit) {
  SensorFrame frame;
  if (json.is_null()) return frame;
  Options options(json, where, exit);
  const auto rpy = options.get<std::vector<double>>("rotation_rpy");
  const auto blocks = options.get<std::vector<Index>>("blocks");
  options.finish();
  const bool fits = std::ranges::all_of(
      blocks, [&](Index first) { return first >= -1 && first + 3 <= features; });
  require(rpy.size() == 3 && blocks.size() == frame.first_.size() && fits && blocks[0] >= 0, exit,
          where, ": its sensor frame does not fit its features");
  std::ranges::copy(blocks, frame.first_.begin());
  frame.identity_ = false;
  frame.mount(Eigen::Vector3d(rpy[0], rpy[1], rpy[2]));
  require(frame.R_SE_.allFinite(), exit, where, ": its sensor frame is not finite");
  return frame;
}

}  // namespace dcnn
