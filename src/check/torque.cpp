// SPDX-License-Identifier: Apache-2.0
#include "check/torque.h"

#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"
#include "dcnn/data/rotation.h"
#include "physics/foreign_force.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

const std::vector<std::string> kTorque{"tx", "ty", "tz"};
constexpr Index kUnknowns = 15, kInertia = 6;  // h, p, then xx, yy, zz, xy, xz, yz, then bias
constexpr int kTorqueReweightings = 30;
constexpr double kTorqueSettled = 1e-5;    // relative change of the residual's variance
constexpr double kOwnScaleOfTorque = 3.0;  // Cauchy's weights halve at so many deviations
constexpr int kLeverSteps = 32;  // from the estimate to the typical lever, even in logarithms
constexpr double kShortestLever = 1e-4;  // m
constexpr double kOtherPoint = 0.1;      // m, from the sensor's origin to the point of the pose

/// I v as a product with (xx, yy, zz, xy, xz, yz).
Eigen::Matrix<double, 3, 6> inertia_columns(const Vector3d& v) {
  Eigen::Matrix<double, 3, 6> columns;
  columns << v[0], 0, 0, v[1], v[2], 0, 0, v[1], 0, v[0], 0, v[2], 0, 0, v[2], 0, v[0], v[1];
  return columns;
}

double size_of(const MatrixXd& m) {
  const MatrixXd about = m.rowwise() - m.colwise().mean();
  return std::sqrt(about.squaredNorm() / static_cast<double>(std::max<Index>(1, m.size())));
}

/// Moments of inertia below zero are held at zero, the most negative one first.
Eigen::VectorXd solve_torque(const MatrixXd& normal, const Eigen::VectorXd& right) {
  MatrixXd held = normal;
  Eigen::VectorXd x = held.ldlt().solve(right);
  for (int k = 0; k < 3; ++k) {
    Index least = 0;
    if (x.segment<3>(kInertia).minCoeff(&least) >= 0.0) break;
    held(kInertia + least, kInertia + least) += 1e15;
    x = held.ldlt().solve(right);
    x[kInertia + least] = 0.0;
  }
  return x;
}

}  // namespace

bool can_fit_torque(const Evidence& e) {
  const Adopted& a = e.adopted;
  return a.compared && e.log.has_all(kTorque) && a.fit.mass > 0.0 && !a.reading.compensated &&
         e.log.declared.read.payload.mass <= 0.0 && size_of(e.log.block(kTorque)) > 0.0;
}

TorqueDesign::TorqueDesign(const Evidence& e) : e_(e), force_(e.adopted.beside_friction) {
  const Adopted& a = e.adopted;
  logged_ = a.rows.smoothed(e.log.block(kTorque), a.rows.value);
  const Matrix3d R_ES =
      e.log.declared.model ? e.log.declared.model->R_ES() : Matrix3d(Matrix3d::Identity());
  const double rate = a.rows.half > 0 ? 1.0 / (e.log.step * a.reading.clock) : 0.0;
  for (Index i = 0; i < logged_.rows(); ++i) {
    const Vector3d w = rate * (R_ES.transpose() * a.motion.w.row(i).transpose());
    const Vector3d dw = rate * rate * (R_ES.transpose() * a.motion.dw.row(i).transpose());
    MatrixXd A(3, kUnknowns);
    A << -cross_matrix(a.fit.field.row(i)), -cross_matrix(a.fit.residual.row(i)),
        -inertia_columns(dw) - cross_matrix(w) * inertia_columns(w), Matrix3d::Identity();
    rows_.push_back(std::move(A));
    R_.push_back(a.motion.R[static_cast<std::size_t>(i)] * R_ES);
  }
}

