// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/elementary.h"
#include "data/feature_blocks.h"
#include "data/rows.h"
#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr double kSmallestCosine = 0.05;  // of beta; rows below are invalid, but stay finite

const std::vector<std::string> kV = {"vx", "vy", "vz"}, kOmega = {"wx", "wy", "wz"};
const std::vector<std::string> kA = {"ax", "ay", "az"}, kAlpha = {"dwx", "dwy", "dwz"};

const std::vector<std::string>& rate_columns(Quantity quantity) {
  switch (quantity) {
    case Quantity::kVelocity:
      return kV;
    case Quantity::kAngularVelocity:
      return kOmega;
    case Quantity::kAcceleration:
      return kA;
    default:
      return kAlpha;
  }
}

/// W with a cosine that keeps it regular.
Matrix3d regular_rate_matrix(Vector3d euler) {
  if (std::abs(elementary::cos(euler[1])) < kSmallestCosine) {
    const double limit = elementary::acos(kSmallestCosine);
    const double sign = elementary::cos(euler[1]) < 0.0 ? -1.0 : 1.0;
    euler[1] = elementary::atan2(std::copysign(elementary::sin(limit), elementary::sin(euler[1])),
                                 sign * kSmallestCosine);
  }
  return euler_rate_matrix(euler);
}

/// All motion of one recording in the frame and the coordinates of the feature set; what is not
/// available is empty.
struct Motion {
  MatrixXd orientation, velocity, angular_velocity, acceleration, angular_acceleration;

  const MatrixXd& of(Quantity quantity) const {
    switch (quantity) {
      case Quantity::kVelocity:
        return velocity;
      case Quantity::kAngularVelocity:
        return angular_velocity;
      case Quantity::kAcceleration:
        return acceleration;
      case Quantity::kAngularAcceleration:
        return angular_acceleration;
      default:
        return orientation;
    }
  }
};

/// Which rates the rows need but the log does not hold.
bool needs(const std::vector<Block>& blocks, const Recording& recording, Quantity a, Quantity b) {
  for (const Block& block : blocks) {
    const bool asked = block.quantity == a || block.quantity == b;
    if (asked && !recording.has_all(rate_columns(block.quantity))) return true;
  }
  return false;
}

/// Multiplies every row of several matrices by its own 3x3 matrix, which costs more than the
/// products.
template <class MatrixOf>
void turn_rows(const std::vector<MatrixXd*>& all, const MatrixOf& matrix_of) {
  for_each_row(all.front()->rows(), [&](Index i) {
    const Matrix3d R = matrix_of(i);
    for (MatrixXd* rows : all) {
      const Vector3d v((*rows)(i, 0), (*rows)(i, 1), (*rows)(i, 2));
      for (Index k = 0; k < 3; ++k) {
        (*rows)(i, k) = R(k, 0) * v[0] + R(k, 1) * v[1] + R(k, 2) * v[2];
      }
    }
  });
}

/// The paper's set: Euler angles and their rates, linear rates in B.
Motion pose_motion(const Recording& recording, const FeatureLayout& layout,
                   const std::vector<Block>& blocks) {
  Motion motion;
  motion.orientation = aligned_euler(recording, layout.circular_mean);
  const MatrixXd& euler = motion.orientation;
  const auto& derivative = layout.spec.derivative;
  const auto euler_of = [&](Index i) -> Vector3d { return euler.row(i).transpose(); };
  const Matrix3d R_ES = rotation_from_euler(layout.spec.sensor_rotation_rpy.reverse());
  if (needs(blocks, recording, Quantity::kVelocity, Quantity::kAcceleration)) {
    Derivatives rates = differentiate(recording.block(kPosition), recording, derivative);
    motion.velocity = std::move(rates.first);
    motion.acceleration = std::move(rates.second);
  }
  if (recording.dt > 0.0) {
    Derivatives rates = differentiate(euler, recording, derivative);
    motion.angular_velocity = std::move(rates.first);
    motion.angular_acceleration = std::move(rates.second);
  }
  const auto R_BS = [&](Index i) -> Matrix3d { return rotation_from_euler(euler_of(i)) * R_ES; };
  if (recording.has_all(kV)) turn_rows({&(motion.velocity = recording.block(kV))}, R_BS);
  if (recording.has_all(kA)) turn_rows({&(motion.acceleration = recording.block(kA))}, R_BS);
  const auto to_rates = [&](Index i) -> Matrix3d {
    return regular_rate_matrix(euler_of(i)).inverse() * R_ES;
  };
  if (recording.has_all(kOmega))
    turn_rows({&(motion.angular_velocity = recording.block(kOmega))}, to_rates);
  if (recording.has_all(kAlpha) && motion.angular_velocity.rows() > 0) {
    // alpha_E = W·accelerations + dW/dt·rates, in S as measured.
    MatrixXd alpha = recording.block(kAlpha);
    for_each_row(alpha.rows(), [&](Index i) {
      const Vector3d rates = motion.angular_velocity.row(i).transpose();
      const Vector3d turning = euler_rate_matrix_derivative(euler_of(i), rates) * rates;
      alpha.row(i) -= (R_ES.transpose() * turning).transpose();
    });
    turn_rows({&alpha}, to_rates);
    motion.angular_acceleration = alpha;
  }
  return motion;
}

