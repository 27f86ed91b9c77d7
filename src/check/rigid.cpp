// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/reading.h"
#include "check/statistics.h"
#include "core/elementary.h"
#include "dcnn/data/rotation.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
// A contact in a fifth of the rows takes some 15 reweightings to be left out, a clean log 3.
constexpr int kMostReweightings = 60;
constexpr double kSettled = 1e-6;  // relative change of the residual's variance
constexpr Index kStretches = 8;
constexpr Index kFewestRows = 12;  // of a stretch
constexpr double kOwnScale = 3.0;  // Cauchy's weights halve at so many deviations

constexpr Index kTool = 8;               // columns of mass, moment, bias, and of a weight apart
constexpr double kFrictionSpeed = 0.02;  // m/s, over which dry friction changes its sign

struct Design {
  std::vector<Eigen::MatrixXd>
      rows;                      // (3,8) of mass, moment, bias, weight apart; (3,15) with friction
  Eigen::MatrixXd force, field;  // (n,3) in S
};

/// Dry and viscous friction along the base's axes, dry friction along the sensor's z, (3,7).
Eigen::MatrixXd friction_columns(const Eigen::Matrix3d& R, const Eigen::Vector3d& v, double over) {
  const auto dry = [&](double speed) { return elementary::tanh(speed / over); };
  Eigen::MatrixXd columns(3, 7);
  for (Index k = 0; k < 3; ++k) {
    columns.col(k) = -dry(v[k]) * R.transpose().col(k);
    columns.col(3 + k) = -v[k] * R.transpose().col(k);
  }
  columns.col(6) << 0.0, 0.0, -dry(R.col(2).dot(v));
  return columns;
}

Design design_of(const Log& log, const Sampled& rows, const Kinematics& motion,
                 const Reading& reading, const FitOptions& options) {
  const auto n = static_cast<Index>(rows.centres.size());
  Design design{{},
                rows.smoothed(log.block({"fx", "fy", "fz"}), rows.value, options.shift),
                Eigen::MatrixXd(n, 3)};
  const bool known = log.declared.model.has_value();
  const Eigen::Matrix3d R_ES =
      known ? log.declared.model->R_ES() : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d g =
      known ? log.declared.model->gravity : Eigen::Vector3d(0.0, 0.0, -kEarthGravity);
  const double rate = log.step > 0.0 ? 1.0 / (log.step * reading.clock) : 0.0;
  const bool with_friction = options.friction && motion.has_position && rate > 0.0;
  for (Index i = 0; i < n; ++i) {
    const Eigen::Matrix3d R = motion.R[static_cast<std::size_t>(i)] * R_ES;
    const Eigen::Vector3d a = rate * rate * reading.position *
                              (reading.position_axes * motion.acceleration.row(i).transpose());
    const Eigen::Vector3d w = rate * (R_ES.transpose() * motion.w.row(i).transpose());
    const Eigen::Vector3d dw = rate * rate * (R_ES.transpose() * motion.dw.row(i).transpose());
    const Eigen::Vector3d field =
        R.transpose() * ((reading.compensated ? Eigen::Vector3d(0.0, 0.0, 0.0) : g) - a);
    Eigen::MatrixXd A(3, with_friction ? kTool + 7 : kTool);
    const Eigen::Vector3d weight =
        reading.weight_apart ? Eigen::Vector3d(R.transpose() * g) : Eigen::Vector3d(0.0, 0.0, 0.0);
    A.leftCols(kTool) << field, -cross_matrix(dw) - cross_matrix(w) * cross_matrix(w),
        Eigen::Matrix3d::Identity(), weight;
    if (with_friction && options.columns) {
      A.rightCols(7) = options.columns->row(i).reshaped(3, 7);
    } else if (with_friction) {
      // Along the axes as they are declared: the order and the signs of positions are told by the
      // inertia alone, for friction, whose direction is free here, may look like any of them.
      const Eigen::Vector3d v = rate * reading.position * motion.velocity.row(i).transpose();
      A.rightCols(7) = friction_columns(R, v, kFrictionSpeed);
    }
    design.rows.push_back(std::move(A));
    design.field.row(i) = field;
    const Eigen::Vector3d F =
        reading.force * (reading.force_axes * design.force.row(i).transpose());
    const Eigen::Vector3d in_sensor = reading.force_in_base ? R.transpose() * F : F;
    // What a controller has subtracted, where that is declared.
    design.force.row(i) = in_sensor + log.declared.read.payload.mass * R.transpose() * g;
  }
  return design;
}