TorqueFit TorqueDesign::fit(const TorqueReading& reading) const {
  const Index n = logged_.rows();
  TorqueFit fit;
  fit.torque = reading.unit * (logged_ * reading.axes.transpose());
  for (Index i = 0; reading.in_base && i < n; ++i) {
    fit.torque.row(i) *= R_[static_cast<std::size_t>(i)];
  }
  fit.residual.resize(n, 3);
  // In units of the torque's size a ridge is the same for newton metres and for millinewtons.
  const double size = std::max(size_of(fit.torque), 1e-300);
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(n), squares(n), x;
  MatrixXd normal;
  for (int k = 0; k < kTorqueReweightings; ++k) {
    normal = 1e-9 * MatrixXd::Identity(kUnknowns, kUnknowns);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(kUnknowns);
    for (Index i = 0; i < n; ++i) {
      const MatrixXd& A = rows_[static_cast<std::size_t>(i)];
      normal.noalias() += weight[i] * A.transpose() * A;
      right.noalias() += weight[i] / size * A.transpose() * fit.torque.row(i).transpose();
    }
    x = size * solve_torque(normal, right);
    for (Index i = 0; i < n; ++i) {
      fit.residual.row(i) =
          fit.torque.row(i) - (rows_[static_cast<std::size_t>(i)] * x).transpose();
    }
    squares = fit.residual.rowwise().squaredNorm();
    const double before = k == 0 ? 0.0 : fit.variance;
    fit.variance = std::max(median(squares) / chi_square_median(3), 1e-300);
    if (std::abs(fit.variance - before) <= kTorqueSettled * before) break;
    weight = (1.0 + squares.array() / (3.0 * kOwnScaleOfTorque * kOwnScaleOfTorque * fit.variance))
                 .inverse();
  }
  fit.moment = x.head<3>();
  const MatrixXd inverse = normal.ldlt().solve(MatrixXd::Identity(kUnknowns, kUnknowns));
  fit.covariance = 3.0 * static_cast<double>(n) * fit.variance * inverse.topLeftCorner<3, 3>();
  return fit;
}

double TorqueDesign::lever_weight(const TorqueFit& fit) const {
  const double residuals = e_.adopted.independent, mass = e_.adopted.fit.mass;
  const double lever = std::max(fit.moment.norm() / mass, kShortestLever);
  const double told = fit.moment.dot(fit.covariance.ldlt().solve(fit.moment));
  // The likeliest lever under its prior and the recording together, as for a mass.
  double any = -1e300;
  for (int k = 0; k <= kLeverSteps; ++k) {
    const double share = static_cast<double>(k) / kLeverSteps;
    const double factor = elementary::pow(kLever.median / lever, share);
    any = std::max(
        any, plausibility(factor * lever, kLever) -
                 0.5 * residuals * elementary::log(1.0 + (factor - 1.0) * (factor - 1.0) * told));
  }
  const auto& model = e_.log.declared.model;
  if (!model || model->com.norm() <= kShortestLever) return any;
  const double spread = kNominalLeverSpread * mass * model->com.norm();
  const Matrix3d both = fit.covariance / residuals + spread * spread * Matrix3d::Identity();
  const Vector3d off = fit.moment - mass * model->com;
  const double described = -0.5 * off.dot(both.ldlt().solve(off));
  // At the lever that is described, over the logarithm of its length and its directions, the
  // density of any lever, (2 pi)^(-1/2)/(4 pi kLever.above), over that of the normal distribution.
  const double wider = elementary::pow(kNominalLeverSpread, 3.0) / (2.0 * kLever.above);
  return std::max({described, elementary::log(kOtherLever * wider) + any, -kMostSurprise});
}

/// The force shows the tool's moment, too, by its turns: by -m (dw x c + w x (w x c)). A force that
/// is filtered or simulated without its inertia shows none; without a position, or with that of
/// another point than the sensor's origin, turns show the lever of that point as well.
double TorqueDesign::force_weight(const TorqueFit& fit) const {
  if (!e_.adopted.motion.has_position) return 0.0;
  const auto n = static_cast<double>(logged_.rows());
  const double residuals = e_.adopted.independent;
  const double error = std::max(kLinkError * fit.moment.norm(), kOtherPoint * force_.mass);
  const Matrix3d own = 3.0 * n / residuals * force_.covariance.block<3, 3>(1, 1);
  const Matrix3d both = own + fit.covariance / residuals + error * error * Matrix3d::Identity();
  const Vector3d off = force_.moment - fit.moment;
  const double moved = -0.5 * off.dot(both.ldlt().solve(off)),
               still = elementary::log(kQuasiStatic) -
                       0.5 * force_.moment.dot(own.ldlt().solve(force_.moment));
  return std::max({moved, still, -kMostSurprise});
}

double TorqueDesign::log_weight(const TorqueReading& reading) const {
  const TorqueFit found = fit(reading);
  const double residuals = e_.adopted.independent;
  const double floor = kToolError * size_of(logged_);
  return elementary::log(reading.prior) + lever_weight(found) + force_weight(found) -
         0.5 * residuals * log_variance(found.residual / reading.unit, floor);
}

double TorqueDesign::foreign_share(const TorqueReading& reading) const {
  const TorqueFit found = fit(reading);
  double noise = 0.0;
  for (const std::string& name : kTorque) {
    noise += std::pow(reading.unit * noise_of(e_.log.column(name)), 2);
  }
  const MatrixXd about = found.torque.rowwise() - found.torque.colwise().mean();
  return dcnn::foreign_share(
      found.residual.squaredNorm(),
      noise * e_.adopted.rows.value.squaredNorm() * static_cast<double>(logged_.rows()),
      about.squaredNorm());
}

}  // namespace dcnn::check
