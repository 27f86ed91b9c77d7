// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/streaming_features.h"

#include <cmath>

#include "core/elementary.h"
#include "data/feature_blocks.h"
#include "dcnn/data/rotation.h"

namespace dcnn {

StreamingFeatures::StreamingFeatures(const FeatureLayout& layout)
    : layout_(layout),
      body_(layout.spec.set == FeatureSpec::Set::kBody),
      R_SE_(rotation_from_euler(layout.spec.sensor_rotation_rpy.reverse()).transpose()) {
  const DerivativeSpec& derivative = layout.spec.derivative;
  require(layout.spec.set != FeatureSpec::Set::kAxes, Exit::kUsage,
          "features of a system of axes cannot be made from a pose; give a model of a wrist tool");
  require(
      derivative.kind == DerivativeSpec::Kind::kCausalSavitzkyGolay && layout.dt > 0.0,
      Exit::kUsage,
      "the model's derivatives are not causal (they use later samples); train it with --online");
  window_ = derivative.window(layout.dt);
  const auto weights = [&](int order) -> Eigen::VectorXd {
    return savitzky_golay_weights(static_cast<int>(window_), derivative.order, order,
                                  static_cast<double>(window_ - 1)) /
           elementary::pow(layout.dt, order);
  };
  first_weights_ = weights(1);
  second_weights_ = weights(2);
  ring_.setZero(kChannels, 2 * window_);
  for (const Block& block : used_blocks(layout, "streaming features", Exit::kUsage)) {
    blocks_.push_back(static_cast<int>(block.quantity));
  }
  x_.setZero(static_cast<Index>(3 * blocks_.size()));
}

const Eigen::VectorXd& StreamingFeatures::push(const Eigen::Vector3d& position,
                                               const Eigen::Vector3d& euler) {
  Sample sample = Sample::Zero();
  sample.head<3>() = position;
  if (body_) {
    sample.tail<4>() = quaternion_from_euler(euler);
  } else {
    sample.segment<3>(3) = euler;
  }
  return advance(sample);
}

const Eigen::VectorXd& StreamingFeatures::push(const Eigen::Vector3d& position,
                                               const Eigen::Vector4d& quaternion) {
  const Eigen::Vector4d q = quaternion.normalized();
  Sample sample = Sample::Zero();
  sample.head<3>() = position;
  if (body_) {
    sample.tail<4>() = q;
  } else {
    sample.segment<3>(3) = euler_from_rotation(rotation_from_quaternion(q));
  }
  return advance(sample);
}

const Eigen::VectorXd& StreamingFeatures::advance(Sample sample) {
  join(sample);
  last_ = sample;
  const Index times = count_ == 0 ? window_ : 1;
  for (Index k = 0; k < times; ++k) store(sample);
  ++count_;
  const auto window = ring_.middleCols(next_, window_);
  Sample first = Sample::Zero(), second = Sample::Zero();
  for (Index k = 0; k < window_; ++k) {
    first += first_weights_[k] * window.col(k);
    second += second_weights_[k] * window.col(k);
  }
  write(sample, first, second);
  return x_;
}

/// Branch of the angles, or sign of the quaternion, nearest to the sample before; the first sample
/// lies on the branch of training.
void StreamingFeatures::join(Sample& sample) const {
  if (body_) {
    if (count_ > 0 && sample.tail<4>().dot(last_.tail<4>()) < 0.0) sample.tail<4>() *= -1.0;
    return;
  }
  for (Index k = 0; k < 3; ++k) {
    const double near = count_ > 0 ? last_[3 + k] : layout_.circular_mean[k];
    sample[3 + k] = nearest_turn(sample[3 + k], near);
  }
}

void StreamingFeatures::store(const Sample& sample) {
  ring_.col(next_) = sample;
  ring_.col(next_ + window_) = sample;
  next_ = (next_ + 1) % window_;
}

void StreamingFeatures::write(const Sample& now, const Sample& first, const Sample& second) {
  Eigen::Matrix<double, 3, 5> groups;
  if (body_) {
    const Eigen::Vector4d q = now.tail<4>();
    const Eigen::Matrix3d R_SB = R_SE_ * rotation_from_quaternion(q).transpose();
    groups << R_SB.col(2), R_SB * first.head<3>(), R_SE_ * angular_rate(q, first.tail<4>()),
        R_SB * second.head<3>(), R_SE_ * angular_rate(q, second.tail<4>());
  } else {
    groups << now.segment<3>(3), first.head<3>(), first.segment<3>(3), second.head<3>(),
        second.segment<3>(3);
  }
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    x_.segment<3>(static_cast<Index>(3 * k)) = groups.col(blocks_[k]);
  }
}

}  // namespace dcnn
