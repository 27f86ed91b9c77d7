// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/reading.h"
#include "check/statistics.h"
#include "core/elementary.h"
#include "dcnn/data/derivative.h"
#include "dcnn/data/rotation.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr double kWindow = 0.12;       // s; passes what a wrist does, some 8 Hz
constexpr Index kMostCentres = 1500;   // more rows tell readings apart no better
constexpr Index kShifts = 40;          // rows kept free beside a window, for delays
constexpr double kBetweenPoses = 1.0;  // s, as readers tell lists of poses (data/clock.cpp)

/// The clock unit that makes the rate plausible: the window must be the same for all readings.
double likely_step(const Log& log) {
  double best = 1.0;
  for (const double unit : {1e-3, 1e-6, 1e-9}) {
    if (clock_weight(log, unit) > clock_weight(log, best)) best = unit;
  }
  return best * log.step;
}

/// Fewer rows than show whether neighbours are alike, nearer in time than an arm goes from one pose
/// at rest to the next: a motion too short to be differentiated, and no list of poses.
bool is_too_short(const Log& log) {
  return log.step > 0.0 && log.rows() < kFewRows && likely_step(log) < kBetweenPoses;
}

Eigen::Matrix3d turn_about(char axis, double angle) {
  const double c = elementary::cos(angle), s = elementary::sin(angle);
  Eigen::Matrix3d R;
  if (axis == 'x') R << 1, 0, 0, 0, c, -s, 0, s, c;
  if (axis == 'y') R << c, 0, s, 0, 1, 0, -s, 0, c;
  if (axis == 'z') R << c, -s, 0, s, c, 0, 0, 0, 1;
  return R;
}

Eigen::Matrix3d from_angles(const Eigen::Vector3d& angles, const Orientation& how) {
  const auto turn = [&](int k) {
    return turn_about(how.order[static_cast<std::size_t>(k)], angles[how.reversed ? 2 - k : k]);
  };
  return turn(0) * turn(1) * turn(2);
}

Eigen::Matrix3d from_quaternion(const Eigen::Vector4d& logged, const Orientation& how) {
  Eigen::Vector4d q;  // w, x, y, z
  for (int k = 0; k < 4; ++k) {
    q[static_cast<Index>(std::string("wxyz").find(how.order[static_cast<std::size_t>(k)]))] =
        logged[k];
  }
  const double norm = q.norm();
  return norm > 0.0 ? rotation_from_quaternion(q / norm)
                    : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

/// (T,4) w, x, y, z of the rotations, neighbours near one another.
Eigen::MatrixXd continuous_quaternions(const std::vector<Eigen::Matrix3d>& R) {
  Eigen::MatrixXd q(static_cast<Index>(R.size()), 4);
  for (Index i = 0; i < q.rows(); ++i) {
    const Eigen::Quaterniond turn(R[static_cast<std::size_t>(i)]);
    q.row(i) << turn.w(), turn.x(), turn.y(), turn.z();
    if (i > 0 && q.row(i).dot(q.row(i - 1)) < 0.0) q.row(i) *= -1.0;
  }
  return q;
}

/// 2 vec(conj(p) r): the rates in the body's frame, where r is a derivative of p.
Eigen::Vector3d body_rate(const Eigen::Vector4d& p, const Eigen::Vector4d& r) {
  const Eigen::Vector3d pv = p.tail<3>(), rv = r.tail<3>();
  return 2.0 * (p[0] * rv - r[0] * pv - pv.cross(rv)) / p.squaredNorm();
}

void add_rotations(const Eigen::MatrixXd& q, const Eigen::MatrixXd& dq, const Eigen::MatrixXd& ddq,
                   Kinematics& out) {
  const Index n = q.rows();
  out.w.resize(n, 3);
  out.dw.resize(n, 3);
  for (Index i = 0; i < n; ++i) {
    const Eigen::Vector4d p = q.row(i);
    out.R.push_back(rotation_from_quaternion(p.normalized()));
    out.w.row(i) = body_rate(p, dq.row(i));
    out.dw.row(i) = body_rate(p, ddq.row(i));
  }
}

/// Of one smooth kernel u: the second derivative's weights by Savitzky and Golay are its second
/// difference, the first's its central one. What is smoothed and what is differentiated pass the
/// same low-pass then, and a rigid tool leaves nothing of a tremor.
void set_weights(int window, Sampled& rows) {
  rows.second =
      savitzky_golay_weights(window, std::min(3, window - 2), 2, static_cast<double>(rows.half));
  const Index last = window - 1;
  // second_k = u_k-1 - 2u_k + u_k+1
  Eigen::VectorXd& u = rows.value = Eigen::VectorXd::Zero(window);
  u[1] = rows.second[0];
  for (Index k = 1; k + 1 < last; ++k) u[k + 1] = rows.second[k] + 2.0 * u[k] - u[k - 1];
  rows.first = Eigen::VectorXd::Zero(window);
  rows.first.head(last) -= 0.5 * u.tail(last);
  rows.first.tail(last) += 0.5 * u.head(last);
}

}  // namespace

