// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/axes.h"
#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr int kPasses = 6;
constexpr double kFarRow = 3.0;  // deviations of the residual, at which a row counts half
constexpr double kLeastAngle =
    5.0 * std::numbers::pi / 180.0;  // below, dcnn-diagnose calls it misalignment

/// The turn Q that brings Q `predicted` nearest to the force (Wahba's problem, by a singular value
/// decomposition), offsets apart.
Eigen::Matrix3d nearest_turn(const Eigen::MatrixXd& force, const Eigen::MatrixXd& predicted) {
  const Eigen::MatrixXd F = force.rowwise() - force.colwise().mean();
  const Eigen::MatrixXd g = predicted.rowwise() - predicted.colwise().mean();
  const Eigen::Matrix3d B = F.transpose() * g;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handed = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Eigen::Vector3d(1.0, 1.0, handed).asDiagonal() * svd.matrixV().transpose();
}

/// The turn of the sensor and the tool with its friction, by turns: first of gravity alone, then of
/// all that the tool makes, rows that are foreign to it counting less.
Eigen::Matrix3d turn_of(const Fitting& fitting) {
  const auto& [log, rows, motion, base] = fitting;
  const RigidFit first = fit_rigid(log, rows, motion, base);
  Eigen::Matrix3d turn = nearest_turn(first.force, first.field);
  for (int pass = 0; pass < kPasses && turn.allFinite(); ++pass) {
    Reading turned = base;
    turned.force_axes = turn.transpose() * base.force_axes;
    const RigidFit fit = fit_rigid(log, rows, motion, turned, {0, true});
    const double scale = kFarRow * kFarRow * 3.0 * fit.variance;
    const Eigen::VectorXd weight =
        (1.0 + fit.residual.rowwise().squaredNorm().array() / scale).inverse().sqrt();
    const Eigen::MatrixXd tool = fit.force - fit.residual;
    const Eigen::RowVector3d middle = weight.transpose() * tool / weight.sum();
    const Eigen::RowVector3d centre = weight.transpose() * first.force / weight.sum();
    turn = nearest_turn(weight.asDiagonal() * (first.force.rowwise() - centre),
                        weight.asDiagonal() * (tool.rowwise() - middle));
  }
  return turn;
}

/// The least turn from `turn` to one that lets every axis lie along an axis.
double angle_to_right_angles(const Eigen::Matrix3d& turn) {
  double most = -1.0;  // trace of the turn that remains: 1 + 2 cos(angle)
  for (const Eigen::Matrix3d& P : signed_permutations()) {
    if (P.determinant() > 0.0) most = std::max(most, P.cwiseProduct(turn).sum());
  }
  return elementary::acos(std::clamp(0.5 * (most - 1.0), -1.0, 1.0));
}

/// A sensor turned by right angles is a fault of axes; one turned otherwise is this.
void turned_mounting(const Fitting& fitting, std::vector<Reading>& out) {
  const Reading& base = fitting.base;
  if (base.compensated) return;
  const Eigen::Matrix3d nearest = turn_of(fitting);
  if (!nearest.allFinite() || angle_to_right_angles(nearest) < kLeastAngle) return;
  const Eigen::AngleAxisd turn(nearest);
  const Eigen::Vector3d axis = turn.axis();
  Reading reading = base;
  reading.force_axes = nearest.transpose() * base.force_axes;
  reading.estimated = 3;
  reading.words = "the force does not follow gravity as the pose says: the sensor is turned by " +
                  brief(turn.angle() * 180.0 / std::numbers::pi) + " degrees about (" +
                  brief(axis[0]) + ", " + brief(axis[1]) + ", " + brief(axis[2]) +
                  ") against the declared mounting";
  out.push_back(std::move(reading));
}

}  // namespace

const FaultKind mounting_fault{
    "mounting",
    false,
    "calibrate the mounting: dcnn-calibrate --static, then sensor.rotation_rpy in sim.json",
    "",
    nullptr,
    nullptr,
    true,
    turned_mounting};

}  // namespace dcnn::check
