#include <algorithm>
#include <array>
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

/// The least turn from `turn` to one that lets every axis lie along an axis.
double angle_to_right_angles(const Eigen::Matrix3d& turn) {
  double most = -1.0;  // trace of the turn that remains: 1 + 2 cos(angle)
  std::array<Eigen::Index, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
      double trace = 0.0;
      for (Eigen::Index i = 0; i < 3; ++i) {
        const Eigen::Index j = order[static_cast<std::size_t>(i)];
        P(i, j) = (signs >> i & 1) ? -1.0 : 1.0;
        trace += P(i, j) * turn(i, j);
      }
      if (P.determinant() > 0.0) most = std::max(most, trace);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return elementary::acos(std::clamp(0.5 * (most - 1.0), -1.0, 1.0));
}

/// A sensor turned by right angles is a fault of axes; one turned otherwise is this.
void turned_mounting(const Reading& base, const RigidFit& fit, std::vector<Reading>& out) {
  if (base.compensated) return;
  const Eigen::Matrix3d nearest = nearest_turn_of(fit);
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
