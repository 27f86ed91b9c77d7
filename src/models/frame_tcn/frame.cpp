// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/frame.h"

#include <cmath>

#include "dcnn/data/rotation.h"

namespace dcnn::frame_tcn {
namespace {

Eigen::Matrix3d columns(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c = Eigen::Vector3d::Zero()) {
  Eigen::Matrix3d m;
  m << a, b, c;
  return m;
}

}  // namespace

Frame::Frame(const Instant& x, const Eigen::Matrix3d& mounting)
    : rate_(x.segment<3>(6)), acceleration_(x.segment<3>(12)) {
  const double sb = std::sin(x[1]), cb = std::cos(x[1]), sg = std::sin(x[2]), cg = std::cos(x[2]);
  const Eigen::Matrix3d M = mounting.transpose();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  to_sensor = M * rotation_from_euler(x.head<3>()).transpose();
  W_ = M * columns({-sb, cb * sg, cb * cg}, {0, cg, -sg}, {1, 0, 0});
  W_b_ = M * columns({-cb, -sb * sg, -sb * cg}, zero);
  W_g_ = M * columns({0, cb * cg, -cb * sg}, {0, -sg, -cg});
  W_bb_ = M * columns({sb, -cb * sg, -cb * cg}, zero);
  W_bg_ = M * columns({0, -sb * cg, sb * sg}, zero);
  W_gg_ = M * columns({0, -cb * sg, -cb * cg}, {0, -cg, sg});
  omega = W_ * rate_;
  alpha = W_ * acceleration_ + (W_b_ * rate_[1] + W_g_ * rate_[2]) * rate_;
  velocity = to_sensor * x.segment<3>(3);
}

void Frame::pull_back_turn(const Eigen::Vector3d& turned, const Eigen::Vector3d& d_turned,
                           Instant& gradient) const {
  for (int i = 0; i < 3; ++i) gradient[i] += d_turned.dot(turned.cross(W_.col(i)));
}

void Frame::pull_back(const Eigen::Vector3d& d_omega, const Eigen::Vector3d& d_alpha,
                      const Eigen::Vector3d& d_velocity, Instant& gradient) const {
  gradient.segment<3>(3) += to_sensor.transpose() * d_velocity;
  pull_back_turn(velocity, d_velocity, gradient);
  const Eigen::Matrix3d turning = W_b_ * rate_[1] + W_g_ * rate_[2];  // dW/dt
  gradient.segment<3>(12) += W_.transpose() * d_alpha;
  gradient.segment<3>(6) += W_.transpose() * d_omega + turning.transpose() * d_alpha;
  gradient[7] += d_alpha.dot(W_b_ * rate_);
  gradient[8] += d_alpha.dot(W_g_ * rate_);
  const Eigen::Vector3d by_beta =
      W_b_ * acceleration_ + (W_bb_ * rate_[1] + W_bg_ * rate_[2]) * rate_;
  const Eigen::Vector3d by_gamma =
      W_g_ * acceleration_ + (W_bg_ * rate_[1] + W_gg_ * rate_[2]) * rate_;
  gradient[1] += d_omega.dot(W_b_ * rate_) + d_alpha.dot(by_beta);
  gradient[2] += d_omega.dot(W_g_ * rate_) + d_alpha.dot(by_gamma);
}

}  // namespace dcnn::frame_tcn
