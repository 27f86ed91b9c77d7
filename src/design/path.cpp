// SPDX-License-Identifier: Apache-2.0
#include "design/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/data/rotation.h"
#include "design/joints.h"

namespace dcnn::design {
namespace {

constexpr Index kDegree = 5;
const char* const kPoseNames[] = {"x", "y", "z", "alpha", "beta", "gamma"};

/// Weights of the points of a segment, `degree` + 1, at u in [0,1): w_j = (u + d - j)/d w_(j-1) +
/// (1 - u + j)/d w_j of one degree less (Cox and de Boor).
Eigen::Matrix<double, kDegree + 1, 1> spline_weights(Index degree, double u) {
  Eigen::Matrix<double, kDegree + 1, 1> w = Eigen::Matrix<double, kDegree + 1, 1>::Unit(0);
  for (Index d = 1; d <= degree; ++d) {
    const auto over = static_cast<double>(d);
    for (Index j = d; j >= 0; --j) {
      const auto at = static_cast<double>(j);
      w(j) = (1.0 - u + at) / over * w(j) + (j > 0 ? (u + over - at) / over * w(j - 1) : 0.0);
    }
  }
  return w;
}

double longest(const Eigen::MatrixXd& vectors) {
  return vectors.rows() == 0 ? 0.0 : vectors.rowwise().norm().maxCoeff();
}

/// Differences of rows over dt.
Eigen::MatrixXd rates_of(const Eigen::MatrixXd& rows, double dt) {
  const Index n = rows.rows();
  return (rows.bottomRows(n - 1) - rows.topRows(n - 1)) / dt;
}

Eigen::MatrixXd in_base(const Motion& motion, const Eigen::MatrixXd& vectors_S) {
  Eigen::MatrixXd out(vectors_S.rows(), 3);
  for (Index k = 0; k < out.rows(); ++k) {
    out.row(k) =
        (motion.R_BS[static_cast<std::size_t>(k)] * vectors_S.row(k).transpose()).transpose();
  }
  return out;
}

/// Share of a range about the start that values use: above 1 outside of it.
double share_of_range(const Range& range, double start, double low, double high) {
  const double rounding = 1e-12 * std::max(1.0, std::abs(start));  // of a coordinate that rests
  const double above = high - start, below = start - low;
  double share = 0.0;
  if (above > rounding) share = std::max(share, above / std::max(rounding, range.high - start));
  if (below > rounding) share = std::max(share, below / std::max(rounding, start - range.low));
  return share;
}

Motion arm_motion(const SplineSamples& q, const JointChain& chain, const ToolModel& model,
                  Eigen::MatrixXd& pose) {
  const Index n = q.t.size();
  Motion motion;
  const Eigen::Matrix3d R_ES = model.R_ES();
  for (auto* block : {&motion.v_B, &motion.a_B, &motion.p_B, &motion.w_S, &motion.dw_S})
    block->resize(n, 3);
  pose.resize(n, 6);
  for (Index k = 0; k < n; ++k) {
    const FlangeState s = flange_state(chain, q.value.row(k), q.first.row(k), q.second.row(k));
    motion.R_BS.push_back(s.R * R_ES);
    motion.p_B.row(k) = s.p;
    motion.v_B.row(k) = s.v;
    motion.a_B.row(k) = s.a;
    motion.w_S.row(k) = R_ES.transpose() * s.w_E;
    motion.dw_S.row(k) = R_ES.transpose() * s.dw_E;
    pose.row(k) << s.p.transpose(), euler_from_rotation(s.R).transpose();
  }
  unwrap(pose.rightCols(3));
  return motion;
}

Trajectory trajectory_of(const SplineSamples& pose, double dt) {
  Trajectory out;
  out.dt = dt;
  out.t = pose.t;
  out.position = pose.value.leftCols(3);
  out.velocity = pose.first.leftCols(3);
  out.acceleration = pose.second.leftCols(3);
  out.euler = pose.value.rightCols(3);
  out.euler_rate = pose.first.rightCols(3);
  out.euler_acceleration = pose.second.rightCols(3);
  return out;
}

}  // namespace

SplineSamples sample(const Spline& spline, double rate_hz) {
  const Index segments = spline.points.rows() - kDegree, width = spline.points.cols();
  const auto n = static_cast<Index>(std::floor(spline.seconds() * rate_hz + 1e-9)) + 1;
  Eigen::MatrixXd difference[4] = {spline.points, {}, {}, {}};
  for (int d = 1; d < 4; ++d) difference[d] = rates_of(difference[d - 1], spline.spacing);
  SplineSamples out;
  out.t.resize(n);
  Eigen::MatrixXd* const blocks[] = {&out.value, &out.first, &out.second, &out.third};
  for (auto* block : blocks) block->resize(n, width);
  for (Index i = 0; i < n; ++i) {
    out.t(i) = static_cast<double>(i) / rate_hz;
    const double place = out.t(i) / spline.spacing;
    const Index segment = std::min(static_cast<Index>(place), segments - 1);
    const double u = place - static_cast<double>(segment);
    for (Index d = 0; d < 4; ++d) {
      const Index points = kDegree + 1 - d;
      blocks[d]->row(i) = spline_weights(kDegree - d, u).head(points).transpose() *
                          difference[d].middleRows(segment, points);
    }
  }
  return out;
}

Played play(const Spline& spline, const Limits& limits, const ToolModel& model, double rate_hz,
            double start_s) {
  Played out;
  out.coordinates = sample(spline, rate_hz);
  if (limits.joints) {
    out.motion = arm_motion(out.coordinates, limits.joints->chain, model, out.pose);
  } else {
    out.pose = out.coordinates.value;
    out.motion = motion_of(trajectory_of(out.coordinates, 1.0 / rate_hz), model);
  }
  out.motion.euler = out.pose.rightCols(3);
  out.motion.t = out.coordinates.t.array() + start_s;
  out.motion.dt = 1.0 / rate_hz;
  out.motion.segments = {{0, out.coordinates.t.size()}};
  return out;
}

std::vector<Usage> usage(const Played& played, const Limits& limits) {
  std::vector<Usage> all;
  const auto add = [&](const std::string& name, double value, double most, bool turning = false) {
    if (std::isfinite(most)) all.push_back({name, value / most, turning});
  };
  const Motion& m = played.motion;
  const PoseLimits& pose = limits.pose;
  const auto add_range = [&](const std::string& name, const Range& range, const Eigen::VectorXd& x,
                             bool turning) {
    if (!std::isfinite(range.high - range.low)) return;
    all.push_back({name, share_of_range(range, x(0), x.minCoeff(), x.maxCoeff()), turning});
  };
  for (Index k = 0; k < 6; ++k) {
    add_range(std::string("range of ") + kPoseNames[k], pose.range[static_cast<std::size_t>(k)],
              played.pose.col(k), k > 2);
  }
  add("speed_mps", longest(m.v_B), pose.speed);
  add("acceleration_mps2", longest(m.a_B), pose.acceleration);
  add("jerk_mps3", longest(rates_of(m.a_B, m.dt)), pose.jerk);
  add("rate_radps", longest(m.w_S), pose.rate, true);
  add("acceleration_radps2", longest(m.dw_S), pose.angular_acceleration, true);
  add("jerk_radps3", longest(rates_of(in_base(m, m.dw_S), m.dt)), pose.angular_jerk, true);
  const Eigen::VectorXd radius =
      (played.pose.leftCols(3).rowwise() - pose.center.transpose()).rowwise().norm();
  add("work_space", radius.maxCoeff(), pose.radius.high);
  if (pose.radius.low > 0.0)
    add("inner work_space", pose.radius.low, std::max(1e-300, radius.minCoeff()));
  if (!limits.joints) return all;
  const JointLimits& joints = *limits.joints;
  const SplineSamples& q = played.coordinates;
  for (Index k = 0; k < q.value.cols(); ++k) {
    const std::string name = " of joint " + std::to_string(k + 1);
    add_range("range" + name, joints.range[static_cast<std::size_t>(k)], q.value.col(k), false);
    add("speed" + name, q.first.col(k).cwiseAbs().maxCoeff(), joints.speed(k));
    add("acceleration" + name, q.second.col(k).cwiseAbs().maxCoeff(), joints.acceleration(k));
    add("jerk" + name, q.third.col(k).cwiseAbs().maxCoeff(), joints.jerk(k));
  }
  return all;
}

Spline within(Spline spline, const Limits& limits, double rate_hz) {
  // A maximum between two samples of what swings with the spacing of the points exceeds theirs by
  // this share at most.
  const double swing = std::numbers::pi / (rate_hz * spline.spacing),
               most = 1.0 / (1.0 + 0.25 * swing * swing);
  const auto shrink = [&](Index first, Index count, double factor) {
    auto block = spline.points.middleCols(first, count);
    const Eigen::RowVectorXd start = limits.start.segment(first, count).transpose();
    block = ((block.rowwise() - start) * factor).rowwise() + start;
  };
  constexpr int kSteps = 60;
  for (int step = 0; step < kSteps; ++step) {
    double moving = 0.0, turning = 0.0;
    for (const Usage& one : usage(play(spline, limits, ToolModel(), rate_hz, 0.0), limits)) {
      double& largest = one.turning && !limits.joints ? turning : moving;
      largest = std::max(largest, one.share);
    }
    if (moving <= most && turning <= most) return spline;
    // Most limits are used in proportion to the amplitude; where one is not, halves follow.
    const auto factor = [&](double share) {
      if (share <= most) return 1.0;
      return step < kSteps / 2 ? most / share * (1.0 - 1e-9) : 0.5;
    };
    shrink(0, limits.joints ? spline.points.cols() : 3, factor(moving));
    if (!limits.joints) shrink(3, 3, factor(turning));
  }
  shrink(0, spline.points.cols(), 0.0);  // at rest in the start
  return spline;
}

}  // namespace dcnn::design