double Sampled::seconds(Index count) const {
  return half == 0 ? 0.0 : static_cast<double>(count) * kWindow / static_cast<double>(2 * half);
}

Eigen::MatrixXd Sampled::smoothed(const Eigen::MatrixXd& signals, const Eigen::VectorXd& weights,
                                  Index shift) const {
  Eigen::MatrixXd out(static_cast<Index>(centres.size()), signals.cols());
  for (Index i = 0; i < out.rows(); ++i) {
    const Index from = centres[static_cast<std::size_t>(i)] - half + shift;
    out.row(i) = weights.transpose() * signals.middleRows(from, weights.size());
  }
  return out;
}

Sampled sample(const Log& log) {
  Sampled rows;
  const bool listed = log.step <= 0.0 || !log.smooth;
  rows.half = listed ? 0 : std::max<Index>(2, std::llround(0.5 * kWindow / likely_step(log)));
  rows.value = Eigen::VectorXd::Ones(1);
  if (!listed) set_weights(static_cast<int>(2 * rows.half + 1), rows);
  const Index free = listed ? 0 : rows.half + std::min(kShifts, log.rows() / 20);
  const Index stride = std::max<Index>({1, rows.half, log.rows() / kMostCentres});
  if (is_too_short(log)) return rows;
  for (const Segment& segment : log.segments) {
    for (Index i = segment.begin + free; i + free < segment.end; i += stride)
      rows.centres.push_back(i);
  }
  return rows;
}

double clock_weight(const Log& log, double seconds) {
  const double rate = 1.0 / (log.step * seconds);
  const double slow = elementary::log(kSlowShare) + plausibility(rate, kSlowRate);
  return std::max(plausibility(rate, kRate), slow) +
         plausibility(seconds * log.step * static_cast<double>(log.rows()), kLogDuration);
}

std::vector<Eigen::Matrix3d> orientations(const Log& log, const Reading& reading) {
  std::vector<Eigen::Matrix3d> R;
  R.reserve(static_cast<std::size_t>(log.rows()));
  const bool quaternion = log.has_quaternion();
  const Eigen::MatrixXd logged = log.block(quaternion ? kQuaternion : kEuler);
  const Eigen::Vector3d unit = reading.angle * reading.orientation.sign;
  for (Index i = 0; i < log.rows(); ++i) {
    R.push_back(quaternion ? from_quaternion(logged.row(i), reading.orientation)
                           : from_angles(logged.row(i).transpose().cwiseProduct(unit),
                                         reading.orientation));
    if (reading.orientation.inverse) R.back().transposeInPlace();
  }
  return R;
}

Eigen::MatrixXd positions_in_base(const Log& log, const Reading& reading) {
  Eigen::MatrixXd x = log.block(kPosition);
  if (!reading.orientation.inverse_position) return x;
  const auto R = orientations(log, reading);
  for (Index i = 0; i < x.rows(); ++i) {
    x.row(i) = -(R[static_cast<std::size_t>(i)] * x.row(i).transpose()).transpose();
  }
  return x;
}

Kinematics kinematics(const Log& log, const Sampled& rows, const Reading& reading) {
  Kinematics out;
  const auto n = static_cast<Index>(rows.centres.size());
  const Eigen::MatrixXd q = continuous_quaternions(orientations(log, reading));
  const Eigen::MatrixXd none4 = Eigen::MatrixXd::Zero(n, 4);
  const bool moving = rows.half > 0;
  add_rotations(rows.smoothed(q, rows.value), moving ? rows.smoothed(q, rows.first) : none4,
                moving ? rows.smoothed(q, rows.second) : none4, out);
  out.position = out.velocity = out.acceleration = Eigen::MatrixXd::Zero(n, 3);
  out.has_position = log.has_all(kPosition);
  if (!out.has_position) return out;
  const Eigen::MatrixXd x = positions_in_base(log, reading);
  out.position = rows.smoothed(x, rows.value);
  if (!moving) return out;
  out.velocity = rows.smoothed(x, rows.first);
  out.acceleration = rows.smoothed(x, rows.second);
  return out;
}

}  // namespace dcnn::check
