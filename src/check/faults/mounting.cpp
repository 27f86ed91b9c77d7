#include <cmath>
#include <numbers>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr double kLeastAngle =
    5.0 * std::numbers::pi / 180.0;  // below, dcnn-diagnose calls it misalignment

/// The turn Q that brings m Q field nearest to the force (Wahba's problem, by a singular value
/// decomposition), offsets apart.
Eigen::Matrix3d nearest_turn_of(const RigidFit& fit) {
  const Eigen::MatrixXd F = fit.force.rowwise() - fit.force.colwise().mean();
  const Eigen::MatrixXd g = fit.field.rowwise() - fit.field.colwise().mean();
  const Eigen::Matrix3d B = F.transpose() * g;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handed = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Eigen::Vector3d(1.0, 1.0, handed).asDiagonal() * svd.matrixV().transpose();
}

std::vector<Fault> find_mounting(const Evidence& e) {
  const Adopted& a = e.adopted;
  if (!a.compared || a.reading.compensated) return {};
  const Eigen::AngleAxisd turn(nearest_turn_of(a.fit));
  if (turn.angle() < kLeastAngle) return {};
  Reading turned = a.reading;
  turned.force_axes = turn.toRotationMatrix().transpose() * a.reading.force_axes;
  // Beside friction, which a turn imitates where the tool moves along one line.
  const FitOptions beside_friction{0, true};
  const RigidFit declared = fit_rigid(e.log, a.rows, a.motion, a.reading, beside_friction);
  const RigidFit fit = fit_rigid(e.log, a.rows, a.motion, turned, beside_friction);
  if (fit.mass <= 0.0) return {};
  const double spread = (a.fit.force.rowwise() - a.fit.force.colwise().mean()).norm() /
                        std::sqrt(static_cast<double>(3 * a.fit.force.rows()));
  const double floor = kToolError * spread;
  // Three more numbers: Schwarz' penalty.
  const double gain =
      0.5 * a.independent *
          (log_variance(declared.residual, floor) - log_variance(fit.residual, floor)) -
      1.5 * elementary::log(a.independent);
  const double odds = kFaultPrior * elementary::exp(std::min(gain, 600.0));
  if (odds < 0.05) return {};
  const Eigen::Vector3d axis = turn.axis();
  return {fault_of(mounting_fault, odds / (1.0 + odds), "",
                   "the force does not follow gravity as the pose says: the sensor is turned by " +
                       brief(turn.angle() * 180.0 / std::numbers::pi) + " degrees about (" +
                       brief(axis[0]) + ", " + brief(axis[1]) + ", " + brief(axis[2]) +
                       ") against the declared mounting")};
}

}  // namespace

const FaultKind mounting_fault{
    "mounting", false,
    "calibrate the mounting: dcnn-calibrate --static, then sensor.rotation_rpy in sim.json", "",
    find_mounting};

}  // namespace dcnn::check