/// Into the first three columns of `rate`, derivatives of q.
void to_angular_rates(const MatrixXd& q, MatrixXd& rate, const Matrix3d& R_SE) {
  for_each_row(q.rows(), [&](Index i) {
    const Eigen::Vector4d at(q(i, 0), q(i, 1), q(i, 2), q(i, 3));
    const Eigen::Vector4d turning(rate(i, 0), rate(i, 1), rate(i, 2), rate(i, 3));
    const Vector3d w = R_SE * angular_rate(at, turning);
    for (Index k = 0; k < 3; ++k) rate(i, k) = w[k];
  });
}

/// Everything in S.
Motion body_motion(const Recording& recording, const FeatureLayout& layout,
                   const std::vector<Block>& blocks) {
  Motion motion;
  const MatrixXd q = quaternions(recording);
  const Matrix3d R_SE = rotation_from_euler(layout.spec.sensor_rotation_rpy.reverse()).transpose();
  const auto R_SB = [&](Index i) -> Matrix3d {
    return R_SE * rotation_from_quaternion(q.row(i)).transpose();
  };
  motion.orientation = Vector3d::UnitZ().transpose().replicate(q.rows(), 1);
  std::vector<MatrixXd*> turned{&motion.orientation};
  if (needs(blocks, recording, Quantity::kVelocity, Quantity::kAcceleration)) {
    Derivatives rates =
        differentiate(recording.block(kPosition), recording, layout.spec.derivative);
    motion.velocity = std::move(rates.first);
    motion.acceleration = std::move(rates.second);
    turned.insert(turned.end(), {&motion.velocity, &motion.acceleration});
  }
  turn_rows(turned, R_SB);
  if (needs(blocks, recording, Quantity::kAngularVelocity, Quantity::kAngularAcceleration)) {
    Derivatives rates = differentiate(q, recording, layout.spec.derivative);
    motion.angular_velocity = std::move(rates.first);
    motion.angular_acceleration = std::move(rates.second);
    to_angular_rates(q, motion.angular_velocity, R_SE);
    to_angular_rates(q, motion.angular_acceleration, R_SE);
  }
  if (recording.has_all(kV)) motion.velocity = recording.block(kV);
  if (recording.has_all(kOmega)) motion.angular_velocity = recording.block(kOmega);
  if (recording.has_all(kA)) motion.acceleration = recording.block(kA);
  if (recording.has_all(kAlpha)) motion.angular_acceleration = recording.block(kAlpha);
  return motion;
}

}  // namespace

Vector3d angular_rate(const Eigen::Vector4d& q, const Eigen::Vector4d& rate) {
  const Vector3d v = q.tail<3>(), r = rate.tail<3>();
  return 2.0 / q.squaredNorm() * (q[0] * r - rate[0] * v - v.cross(r));
}

std::vector<Block> feature_blocks(const FeatureSpec& spec, const System& system) {
  switch (spec.set) {
    case FeatureSpec::Set::kPose:
      return {{Quantity::kOrientation, {"alpha", "beta", "gamma"}, "rad"},
              {Quantity::kVelocity, kV, "m/s"},
              {Quantity::kAngularVelocity, {"dalpha", "dbeta", "dgamma"}, "rad/s"},
              {Quantity::kAcceleration, kA, "m/s^2"},
              {Quantity::kAngularAcceleration, {"ddalpha", "ddbeta", "ddgamma"}, "rad/s^2"}};
    case FeatureSpec::Set::kBody:
      return {{Quantity::kOrientation, {"ux", "uy", "uz"}, "1"},
              {Quantity::kVelocity, kV, "m/s"},
              {Quantity::kAngularVelocity, kOmega, "rad/s"},
              {Quantity::kAcceleration, kA, "m/s^2"},
              {Quantity::kAngularAcceleration, kAlpha, "rad/s^2"}};
    default:
      return axis_blocks(system);
  }
}

bool is_logged(const Block& block, const Recording& recording) {
  return block.quantity != Quantity::kOrientation &&
         recording.has_all(rate_columns(block.quantity));
}

bool is_available(const Block& block, const Recording& recording, const System& system) {
  if (system.kind == System::Kind::kAxes) return is_axis_available(block, recording, system);
  if (block.quantity == Quantity::kOrientation || is_logged(block, recording)) return true;
  const bool linear =
      block.quantity == Quantity::kVelocity || block.quantity == Quantity::kAcceleration;
  return recording.dt > 0.0 && (!linear || recording.has_all(kPosition));
}

MatrixXd wrist_features(const Recording& recording, const FeatureLayout& layout,
                        const std::vector<Block>& blocks) {
  const bool body = layout.spec.set == FeatureSpec::Set::kBody;
  const Motion motion =
      body ? body_motion(recording, layout, blocks) : pose_motion(recording, layout, blocks);
  MatrixXd x(recording.samples(), static_cast<Index>(3 * blocks.size()));
  for_each_piece(x.cols(), [&](Index column) {
    const Block& block = blocks[static_cast<std::size_t>(column / 3)];
    x.col(column) = motion.of(block.quantity).col(column % 3);
  });
  return x;
}

}  // namespace dcnn