/// Weighted least squares with a faint ridge for what the motion does not show; without the tool,
/// its four columns are held at zero, the mass and its moment.
Eigen::VectorXd solve(const Design& design, const Eigen::MatrixXd& weight, bool with_tool,
                      Eigen::MatrixXd& normal) {
  const Index columns = design.rows[0].cols();
  normal.setZero(columns, columns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(columns);
  for (std::size_t i = 0; i < design.rows.size(); ++i) {
    const auto& A = design.rows[i];
    const auto k = static_cast<Index>(i);
    const Eigen::MatrixXd weighted = weight.row(k).asDiagonal() * A;
    normal.noalias() += weighted.transpose() * A;
    right.noalias() += weighted.transpose() * design.force.row(k).transpose();
  }
  // Moments are known to some 0.3 kg m, where an equation is good to 0.3 N.
  for (Index k = 0; k < 4; ++k) normal(k, k) += with_tool ? (k == 0 ? 1e-9 : 1.0) : 1e15;
  normal(kTool - 1, kTool - 1) += 1e-9;
  for (Index k = kTool; k < columns; ++k) normal(k, k) += 1e-3;
  return normal.ldlt().solve(right);
}

/// Cauchy's weights of rows alone, or of each axis by a variance of its own, relative to the mean
/// one; (n,3).
Eigen::MatrixXd weights_of(const RigidFit& fit, double axis_floor) {
  constexpr double kHalf = kOwnScale * kOwnScale;
  if (axis_floor <= 0.0) {
    const Eigen::ArrayXd squares = fit.residual.rowwise().squaredNorm().array();
    return (1.0 + squares / (3.0 * kHalf * fit.variance)).inverse().matrix().replicate(1, 3);
  }
  Eigen::MatrixXd weight(fit.residual.rows(), 3);
  for (Index j = 0; j < 3; ++j) {
    const Eigen::VectorXd squares = fit.residual.col(j).cwiseAbs2();
    const double variance = median(squares) / chi_square_median(1) + axis_floor * axis_floor;
    weight.col(j) =
        fit.variance / variance * (1.0 + squares.array() / (kHalf * variance)).inverse();
  }
  return weight;
}

double fit_once(const Design& design, bool with_tool, double axis_floor, RigidFit& fit,
                Eigen::MatrixXd& normal, Eigen::VectorXd& x) {
  const auto n = static_cast<Index>(design.rows.size());
  Eigen::MatrixXd weight = Eigen::MatrixXd::Ones(n, 3);
  Eigen::VectorXd squares(n);
  fit.residual.resize(n, 3);
  for (int k = 0; k < kMostReweightings; ++k) {
    x = solve(design, weight, with_tool, normal);
    for (Index i = 0; i < n; ++i) {
      fit.residual.row(i) =
          design.force.row(i) - (design.rows[static_cast<std::size_t>(i)] * x).transpose();
    }
    squares = fit.residual.rowwise().squaredNorm();
    const double before = k == 0 ? 0.0 : fit.variance;
    fit.variance = std::max(median(squares) / chi_square_median(3), 1e-300);
    if (std::abs(fit.variance - before) <= kSettled * before) break;
    weight = weights_of(fit, axis_floor);
  }
  return x[0];
}

}  // namespace

Eigen::MatrixXd smoothed_friction(const Log& log, const Sampled& rows, const Reading& reading,
                                  double speed) {
  const Eigen::Matrix3d R_ES = log.declared.model ? log.declared.model->R_ES()
                                                  : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const double rate = 1.0 / (log.step * reading.clock);
  Sampled every = rows;  // each row whose window lies within its segment
  every.centres.clear();
  for (const Segment& segment : log.segments) {
    for (Index i = segment.begin + rows.half; i + rows.half < segment.end; ++i) {
      every.centres.push_back(i);
    }
  }
  const Eigen::MatrixXd velocity = every.smoothed(positions_in_base(log, reading), rows.first);
  const auto R_BE = orientations(log, reading);
  Eigen::MatrixXd signals = Eigen::MatrixXd::Zero(log.rows(), 21);
  for (std::size_t k = 0; k < every.centres.size(); ++k) {
    const Index row = every.centres[k];
    const Eigen::Vector3d v =
        rate * reading.position * (reading.position_axes * velocity.row(Index(k)).transpose());
    signals.row(row) = friction_columns(R_BE[static_cast<std::size_t>(row)] * R_ES, v, speed)
                           .reshaped()
                           .transpose();
  }
  return rows.smoothed(signals, rows.value);
}

double log_variance(const Eigen::MatrixXd& residual, double floor) {
  const Eigen::VectorXd squares = residual.rowwise().squaredNorm();
  const Index n = squares.size(), stretches = std::clamp<Index>(n / kFewestRows, 1, kStretches);
  double sum = 0.0;
  for (Index k = 0; k < stretches; ++k) {
    const Index begin = n * k / stretches, end = n * (k + 1) / stretches;
    const double variance =
        median(squares.segment(begin, end - begin)) / chi_square_median(residual.cols());
    sum += elementary::log(std::max(variance + floor * floor, 1e-300));
  }
  return sum / static_cast<double>(stretches);
}

RigidFit fit_rigid(const Log& log, const Sampled& rows, const Kinematics& motion,
                   const Reading& reading, const FitOptions& options) {
  RigidFit fit;
  Design design = design_of(log, rows, motion, reading, options);
  Eigen::MatrixXd normal;
  Eigen::VectorXd x;
  fit.free_mass = fit_once(design, true, options.axis_floor, fit, normal, x);
  const Eigen::VectorXd first = Eigen::VectorXd::Unit(normal.rows(), 0);
  fit.mass_spread = std::sqrt(3.0 * static_cast<double>(design.rows.size()) * fit.variance *
                              std::max(0.0, normal.ldlt().solve(first)[0]));
  // No tool has a negative mass: then the reading explains nothing but a constant.
  if (fit.free_mass <= 0.0) fit_once(design, false, options.axis_floor, fit, normal, x);
  fit.mass = std::max(0.0, x[0]);
  fit.moment = x.segment<3>(1);
  fit.bias = x.segment<3>(4);
  fit.weighed = x[kTool - 1];
  fit.force = std::move(design.force);
  fit.field = std::move(design.field);
  fit.covariance = fit.variance * normal.inverse().topLeftCorner(7, 7);
  return fit;
}

}  // namespace dcnn::check
