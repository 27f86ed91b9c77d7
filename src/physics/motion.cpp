// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

constexpr double kPi = std::numbers::pi;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// M_k·x_k for each row of x (T,3).
MatrixXd turn(const std::vector<Eigen::Matrix3d>& matrices, const MatrixXd& x) {
  MatrixXd out(x.rows(), 3);
  for (Index k = 0; k < x.rows(); ++k) {
    out.row(k) = (matrices[static_cast<std::size_t>(k)] * x.row(k).transpose()).transpose();
  }
  return out;
}

std::vector<Eigen::Matrix3d> mounted(std::vector<Eigen::Matrix3d> R_BE, const ToolModel& model) {
  const Eigen::Matrix3d R_ES = model.R_ES();
  for (auto& R : R_BE) R = R * R_ES;
  return R_BE;
}

/// (T,3): 2·vec(conj(q)·dq), the rates in E that belong to quaternion derivatives; with dq the
/// first derivative the angular velocity, with the second the angular acceleration.
MatrixXd body_rates(const MatrixXd& q, const MatrixXd& dq) {
  MatrixXd rates(q.rows(), 3);
  for (Index k = 0; k < q.rows(); ++k) {
    const Eigen::Quaterniond a(q(k, 0), q(k, 1), q(k, 2), q(k, 3));
    const Eigen::Quaterniond b(dq(k, 0), dq(k, 1), dq(k, 2), dq(k, 3));
    rates.row(k) = 2.0 * (a.conjugate() * b).vec().transpose();
  }
  return rates;
}

void read_translation(const Recording& recording, const DerivativeSpec& spec, Motion& motion) {
  motion.v_B = motion.a_B = motion.p_B = MatrixXd(0, 3);
  const std::vector<std::string> v{"vx", "vy", "vz"}, a{"ax", "ay", "az"}, p{"x", "y", "z"};
  if (recording.has_all(p)) motion.p_B = recording.block(p);
  if (recording.has_all(p) && !(recording.has_all(v) && recording.has_all(a))) {
    const auto derived = differentiate(recording.block(p), recording, spec);
    motion.v_B = derived.first;
    motion.a_B = derived.second;
    motion.is_fast |= derived.is_fast;
  }
  if (recording.has_all(v)) {
    motion.v_B = turn(motion.R_BS, recording.block(v));
    if (motion.a_B.rows() == 0 && !recording.has_all(a)) {
      motion.a_B = differentiate(motion.v_B, recording, spec).first;
    }
  }
  if (recording.has_all(a)) motion.a_B = turn(motion.R_BS, recording.block(a));
}

/// Orientation without the noise that a smoothing estimator takes off its derivatives; `q` (T,4) is
/// smoothed already.
void smooth_orientation(const MatrixXd& q, const Recording& recording, const ToolModel& model,
                        const DerivativeSpec& spec, Motion& motion) {
  for (Index k = 0; k < q.rows(); ++k) {
    motion.R_BS[static_cast<std::size_t>(k)] = rotation_from_quaternion(q.row(k)) * model.R_ES();
  }
  motion.euler = differentiate(motion.euler, recording, spec).value;
}

void read_rotation(const Recording& recording, const ToolModel& model, const DerivativeSpec& spec,
                   Motion& motion) {
  const std::vector<std::string> w{"wx", "wy", "wz"}, dw{"dwx", "dwy", "dwz"};
  const bool smoothed = spec.kind == DerivativeSpec::Kind::kSpectral;
  if (smoothed || !recording.has_all(w)) {
    const auto derived = differentiate(quaternions(recording), recording, spec);
    const MatrixXd q = derived.value.rowwise().normalized();
    if (smoothed) smooth_orientation(q, recording, model, spec, motion);
    motion.is_fast |= derived.is_fast;
    motion.w_S = body_rates(q, derived.first) * model.R_ES();
    motion.dw_S = body_rates(q, derived.second) * model.R_ES();
  }
  if (recording.has_all(w)) {
    motion.w_S = recording.block(w);
    if (!recording.has_all(dw)) motion.dw_S = differentiate(motion.w_S, recording, spec).first;
  }
  if (recording.has_all(dw)) motion.dw_S = recording.block(dw);
}

void stand_still(Motion& motion, Index samples) {
  motion.v_B = motion.a_B = motion.w_S = motion.dw_S = MatrixXd::Zero(samples, 3);
}

}  // namespace

Eigen::VectorXd times_of(const Recording& recording) {
  if (recording.has("t")) return recording.column("t");
  return Eigen::VectorXd::LinSpaced(recording.samples(), 0.0,
                                    static_cast<double>(recording.samples() - 1));
}

MatrixXd continuous_euler(const Recording& recording) {
  MatrixXd euler = euler_angles(recording);
  const std::vector<std::string> names{"alpha", "beta", "gamma"};
  const bool logged = recording.has_all(names) && !recording.has("qw");
  for (Index i = 0; i < 3 && euler.rows() > 0; ++i) {
    const bool jumps =
        euler.col(i).cwiseAbs().maxCoeff() > kPi &&
        !(logged &&
          recording.column(names[static_cast<std::size_t>(i)]).cwiseAbs().maxCoeff() > kPi);
    if (jumps) euler.col(i).array() -= 2.0 * kPi * std::floor(euler.col(i).mean() / (2.0 * kPi));
  }
  return euler;
}

Motion motion_of(const Recording& recording, const ToolModel& model,
                 const DerivativeSpec& derivative) {
  Motion motion;
  motion.recording = recording.name;
  motion.dt = recording.dt;
  motion.segments = recording.segments;
  motion.R_BS = mounted(rotations(recording), model);
  motion.euler = continuous_euler(recording);
  if (recording.has("temperature")) motion.temperature = recording.column("temperature");
  if (motion.is_static()) {
    motion.has_clock = recording.has("t");
    motion.t = times_of(recording);
    stand_still(motion, recording.samples());
  } else {
    motion.t = recording.column("t");
    read_rotation(recording, model, derivative, motion);
    read_translation(recording, derivative, motion);
  }
  return motion;
}

Motion motion_of(const Trajectory& trajectory, const ToolModel& model) {
  const Index samples = trajectory.t.size();
  Motion motion;
  motion.t = trajectory.t;
  motion.dt = trajectory.dt;
  motion.segments = {{0, samples}};
  motion.v_B = trajectory.velocity;
  motion.a_B = trajectory.acceleration;
  motion.p_B = trajectory.position;
  motion.euler.resize(samples, 3);
  motion.w_S.resize(samples, 3);
  motion.dw_S.resize(samples, 3);
  const Eigen::Matrix3d R_SE = model.R_ES().transpose();
  for (Index k = 0; k < samples; ++k) {
    const Vector3d euler = trajectory.euler.row(k), rate = trajectory.euler_rate.row(k);
    const Vector3d acceleration = trajectory.euler_acceleration.row(k);
    const Eigen::Matrix3d W = euler_rate_matrix(euler);
    const Vector3d w = W * rate;
    const Vector3d dw = W * acceleration + euler_rate_matrix_derivative(euler, rate) * rate;
    const Eigen::Matrix3d R_BE = rotation_from_euler(euler);
    motion.R_BS.push_back(R_BE * R_SE.transpose());
    motion.euler.row(k) = euler_from_rotation(R_BE).transpose();
    motion.w_S.row(k) = (R_SE * w).transpose();
    motion.dw_S.row(k) = (R_SE * dw).transpose();
  }
  unwrap(motion.euler);
  return motion;
}

}  // namespace dcnn
